#include "grading/page_recording.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/units.h"
#include "grading/page_plots.h"
#include "grading/score_tables.h"
#include "page/html.h"
#include "session/live.h"
#include "session/metrics.h"
#include "session/progress_json.h"

namespace calot {
namespace {

constexpr std::size_t most_differences = 5;  // between what a recording says and its replay

/// "force 5.2 N" of 5.2 and "force_N".
std::string value_text(const SessionEvent& event) {
  const std::string key = event_row(event.kind).value;
  if (key.empty()) return event.text;
  const std::size_t bar = key.rfind('_');
  const std::string unit = bar == std::string::npos ? "" : " " + key.substr(bar + 1);
  return fmt::format("{} {:.4g}{}", key.substr(0, bar), event.value, unit);
}

std::string place_text(const SessionEvent& event) {
  if (!event.place) return {};
  const Vec3 mm = *event.place / units::mm;
  return fmt::format("{:.0f}, {:.0f}, {:.0f}", mm.x(), mm.y(), mm.z());
}

/// The events that are listed, by their index, in the order of time.
std::vector<std::size_t> listed_events(const std::vector<SessionEvent>& events,
                                       const std::set<EventKind>& errors) {
  std::vector<std::size_t> chosen;
  for (const bool error : {true, false})
    for (std::size_t i = 0; i < events.size() && chosen.size() < most_page_events; ++i)
      if (errors.contains(events[i].kind) == error) chosen.push_back(i);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

void add_events(const Watched& watched, PageRecording& page) {
  const std::vector<SessionEvent>& events = watched.played.session.progress.events();
  const std::set<EventKind> errors = error_kinds(watched.played.exercise);
  for (const std::size_t i : listed_events(events, errors)) {
    const SessionEvent& event = events[i];
    const EventRow& row = event_row(event.kind);
    const auto picture = watched.moments.events.find(i);
    page.events.push_back(
        {row.name, row.doc, event.time, event.step, event.instrument, event.organ, value_text(event),
         errors.contains(event.kind),
         picture == watched.moments.events.end() ? std::nullopt : std::optional(picture->second),
         to_text(event.cause), place_text(event)});
  }
  page.events_left_out = events.size() - page.events.size();
}

void add_steps(const Watched& watched, PageRecording& page) {
  const auto picture = [](const std::map<std::size_t, std::size_t>& pictures, std::size_t step) {
    const auto found = pictures.find(step);
    return found == pictures.end() ? std::nullopt : std::optional(found->second);
  };
  const std::vector<StepRecord>& steps = watched.played.session.progress.steps();
  for (std::size_t i = 0; i < steps.size(); ++i)
    page.steps.push_back({steps[i].name, steps[i].title, steps[i].outcome, steps[i].started, steps[i].ended,
                          picture(watched.moments.step_begins, i), picture(watched.moments.step_ends, i),
                          steps[i].hint});
}

/// Those at these times that `is_meant` takes: where the replay has other events than the recording, none.
template <class IsMeant>
std::vector<std::size_t> events_at(const OrderedJson& times, const PageRecording& page, IsMeant is_meant) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < page.events.size(); ++i) {
    const auto same = [&](const OrderedJson& time) { return time.get<double>() == page.events[i].time; };
    if (is_meant(page.events[i]) && std::any_of(times.begin(), times.end(), same)) found.push_back(i);
  }
  return found;
}

PagePart part_of(const OrderedJson& json, const PageRecording& page) {
  PagePart part;
  part.name = json["name"].get<std::string>();
  part.explanation = json["explanation"].get<std::string>();
  part.weight = json["weight"].get<double>();
  part.points = json["points"].get<double>();
  if (json["measured"].is_number()) part.measured = json["measured"].get<double>();
  const OrderedJson& benchmark = json["benchmark"];
  part.title = json["title"].get<std::string>();
  part.calibration = benchmark["calibration"].get<std::string>();
  if (benchmark.contains("event")) {
    const auto event = benchmark["event"].get<std::string>();
    part.rule = fmt::format("Each {} costs {:.4g} of the part: {}.", event, benchmark["each"].get<double>(),
                            event_row(*event_called(event)).doc);
    part.events =
        events_at(json["event_times_s"], page, [&](const PageEvent& found) { return found.kind == event; });
    return part;
  }
  if (!benchmark.contains("novice")) {
    part.rule = json["kind"] == "rule" ? "A rule of the exercise's author." : std::string();
    part.events = events_at(json["event_times_s"], page, [](const PageEvent&) { return true; });
    return part;
  }
  part.novice_expert = {benchmark["novice"].get<double>(), benchmark["expert"].get<double>()};
  const auto metric = benchmark["metric"].get<std::string>();
  const std::optional<EventKind> behind = event_behind(metric.substr(metric.rfind('.') + 1));
  const std::string owner = metric.substr(0, metric.find('.'));
  part.events = events_at(json["event_times_s"], page, [&](const PageEvent& event) {
    const std::optional<EventKind> kind = event_called(event.kind);
    return kind && (ends_a_step(*kind) ? event.step == owner : kind == behind);
  });
  return part;
}

void add_score(const OrderedJson& entry, PageRecording& page) {
  const OrderedJson& score = entry["score"];
  if (has_total(entry)) {
    page.score.total = score["total"].get<double>();
    page.score.uncapped = score["uncapped_total"].get<double>();
  }
  page.pass_mark = score["pass_mark"].get<double>();
  page.passed = score["passed"].get<bool>();
  page.verdict = verdict_text(entry);
  page.stopped_at = entry["stopped_at_s"].get<double>();
  for (const OrderedJson& part : score["parts"]) page.score.parts.push_back(part_of(part, page));
  for (const OrderedJson& gate : score["gates"])
    page.score.gates.push_back({gate["reason"].get<std::string>(), gate["found"].get<std::string>(),
                                gate["cap"].get<double>(), gate["fails"].get<bool>(),
                                events_at(gate["times_s"], page, [&](const PageEvent& found) {
                                  return gate["event"] == found.kind;
                                })});
}

/// The step that a metric is of, or in which it was noted; none of those of the whole session.
PageStep* step_of(const std::string& metric, const Progress& progress, PageRecording& page) {
  const std::size_t dot = metric.find('.');
  std::string name = metric.substr(0, dot);
  for (const Note& note : progress.notes())
    if (metric == "note." + note.name) name = note.step;
  const auto found = std::find_if(page.steps.begin(), page.steps.end(),
                                  [&](const PageStep& step) { return step.name == name; });
  return found == page.steps.end() ? nullptr : &*found;
}

void add_points_to_steps(const OrderedJson& entry, const Watched& watched, PageRecording& page) {
  for (const OrderedJson& part : entry["score"]["parts"]) {
    if (!part["benchmark"].contains("metric")) continue;
    PageStep* const step =
        step_of(part["benchmark"]["metric"].get<std::string>(), watched.played.session.progress, page);
    if (step == nullptr) continue;
    step->points += part["points"].get<double>();
    step->most += 100 * part["weight"].get<double>();
  }
}

void add_warnings(const OrderedJson& entry, const Watched& watched, PageRecording& page) {
  const SessionResult& session = watched.played.session;
  if (!entry["whole"].get<bool>())
    page.warnings.push_back(
        fmt::format("The session did not come to its end ({}): what follows ends at {}, is scored "
                    "up to there, and not finished.",
                    entry["end"].get<std::string>(), seconds(page.stopped_at)));
  if (entry["why"].is_string())
    page.warnings.push_back("Scored by playing it again: " + entry["why"].get<std::string>() + ".");
  if (session.end == SessionEnd::failed) page.warnings.push_back(to_text(session.failure));
  for (std::size_t i = 0; i < std::min(watched.otherwise.size(), most_differences); ++i)
    page.warnings.push_back("What the recording says was measured is not what its replay measures: " +
                            watched.otherwise[i] + ".");
  if (!watched.differs.empty())
    page.warnings.push_back(
        watched.differs + " Timeline, pictures and curves are of the replay" +
        (entry["why"].is_null() ? "; the score is the recording's." : ", and so is the score."));
}

std::string text_of(const std::variant<double, bool, std::string>& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "yes" : "no";
  if (const double* number = std::get_if<double>(&value)) return figure_text(*number);
  return std::get<std::string>(value);
}

void add_facts(const OrderedJson& entry, const Watched& watched, PageRecording& page) {
  for (const auto& [name, value] : entry["params"].items())
    page.parameters.push_back({name, value.get<std::string>()});
  for (const auto& [name, value] : entry["metrics"].items())
    page.metrics.push_back({name, value.is_number() ? figure_text(value.get<double>()) : "not a number"});
  for (const Note& note : watched.played.session.progress.notes())
    page.noted.push_back({note.name, text_of(note.value) + (note.unit.empty() ? "" : " " + note.unit) +
                                         " at " + seconds(note.time)});
  for (const OrderedJson& note : entry["notes"]) page.notes.push_back(note.get<std::string>());
}

void add_attempt(const OrderedJson& entry, PageRecording& page) {
  const std::pair<const char*, const char*> rows[] = {
      {"trainee", "trainee"},  {"mode", "mode"},       {"attempt", "attempt of its sitting"},
      {"began", "began, UTC"}, {"machine", "machine"}, {"source", "moved by"},
      {"session", "session"}};
  for (const auto& [key, words] : rows)
    if (const OrderedJson& value = entry[key]; !value.is_null())
      page.attempt.push_back({words, value.is_string() ? value.get<std::string>() : value.dump()});
  page.attempt.push_back({"measured by version", entry["measures"].dump()});
  page.attempt.push_back({"scored by version", entry["score"]["scoring"].dump()});
  page.attempt.push_back({"score", entry["score"]["digest"].get<std::string>()});
}

}  // namespace

Watched held_by(const Recording& recording, const ExerciseDefinition& exercise) {
  Watched watched{{}, PageMoments(error_kinds(exercise)), {}, {}, false};
  watched.played.exercise = exercise;
  watched.played.session.progress = recording.measured->progress;
  Traces& traces = watched.played.session.traces;
  const std::vector<LiveInstrument> instruments = live_instruments(exercise.scene);
  traces.instruments.resize(exercise.scene.instruments.size());
  for (const RecordedStep& step : recording.steps) {
    traces.time.push_back(step.time);
    for (std::size_t i = 0; i < traces.instruments.size(); ++i)
      traces.instruments[i].emplace_back().tip =
          tip_position(instruments[i].trocar, step.input.instruments[i], instruments[i].geometry);
  }
  return watched;
}

PageRecording page_recording(const OrderedJson& entry, const Watched& watched, const std::string& prefix) {
  PageRecording page;
  page.prefix = prefix;
  page.file = entry["file"].get<std::string>();
  page.name = recording_name(page.file);
  add_events(watched, page);
  add_steps(watched, page);
  add_score(entry, page);
  add_points_to_steps(entry, watched, page);
  add_warnings(entry, watched, page);
  page.pictures = watched.moments.pictures;
  page.pictures_left_out = watched.moments.left_out;
  page.drawn = watched.played.rendered;
  page.simulated = watched.simulated;
  page.plots =
      page_plots(watched.played.exercise, watched.played.session.progress, watched.played.session.traces);
  add_facts(entry, watched, page);
  add_attempt(entry, page);
  return page;
}

std::string recording_name(const std::string& file) {
  const std::filesystem::path path(file);
  const std::string folder = path.parent_path().filename().string();
  return path.filename() == "recording.jsonl" && !folder.empty() ? folder : path.stem().string();
}

}  // namespace calot
