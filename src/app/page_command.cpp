#include <fmt/format.h>

#include <set>

#include "app/commands.h"
#include "base/log.h"
#include "grading/page_recording.h"
#include "grading/score_recording.h"
#include "grading/score_tables.h"
#include "grading/score_verdicts.h"
#include "lua/read_benchmarks.h"
#include "page/page.h"
#include "play/replay_checks.h"
#include "process/interrupt.h"
#include "process/process_pool.h"
#include "process/project.h"
#include "process/terminal.h"
#include "session/measured.h"
#include "session/scoring.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

constexpr int picture_width = 640, picture_height = 360;  // px

std::string prefix_of(std::size_t index, std::size_t count) {
  return count == 1 ? "" : fmt::format("r{}-", index + 1);
}

/// The exercise of the first recording that can be read; where none can be, the first one's failure.
Result<fs::path> find_exercise(const PageCommand& command, const std::vector<std::string>& files) {
  if (!command.scenario.empty()) return fs::path(command.scenario);
  std::optional<Failure> first;
  for (const std::string& file : files) {
    const Result<Recording> recording = read_recording(file);
    if (recording) return find_scenario(recording->header, file, {});
    if (!first) first = recording.failure();
  }
  return *first;
}

/// A page beside a single recording, else one of the exercise in the present folder.
fs::path page_file(const PageCommand& command, const std::vector<std::string>& files,
                   const std::string& exercise) {
  if (!command.output.empty()) return command.output;
  return files.size() == 1 ? fs::path(files[0]).replace_extension(".html") : fs::path(exercise + ".html");
}

std::optional<Failure> check_page_file(const fs::path& page, const std::vector<std::string>& files) {
  std::error_code ignored;
  if (fs::is_directory(page, ignored))
    return fail(FailureKind::usage, fmt::format("{} is a folder", page.string()),
                "name a file: -o FILE.html");
  for (const std::string& file : files)
    if (fs::equivalent(page, file, ignored))
      return fail(FailureKind::usage, fmt::format("{} is a recording that is to be shown", page.string()),
                  "choose another file with -o FILE.html");
  return std::nullopt;
}

/// What a process says of one recording.
struct Answer {
  OrderedJson entry;
  std::string section;  ///< HTML; empty where there is no score
  std::size_t errors = 0;
};

/// Plays and scores the recordings, each in a process of its own.
class PageMaker {
 public:
  PageMaker(const PageCommand& command, std::vector<std::string> files)
      : command_(command), files_(std::move(files)), answers_(files_.size()) {}

  /// Fails as RecordingScorer does.
  std::optional<Failure> prepare(ScoreRequest request) {
    request.watcher =
        ScoreWatcher{[this](const ExerciseDefinition& exercise, PlayRequest& play) { begin(exercise, play); },
                     [this](const Recording& recording, const Played& played) {
                       const StateComparison states = compare_states(recording, played.session);
                       watched_ = Watched{played, std::move(*moments_), states.message, {}};
                       if (states.message.empty())
                         watched_->otherwise =
                             measured_otherwise(recording, exercise_hash(played.exercise), played.session);
                     }};
    if (command_.no_pictures)
      request.watcher->held = [this](const Recording& recording, const ExerciseDefinition& exercise) {
        watched_ = held_by(recording, exercise);
      };
    Result<RecordingScorer> scorer = RecordingScorer::create(std::move(request));
    if (!scorer) return scorer.failure();
    scorer_.emplace(std::move(scorer).value());
    return std::nullopt;
  }

  std::optional<Failure> run() {
    ProgressLine line;
    int finished = 0;
    const PoolOptions options{command_.jobs, &interrupt_flag()};
    const Result<int> done = work_in_processes(
        static_cast<int>(files_.size()), options,
        [this](int k) { return answer(static_cast<std::size_t>(k)); },
        [&](int k, Result<std::string> text) {
          take(static_cast<std::size_t>(k), std::move(text));
          if (++finished; line.due()) line.show(fmt::format("{} of {} recordings", finished, files_.size()));
        });
    if (!done) return done.failure();
    if (interrupt_flag())
      return fail(FailureKind::interrupted,
                  fmt::format("interrupted when {} of {} recordings were done", done.value(), files_.size()));
    return std::nullopt;
  }

  const ExerciseDefinition& exercise() const { return scorer_->exercise(); }
  const std::vector<Answer>& answers() const { return answers_; }

 private:
  void begin(const ExerciseDefinition& exercise, PlayRequest& play) {
    moments_.emplace(error_kinds(exercise));
    play.render = !command_.no_pictures;
    play.golden_pictures = play.end_frame = false;
    play.width = picture_width;
    play.height = picture_height;
    play.moment = [this](const Progress& progress) { return moments_->wanted(progress); };
    play.on_picture = [this](const Frame& frame) { return moments_->take(frame); };
  }

  std::string answer(std::size_t k) {
    OrderedJson json = {{"entry", scorer_->score(files_[k])}};
    const OrderedJson& entry = json["entry"];
    if (is_scored(entry)) {
      const PageRecording page = page_recording(entry, *watched_, prefix_of(k, files_.size()));
      json["section"] = recording_html(page);
      json["errors"] = std::count_if(page.events.begin(), page.events.end(),
                                     [](const PageEvent& event) { return event.error; });
    }
    return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  }

  void take(std::size_t k, Result<std::string> text) {
    Answer& answer = answers_[k];
    if (!text) {
      Failure failure = text.failure();
      for (Problem& problem : failure.problems) problem.place.file = files_[k];
      answer.entry = failed_entry(files_[k], failure);
      return;
    }
    const OrderedJson json = OrderedJson::parse(text.value());
    answer.entry = json["entry"];
    if (!json.contains("section")) return;
    answer.section = json["section"].get<std::string>();
    answer.errors = json["errors"].get<std::size_t>();
  }

  const PageCommand& command_;
  std::vector<std::string> files_;
  std::vector<Answer> answers_;
  std::optional<RecordingScorer> scorer_;
  std::optional<PageMoments> moments_;  ///< of the recording that is being played
  std::optional<Watched> watched_;      ///< the recording that was played last
};

PageRow row_of(const ClassScores& scores, const Answer& answer, std::size_t index) {
  const OrderedJson& entry = scores.entries[index];
  PageRow row;
  row.prefix = prefix_of(index, scores.entries.size());
  row.name = recording_name(entry["file"].get<std::string>());
  row.verdict = verdict_text(entry);
  if (!is_scored(entry)) {
    row.problem = failure_text(entry);
    return row;
  }
  if (entry["trainee"].is_string())
    row.trainee = with_name(entry["trainee"].get<std::string>(), scores.names);
  row.began = began_text(entry);
  row.finished = is_finished(entry);
  row.passed = entry["score"]["passed"].get<bool>();
  row.unsafe = entry["score"]["outcome"] == to_text(AttemptOutcome::unsafe);
  if (has_total(entry)) row.total = entry["score"]["total"].get<double>();
  row.steps = steps_text(entry);
  row.stopped_at = entry["stopped_at_s"].get<double>();
  row.errors = answer.errors;
  for (const OrderedJson& part : entry["score"]["parts"])
    row.points.emplace_back(part["points"].get<double>());
  return row;
}

/// Attempts of one trainee by when they began, where all say so, else in the order in which they are named.
void put_in_order(const std::vector<OrderedJson>& entries, std::vector<std::size_t>& members) {
  std::sort(members.begin(), members.end());
  const auto began = [&](std::size_t i) {
    return entries[i]["began"].is_string() ? entries[i]["began"].get<std::string>() : "";
  };
  if (std::none_of(members.begin(), members.end(), [&](std::size_t i) { return began(i).empty(); }))
    std::stable_sort(members.begin(), members.end(),
                     [&](std::size_t a, std::size_t b) { return began(a) < began(b); });
}

/// Whether recordings that say who operated name several.
bool several_trainees(const std::vector<OrderedJson>& entries) {
  std::set<std::string> trainees;
  for (const OrderedJson& entry : entries)
    if (is_scored(entry) && entry["trainee"].is_string())
      trainees.insert(entry["trainee"].get<std::string>());
  return trainees.size() > 1;
}

PageGroup shown_group(const ClassScores& scores, const std::vector<Answer>& answers, const ScoreGroup& group,
                      const std::string& title) {
  PageGroup shown{title, group.pass_mark, {}, {}};
  for (const OrderedJson& part : group.parts)
    shown.parts.push_back(
        {part["title"].get<std::string>(), fmt::format("{:.1f}", 100 * part["weight"].get<double>())});
  for (const std::size_t i : group.members) shown.rows.push_back(row_of(scores, answers[i], i));
  return shown;
}

std::string page_text(const PageCommand& command, const ClassScores& scores,
                      const std::vector<Answer>& answers) {
  Page page;
  page.title = scores.exercise.title;
  page.scenario = scores.exercise.id;
  page.file = portable_path(scores.exercise.file);
  page.of_a_class = command.of_a_class || several_trainees(scores.entries);
  if (page.of_a_class && !command.of_a_class)
    log_info("The recordings are of several trainees: they are shown as a class.");
  page.benchmarks = "the exercise's own, which are design values";
  page.calibration = "uncalibrated";
  if (scores.benchmarks) {
    page.benchmarks = fmt::format("{}, version {}", scores.benchmarks->name, scores.benchmarks->version);
    page.calibration = scores.benchmarks->calibration;
  }
  std::vector<std::string> sections;
  const std::vector<ScoreGroup> groups = score_groups(scores.entries);
  for (ScoreGroup group : groups) {
    if (!page.of_a_class) put_in_order(scores.entries, group.members);
    page.groups.push_back(shown_group(scores, answers, group, group_title(group, groups)));
    for (const std::size_t i : group.members) sections.push_back(answers[i].section);
  }
  for (std::size_t i = 0; i < answers.size(); ++i)
    if (!is_scored(scores.entries[i])) page.not_counted.push_back(row_of(scores, answers[i], i));
  return page_html(page, sections);
}

Result<ScoreRequest> read_page_request(const PageCommand& command, const fs::path& exercise) {
  ScoreRequest request;
  request.exercise = exercise;
  if (command.benchmarks.empty()) return request;
  Result<BenchmarkTable> table = read_benchmarks(command.benchmarks, project_part("scripts/lua"));
  if (!table) return table.failure();
  request.benchmarks = std::move(table).value();
  return request;
}

}  // namespace

ExitCode page_command(const PageCommand& command) {
  interrupt_flag();  // before a process is started: from here on an interruption ends in order
  const std::vector<std::string> files = recordings_of(command.recordings);
  if (files.empty()) {
    print_failure(no_recordings(command.recordings), "calot run --help");
    return ExitCode::nothing_selected;
  }
  const char* help = "calot page --help";
  const Result<fs::path> exercise = find_exercise(command, files);
  if (!exercise) return print_failure(exercise.failure(), help);
  Result<ScoreRequest> request = read_page_request(command, exercise.value());
  if (!request) return print_failure(request.failure(), help);
  const Result<NameRegister> names = read_names(command.names);
  if (!names) return print_failure(names.failure(), help);
  const std::optional<BenchmarkTable> benchmarks = request->benchmarks;
  PageMaker maker(command, files);
  if (const std::optional<Failure> wrong = maker.prepare(std::move(request).value()))
    return print_failure(*wrong, wrong->kind == FailureKind::usage
                                     ? help
                                     : "calot check " + shell_word(exercise.value().string()));
  const fs::path file = page_file(command, files, maker.exercise().id);
  if (const std::optional<Failure> wrong = check_page_file(file, files)) return print_failure(*wrong, help);
  if (command.dry_run) {
    const std::optional<Failure> wrong = first_unreadable(files);
    return wrong ? print_failure(*wrong, help) : ExitCode::ok;
  }
  if (const std::optional<Failure> failed = maker.run())
    return print_failure(*failed, fmt::format("calot page {}{}", shell_word(command.recordings[0]),
                                              command.recordings.size() > 1 ? " ..." : ""));

  std::vector<OrderedJson> entries;
  for (const Answer& answer : maker.answers()) entries.push_back(answer.entry);
  mark_copies(entries);
  const bool any = std::any_of(entries.begin(), entries.end(),
                               [](const OrderedJson& entry) { return !entry.contains("failure"); });
  if (any) {
    const Result<std::string> written = write_text(
        file, page_text(command, {maker.exercise(), benchmarks, entries, names.value()}, maker.answers()));
    if (!written) return print_failure(written.failure(), help);
    print("Written to " + file.string());
  }
  return judge(entries, exercise->string(), std::nullopt);
}

}  // namespace calot
