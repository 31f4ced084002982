#include "session/report.h"

#include <fmt/format.h>

#include "base/hash.h"
#include "base/units.h"
#include "session/build_info.h"
#include "session/csv.h"
#include "session/json.h"
#include "session/measured.h"
#include "session/metrics.h"
#include "session/progress_json.h"

namespace calot {
namespace {

std::vector<std::string> kind_names(const std::vector<EventKind>& kinds) {
  std::vector<std::string> names;
  for (const EventKind kind : kinds) names.push_back(to_text(kind));
  return names;
}

OrderedJson benchmark_json(const ScorePart& part) {
  OrderedJson json;
  switch (part.kind) {
    case ScorePartKind::benchmark:
      json = {{"metric", part.metric}, {"novice", part.novice}, {"expert", part.expert}};
      break;
    case ScorePartKind::penalty:
      json = {{"event", to_text(part.event)}, {"each", part.each}};
      break;
    case ScorePartKind::procedure:
      json = {{"steps", part.steps},
              {"minor", kind_names(part.minor)},
              {"minor_costs", part.minor_costs},
              {"major", kind_names(part.major)},
              {"major_costs", part.major_costs}};
      break;
    case ScorePartKind::time:
      json = {{"reference_s", part.reference},
              {"limit_s", part.limit},
              {"errors", kind_names(part.errors)},
              {"each_s", part.each_s}};
      break;
    case ScorePartKind::critical_view:
      json = {{"metric", part.metric}, {"satisfactory", part.satisfactory}, {"full", part.full}};
      break;
    case ScorePartKind::rule:
      break;
  }
  json["calibration"] = part.calibration;
  return json;
}

/// A part of the score: what it is, what was measured for it, and the points that it earned.
OrderedJson scored_part_json(const ScoredPart& part) {
  OrderedJson json = {{"name", part.definition.name},
                      {"title", part_title(part.definition)},
                      {"kind", score_part_kinds()[static_cast<std::size_t>(part.definition.kind)]}};
  json["measured"] = part.measured ? OrderedJson(*part.measured) : OrderedJson();
  json["benchmark"] = benchmark_json(part.definition);
  json["points"] = part.points;
  json["weight"] = part.definition.weight;
  json["share_of_steps_done"] = part.done;
  json["event_times_s"] = part.times;
  json["explanation"] = part.explanation;
  return json;
}

OrderedJson timing_json(const SessionResult& session, double step, double start_to_first_frame) {
  const SessionTiming& timing = session.timing;
  const StepTimes times = step_times(timing.step_s, step);
  OrderedJson json = {{"real_time_factor", real_time_factor(session)},
                      {"simulated_s", session.traces.time.empty() ? 0.0 : session.traces.time.back()},
                      {"wall_s", timing.wall_s},
                      {"simulation_s", timing.simulation_s},
                      {"slowest_second_s", timing.slowest_s},
                      {"frames_s", timing.frames_s},
                      {"assembly_s", timing.assembly_s},
                      {"factorisation_s", timing.factorisation_s},
                      {"solve_s", timing.solve_s},
                      {"contact_s", timing.contact_s},
                      {"steps", session.state_hashes.empty() ? 0 : session.state_hashes.size() - 1},
                      {"substeps", timing.substeps},
                      {"newton_iterations", timing.newton_iterations}};
  json["step_ms"] = {{"median", 1e3 * times.median},
                     {"p90", 1e3 * times.p90},
                     {"p99", 1e3 * times.p99},
                     {"longest", 1e3 * times.longest}};
  json["steps_over_time"] = times.over_time;
  json["steps_cut_short"] = timing.steps_cut_short;
  json["steps_unbalanced"] = timing.steps_unbalanced;
  json["start_to_first_frame_s"] =
      start_to_first_frame >= 0 ? OrderedJson(start_to_first_frame) : OrderedJson();
  return json;
}

OrderedJson pictures_json(const LivePictures::Figures& seen, bool stamped) {
  const bool some = seen.running > 0;
  OrderedJson json{{"shown", seen.shown},
                   {"a_second", some ? OrderedJson((seen.shown - 1) / seen.running) : OrderedJson()}};
  // By their stamps inputs come long before their time.
  if (!stamped) json["input_to_picture_s"] = {{"median", seen.wait_median}, {"most", seen.wait_most}};
  return json;
}

OrderedJson operated_json(const LiveFigures& live) {
  OrderedJson json{{"mode", to_text(live.mode)},
                   {"pacing", live.stamped ? "stamped" : "real_time"},
                   {"ended_by", live.ended_by.empty() ? OrderedJson() : OrderedJson(live.ended_by)},
                   {"inputs", live.inputs},
                   {"refused_inputs", live.refused},
                   {"held_up_inputs", live.full},
                   {"following_steps", live.following_steps},
                   {"pauses", live.pauses},
                   {"paused_s", live.paused},
                   {"slowed_steps", live.slowed_steps},
                   {"slowed_s", live.slowed},
                   {"longest_step_s", live.longest_step},
                   {"longest_silence_s", live.longest_silence},
                   {"input_to_step_s", {{"median", live.wait_median}, {"most", live.wait_most}}},
                   {"input_to_state_s", {{"median", live.state_median}, {"most", live.state_most}}}};
  if (live.pictures) json["pictures"] = pictures_json(*live.pictures, live.stamped);
  return json;
}

}  // namespace

OrderedJson score_json(const ExerciseDefinition& exercise, const Score& score, bool has_total) {
  OrderedJson json = {{"total", has_total ? OrderedJson(score.total) : OrderedJson()},
                      {"out_of", 100},
                      {"outcome", to_text(score.outcome)},
                      {"verdict", verdict(score)},
                      {"passed", score.passed()},
                      {"pass_mark", exercise.score.pass},
                      {"completed", score.completed},
                      {"steps_done", score.steps_done},
                      {"steps", score.steps},
                      {"missing_steps", score.missing},
                      {"uncapped_total", has_total ? OrderedJson(score.uncapped) : OrderedJson()},
                      {"api", exercise.api},
                      {"scoring", scoring_version},
                      {"digest", hex(score_digest(exercise))}};
  if (score.bail_out)
    json["bail_out"] = {{"right", score.bail_out->share > 0}, {"reason", score.bail_out->reason}};
  json["critical"] = OrderedJson::array();
  json["gates"] = OrderedJson::array();
  for (const TrippedGate& gate : score.gates) {
    if (gate.critical)
      json["critical"].push_back(
          {{"event", to_text(*gate.critical)}, {"times_s", gate.times}, {"cap", gate.cap}});
    json["gates"].push_back({{"reason", gate.reason},
                             {"found", gate.explanation},
                             {"event", gate.event.empty() ? OrderedJson() : OrderedJson(gate.event)},
                             {"times_s", gate.times},
                             {"cap", gate.cap},
                             {"fails", gate.fails}});
  }
  json["parts"] = OrderedJson::array();
  for (const ScoredPart& part : score.parts) json["parts"].push_back(scored_part_json(part));
  return json;
}

std::string events_csv(const Progress& progress) {
  std::string text = csv_row({"time_s", "event", "step", "instrument", "organ", "value", "unit", "x_mm",
                              "y_mm", "z_mm", "cause", "text"});
  for (const SessionEvent& event : progress.events()) {
    const std::string key = event_row(event.kind).value;
    const std::string value = key.empty() ? "" : fmt::format("{}", event.value);
    std::vector<std::string> row{fmt::format("{}", event.time),
                                 to_text(event.kind),
                                 event.step,
                                 event.instrument,
                                 event.organ,
                                 value,
                                 key};
    for (int i = 0; i < 3; ++i)
      row.push_back(event.place ? fmt::format("{}", (*event.place)[i] / units::mm) : "");
    row.push_back(to_text(event.cause));
    row.push_back(csv_field(event.text));
    text += csv_row(row);
  }
  return text;
}

double real_time_factor(const SessionResult& session) {
  if (session.traces.time.empty() || session.timing.wall_s <= 0) return 0;
  return session.traces.time.back() / session.timing.wall_s;
}

std::string report_json(const ExerciseDefinition& exercise, const SessionResult& session,
                        const SessionReport& report) {
  OrderedJson json = {{"schema", "calot.report/1"}, {"scenario", exercise.id}, {"title", exercise.title},
                      {"file", exercise.file},      {"seed", exercise.seed},   {"params", exercise.params},
                      {"end", to_text(session.end)}};
  if (session.end == SessionEnd::failed) json["failure"] = to_text(session.failure);
  json["exercise_hash"] = hex(exercise_hash(exercise));
  json["measures"] = measures_version;
  json["attempt"] = OrderedJson::object();
  write_attempt(report.attempt, json["attempt"]);
  json["steps"] = steps_json(session.progress);
  json["events"] = events_json(session.progress);
  json["metrics"] = session.metrics;
  json["noted"] = notes_json(session.progress);
  json["notes"] = session.notes;
  json["rest"] = session.rest;
  json["motion_processing"] = {{"version", MotionProcessing::version},
                               {"rate_Hz", MotionProcessing::rate},
                               {"cut_off_Hz", MotionProcessing::cut_off}};
  json["score"] = score_json(exercise, report.score, report.has_total());
  json["state_hash"] = hex(session.state_hashes.empty() ? 0 : session.state_hashes.back());
  const Make make = this_make();
  json["build"] = {{"toolchain", make.toolchain},
                   {"instruction_set", make.instruction_set},
                   {"mathematics", make.mathematics}};
  if (report.live) json["operated"] = operated_json(*report.live);
  json["timing"] = timing_json(session, 1 / exercise.scene.solver.rate, report.start_to_first_frame_s);
  return json_text(json) + "\n";
}

}  // namespace calot
