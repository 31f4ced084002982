#include "session/runner.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "session/metrics.h"
#include "session/progress_json.h"
#include "session/report.h"
#include "session/session_for_tests.h"
#include "session/skin_difference.h"
#include "support/text_files.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

World small_world() {
  Result<World> world = World::create(test::small_scene());
  EXPECT_TRUE(world) << to_text(world.failure());
  return std::move(world).value();
}

SessionResult played(test::TimedScript& script, InputSource& source, SessionOptions options = {}) {
  World world = small_world();
  return run_session(world, script, source, options);
}

struct Recorded {
  SessionResult run;
  Recording recording;  ///< of it, read back
};

Recorded recorded(test::TimedScript& script, InputSource& source) {
  const test::Folder folder;
  const std::string path = (folder.path() / "r.jsonl").string();
  World world = small_world();
  Result<RecordingWriter> writer =
      RecordingWriter::create(path, recording_header(script.definition(), world, "small.lua"));
  EXPECT_TRUE(writer);
  SessionOptions options;
  options.recording = &writer.value();
  Recorded out{run_session(world, script, source, options), {}};
  Result<Recording> recording = read_recording(path);
  EXPECT_TRUE(recording) << to_text(recording.failure());
  if (recording) out.recording = std::move(recording).value();
  return out;
}

bool has_event(const SessionResult& result, EventKind kind) {
  const auto& events = result.progress.events();
  return std::any_of(events.begin(), events.end(),
                     [&](const SessionEvent& event) { return event.kind == kind; });
}

TEST(Runner, EndsWithItsScriptAndHoldsTheLastInputWhereTheSourceEndsBefore) {
  test::TimedScript script(0.4);
  test::SwayingSource source(0.2);
  const SessionResult result = played(script, source);
  EXPECT_EQ(result.end, SessionEnd::steps_done);
  EXPECT_EQ(result.state_hashes.size(), 21u);  // 0.4 s at 50 Hz, and the rest state
  EXPECT_EQ(result.progress.steps().at(0).outcome, "done");
  EXPECT_EQ(result.progress.steps().at(0).started, 0);
  const auto& samples = result.traces.instruments.at(0);
  EXPECT_EQ((samples[20].tip - samples[10].tip).norm(), 0);
  EXPECT_GT((samples[10].tip - samples[0].tip).norm(), 1e-4);
}

TEST(Runner, StopsAtTheTimeLimitAndSaysThatTheStepTimedOut) {
  ExerciseDefinition exercise = test::small_exercise();
  exercise.time_limit = 0.3;
  test::TimedScript script(5, exercise);
  const SessionResult result = played(script, script.demo());
  EXPECT_EQ(result.end, SessionEnd::time_limit);
  EXPECT_NEAR(result.traces.time.back(), 0.3, 1e-12);
  EXPECT_EQ(result.progress.steps().at(0).outcome, "timeout");
}

TEST(Runner, AStopFlagEndsItBeforeTheNextStepWithTheStepAborted) {
  test::TimedScript script(5);
  std::atomic<bool> stop{false};
  SessionOptions options;
  options.stop = &stop;
  options.observer = [&](const World& world, const Progress&, bool) { stop = world.report().time > 0.09; };
  const SessionResult result = played(script, script.demo(), options);
  EXPECT_EQ(result.end, SessionEnd::interrupted);
  EXPECT_NEAR(result.traces.time.back(), 0.1, 1e-12);
  EXPECT_EQ(result.progress.steps().at(0).outcome, "aborted");
}

TEST(Runner, ShowsEveryStateOnceAndTheLastOneAsLast) {
  test::TimedScript script(0.1);
  std::vector<double> times;
  int last = 0;
  SessionOptions options;
  options.observer = [&](const World& world, const Progress&, bool is_last) {
    if (!is_last) times.push_back(world.report().time);
    last += is_last ? 1 : 0;
  };
  played(script, script.demo(), options);
  ASSERT_EQ(times.size(), 5u);
  EXPECT_EQ(times[0], 0);
  EXPECT_EQ(last, 1);
}

TEST(Runner, AReplayGoesThroughTheSameStatesAsTheRun) {
  test::TimedScript script(0.4);
  const auto [run, recording] = recorded(script, script.demo());
  EXPECT_EQ(recording.end, "done");
  EXPECT_TRUE(has_event(run, EventKind::contact)) << "states that nothing touches are easily the same";
  ReplaySource source(recording);
  test::TimedScript again(0.4);
  SessionOptions replaying;
  replaying.end_with_source = true;
  const SessionResult replay = played(again, source, replaying);
  EXPECT_EQ(replay.state_hashes, run.state_hashes);
  ASSERT_EQ(recording.steps.size() + 1, run.state_hashes.size());
  EXPECT_EQ(recording.header.state_hash, run.state_hashes[0]);
  for (std::size_t i = 0; i < recording.steps.size(); ++i)
    EXPECT_EQ(recording.steps[i].state_hash, run.state_hashes[i + 1]);
}

TEST(Runner, AReplayFailsWhereTheRunDid) {
  class TooFar : public InputSource {
   public:
    Result<std::optional<StepInput>> next(const World& world, double) override {
      StepInput input;
      input.instruments.push_back(world.report().instruments[0].pose);
      if (world.report().time > 0.05) input.instruments[0].insertion = 10;  // m
      return std::optional<StepInput>(input);
    }
  } source;
  test::TimedScript script(5);
  const auto [run, recording] = recorded(script, source);
  EXPECT_EQ(run.end, SessionEnd::failed);
  EXPECT_EQ(recording.end, "failed");
  EXPECT_EQ(recording.steps.size(), 4u) << "the step that could not be taken too";
  ReplaySource again(recording);
  const SessionResult replay = played(script, again);
  EXPECT_EQ(replay.end, SessionEnd::failed);
  EXPECT_EQ(to_text(replay.failure), to_text(run.failure));
  EXPECT_EQ(replay.state_hashes, run.state_hashes);
}

TEST(Runner, AReplayOfAnInterruptedRunEndsWhereTheRunDid) {
  Recording recording;
  World world = small_world();
  test::SwayingSource sway(1);
  for (int i = 0; i < 5; ++i) {
    RecordedStep step;
    step.input = *sway.next(world, 0.02).value();
    recording.steps.push_back(step);
  }
  ReplaySource source(recording);
  test::TimedScript script(5);
  SessionOptions options;
  options.end_with_source = true;
  const SessionResult result = played(script, source, options);
  EXPECT_EQ(result.end, SessionEnd::source_ended);
  EXPECT_EQ(result.state_hashes.size(), 6u);
}

TEST(Runner, ASessionThatIsToGoUntilATimeHasTheSameBitsUpToThereAndNoMore) {
  const auto until = [](double time) {
    test::TimedScript script(5);
    test::SwayingSource sway(1);
    SessionOptions options;
    options.until = time;
    return played(script, sway, options);
  };
  const SessionResult whole = until(0.2), part = until(0.1), none = until(0);
  EXPECT_EQ(part.end, SessionEnd::source_ended);
  ASSERT_EQ(part.state_hashes.size(), 6u) << "at rest, and five steps of 20 ms";
  EXPECT_TRUE(std::equal(part.state_hashes.begin(), part.state_hashes.end(), whole.state_hashes.begin()));
  EXPECT_EQ(none.end, SessionEnd::source_ended);
  EXPECT_EQ(none.state_hashes.size(), 1u);
}

/// Acts in the steps that end then, besides swaying.
class ActingSource : public InputSource {
 public:
  explicit ActingSource(std::map<int, SessionAct> acts) : acts_(std::move(acts)) {}
  Result<std::optional<StepInput>> next(const World& world, double dt) override {
    Result<std::optional<StepInput>> input = sway_.next(world, dt);
    const auto act = acts_.find(++step_);
    if (input && input.value() && act != acts_.end()) input.value()->acts = {act->second};
    return input;
  }

 private:
  test::SwayingSource sway_{1};
  std::map<int, SessionAct> acts_;
  int step_ = 0;
};

TEST(Runner, ATimeOutAndABailOutAreEventsAndTheirReplayHasTheSameBits) {
  test::TimedScript script(1);
  ActingSource source(
      {{3, {EventKind::time_out, "landmarks \"named\""}}, {6, {EventKind::bail_out, "subtotal"}}});
  const auto [run, recording] = recorded(script, source);
  EXPECT_EQ(run.end, SessionEnd::bailed_out);
  EXPECT_EQ(run.state_hashes.size(), 7u) << "the operation ends with the step of the bail-out";
  EXPECT_EQ(run.progress.steps().at(0).outcome, "bail_out");
  EXPECT_EQ(recording.end, "bail_out");
  EXPECT_TRUE(came_to_its_end(recording.end)) << "it was not broken off";
  test::TimedScript again(1);
  ReplaySource replay(recording);
  SessionOptions options;
  options.end_with_source = true;
  const SessionResult result = played(again, replay, options);
  EXPECT_EQ(result.end, SessionEnd::bailed_out);
  EXPECT_EQ(result.state_hashes, run.state_hashes);
  EXPECT_EQ(result.metrics, run.metrics);
  EXPECT_EQ(events_json(result.progress), events_json(run.progress));
  for (const SessionResult* one : {&run, &result}) {
    const SessionEvent& time_out = one->progress.events().at(0);
    EXPECT_EQ(time_out.kind, EventKind::time_out);
    EXPECT_EQ(time_out.text, "landmarks \"named\"");
    EXPECT_NEAR(time_out.time, 0.06, 1e-12);
    EXPECT_EQ(time_out.step, "only");
    EXPECT_EQ(one->progress.events().back().text, "subtotal");
  }
  EXPECT_EQ(events_json(recording.measured->progress), events_json(run.progress));
}

TEST(Runner, AnActIsDoneOnceThoughTheLastPoseIsHeld) {
  test::TimedScript script(1.2);
  ActingSource source({{50, {EventKind::time_out, ""}}});  // the source's last
  const SessionResult result = played(script, source);
  const auto& events = result.progress.events();
  EXPECT_EQ(std::count_if(events.begin(), events.end(),
                          [](const WorldEvent& event) { return event.kind == EventKind::time_out; }),
            1);
}

TEST(Runner, AScriptsErrorEndsTheSessionWithItsFailure) {
  class Broken : public test::TimedScript {
   public:
    Broken() : TimedScript(5) {}
    Result<bool> advance(World& world, Progress& progress, double dt) override {
      if (world.report().time > 0.05)
        return fail(FailureKind::scenario, "attempt to index a nil value", "", {"x.lua", 9, {}});
      return TimedScript::advance(world, progress, dt);
    }
  } script;
  const SessionResult result = played(script, script.demo());
  EXPECT_EQ(result.end, SessionEnd::failed);
  EXPECT_EQ(result.failure.kind, FailureKind::scenario);
  EXPECT_EQ(result.progress.steps().at(0).outcome, "aborted");
  EXPECT_NEAR(result.traces.time.back(), 0.06, 1e-12);
}

TEST(Runner, AnInputThatCannotBeFollowedEndsTheSessionInTheStateBeforeIt) {
  class Absurd : public InputSource {
   public:
    Result<std::optional<StepInput>> next(const World& world, double) override {
      StepInput input;
      input.instruments.push_back(world.report().instruments[0].pose);
      input.instruments[0].insertion += 2e-3;                                             // into the ball
      if (world.report().time > 0.05) input.instruments.push_back(input.instruments[0]);  // one too many
      return std::optional<StepInput>(input);
    }
  } source;
  test::TimedScript script(5);
  World world = small_world();
  std::vector<std::vector<Vec3>> skins;
  SessionOptions options;
  options.observer = [&](const World& now, const Progress&, bool) {
    skins.push_back(now.skin_positions(OrganIndex(0)));
  };
  const SessionResult result = run_session(world, script, source, options);
  EXPECT_EQ(result.end, SessionEnd::failed);
  ASSERT_EQ(result.state_hashes.size(), 5u)
      << "rest, three steps, and the state in which the last one failed";
  EXPECT_NE(skins[3], skins[2]) << "a ball that nothing moves shows nothing";
  EXPECT_EQ(world.skin_positions(OrganIndex(0)), skins[3]);
  // Another world, brought there by the same inputs, knows nothing of the failed step.
  World other = small_world();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(other.step(*source.next(other, 0.02).value()));
  EXPECT_EQ(result.state_hashes[4], other.state_hash());
}

TEST(Runner, AnOrganThatIsComparedGetsItsDifferencesWhenItHasBeenMoved) {
  SceneDefinition scene = test::small_scene();
  // Far from the waiting tool, which is to reach the other one only.
  scene.anatomy.organs[0].neck = OrganDefinition{}.neck;
  scene.anatomy.organs[0].fundus = OrganDefinition{}.fundus;
  OrganDefinition other = scene.anatomy.organs[0];
  other.name = "other";
  other.nodes = 90;
  for (Vec3* place : {&other.neck, &other.fundus}) place->x() += 60e-3;
  scene.anatomy.organs[0].compared_with = "other";
  scene.anatomy.organs.push_back(other);
  World world = World::create(scene).value();
  const SkinDifferences differences(world);
  EXPECT_FALSE(differences.of(world, 0)) << "nothing has moved";
  EXPECT_FALSE(differences.of(world, 1)) << "it is compared with none";
  // Only the other one is pressed.
  const Vec3 trocar = world.port_position("right_subcostal"), top = world.landmark("other.fundus"),
             in = world.landmark("other.neck") - top;
  for (double share : {-0.2, -0.1, 0.0, 0.05}) {
    StepInput input;
    input.instruments = {pose_reaching(trocar, top + share * in, 0, 0)};
    const Result<StepReport> step = world.step(input);
    ASSERT_TRUE(step) << to_text(step.failure());
  }
  const std::optional<SkinDifference> found = differences.of(world, 0);
  ASSERT_TRUE(found);
  // Both are solved together, so the one at rest is brought nearer to balance within the solver's tolerance.
  EXPECT_NEAR(found->largest_pct, 100, 100 * scene.solver.tolerance) << "one has not moved at all";
  EXPECT_GT(found->mean_pct, 0);
  EXPECT_LT(found->mean_pct, found->largest_pct);
}

TEST(Runner, AStepThatWasDoneAsItBeganIsNoted) {
  const double dt = 1 / test::small_scene().solver.rate;
  test::TimedScript at_once(dt), later(2 * dt);
  const std::vector<std::string> notes = played(at_once, at_once.demo()).notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0], "step only was done as it began: what it waits for held already");
  EXPECT_TRUE(played(later, later.demo()).notes.empty());
}

TEST(Report, ASessionThatWasCutHasNoTotal) {
  test::TimedScript script(0.2);
  SessionResult result;
  result.end = SessionEnd::interrupted;
  SessionReport report;
  report.score.total = 100;
  report.aborted = true;
  const auto json = nlohmann::json::parse(report_json(script.definition(), result, report));
  EXPECT_TRUE(json["score"]["total"].is_null());
  EXPECT_FALSE(json["score"]["passed"].get<bool>());
  EXPECT_TRUE(json["score"]["parts"].is_array());
}

TEST(Report, HoldsEveryPromisedKeyAndItsPointsSumToTheTotal) {
  test::TimedScript script(0.2);
  SessionResult result = played(script, script.demo());
  EXPECT_TRUE(result.notes.empty()) << "everything could be measured";
  result.notes = {"a note"};
  result.rest = {"ball lies elsewhere"};
  SessionReport report;
  report.score = score(script.definition(), result.metrics, result.progress).value();
  const auto json = nlohmann::json::parse(report_json(script.definition(), result, report));
  for (const char* key :
       {"schema", "scenario", "seed", "steps", "events", "metrics", "score", "state_hash", "timing"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["schema"], "calot.report/1");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["notes"], nlohmann::json::array({"a note"}));
  EXPECT_EQ(json["rest"], nlohmann::json::array({"ball lies elsewhere"}));
  EXPECT_GT(json["timing"]["real_time_factor"].get<double>(), 0);
  EXPECT_GT(json["timing"]["slowest_second_s"].get<double>(), 0);
  EXPECT_EQ(result.timing.step_s.size() + 1, result.state_hashes.size());
  EXPECT_LE(json["timing"]["step_ms"]["p99"], json["timing"]["step_ms"]["longest"]);
  EXPECT_GT(json["timing"]["step_ms"]["median"].get<double>(), 0);
  EXPECT_TRUE(json["timing"]["steps_over_time"].is_number_integer());
  EXPECT_LE(json["timing"]["slowest_second_s"].get<double>(), json["timing"]["simulation_s"].get<double>());
  double sum = 0;
  for (const auto& part : json["score"]["parts"]) {
    for (const char* key : {"name", "measured", "benchmark", "points", "weight", "event_times_s"}) {
      EXPECT_TRUE(part.contains(key)) << key;
    }
    EXPECT_EQ(part["benchmark"]["calibration"], "uncalibrated");
    sum += part["points"].get<double>();
  }
  EXPECT_NEAR(json["score"]["total"].get<double>(), sum, 1e-9);
  EXPECT_EQ(json["events"].back()["event"], "step_done");
  EXPECT_NEAR(json["events"].back()["duration_s"].get<double>(), 0.2, 1e-12);
}

TEST(Report, SaysHowManyPicturesWereShownASecondAndInRealTimeHowSoon) {
  SessionReport report;
  report.live.emplace();
  const auto operated = [&] {
    const std::string text = report_json(test::small_exercise(), SessionResult(), report);
    return nlohmann::json::parse(text)["operated"];
  };
  EXPECT_FALSE(operated().contains("pictures")) << "there was no window";
  report.live->pictures = {.shown = 31, .running = 2, .wait_median = 0.08, .wait_most = 0.3};
  EXPECT_DOUBLE_EQ(operated()["pictures"]["a_second"].get<double>(), 15) << "30 followed the first in 2 s";
  EXPECT_DOUBLE_EQ(operated()["pictures"]["input_to_picture_s"]["median"].get<double>(), 0.08);
  report.live->stamped = true;
  EXPECT_FALSE(operated()["pictures"].contains("input_to_picture_s"));
}

TEST(Report, TextThatIsNotUtf8IsReplacedNotRefused) {
  ExerciseDefinition exercise = test::small_exercise();
  exercise.title = "bad \xff byte";
  const std::string text = report_json(exercise, SessionResult(), SessionReport());
  EXPECT_TRUE(nlohmann::json::accept(text));
}

TEST(StepTable, HasOneColumnCountThroughoutAndARowAState) {
  const test::Folder folder;
  test::TimedScript script(0.1);
  Result<StepTable> table =
      StepTable::create((folder.path() / "steps.csv").string(), script.definition().scene);
  ASSERT_TRUE(table);
  SessionOptions options;
  options.table = &table.value();
  played(script, script.demo(), options);
  std::ifstream in(folder.path() / "steps.csv");
  std::string line;
  std::vector<std::ptrdiff_t> commas;
  while (std::getline(in, line)) commas.push_back(std::count(line.begin(), line.end(), ','));
  EXPECT_EQ(commas, std::vector<std::ptrdiff_t>(7, 12));  // header, rest, 5 steps; 13 columns
}

OrganDefinition held_tube(const std::string& name, double y) {
  OrganDefinition tube;
  tube.name = name;
  tube.shape = TubeShape{.points = {Vec3(0, y, -0.2), Vec3(0.03, y, -0.2)}};
  tube.held = {{"first", "start", 5e-3, 1e6}, {"second", "end", 5e-3, 1e6}};
  return tube;
}

/// A ball, and far from it a duct and a vein.
ExerciseDefinition changing_exercise() {
  ExerciseDefinition exercise = test::small_exercise();
  exercise.scene.anatomy.organs.push_back(held_tube("duct", 0.1));
  exercise.scene.anatomy.organs.push_back(held_tube("vein", 0.08));
  return exercise;
}

/// After three steps the duct is divided and the vein removed, after six another one comes.
class ChangingScript : public test::TimedScript {
 public:
  explicit ChangingScript(const ExerciseDefinition& exercise) : TimedScript(0.2, exercise) {}
  Result<bool> advance(World& world, Progress& progress, double dt) override {
    const int step = static_cast<int>(std::lround(world.report().time / dt));
    if (step == 3) {
      EXPECT_TRUE(world.divide("duct", 0.5));
      EXPECT_TRUE(world.remove("vein", "taken out"));
    }
    if (step == 6) {
      EXPECT_TRUE(world.add(held_tube("third", 0.06)));
    }
    return TimedScript::advance(world, progress, dt);
  }
};

SessionResult played_changing(ChangingScript& script, InputSource& source, const SessionOptions& options) {
  Result<World> world = World::create(script.definition().scene);
  EXPECT_TRUE(world) << to_text(world.failure());
  return run_session(world.value(), script, source, options);
}

TEST(ChangingOrgans, KeepTheirRowsAndMetricsForAsLongAsTheyAreThere) {
  const test::Folder folder;
  const std::string path = (folder.path() / "steps.csv").string();
  ChangingScript script(changing_exercise());
  Result<StepTable> table = StepTable::create(path, script.definition().scene);
  ASSERT_TRUE(table);
  SessionOptions options;
  options.table = &table.value();
  const SessionResult result = played_changing(script, script.demo(), options);
  std::ifstream in(path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    rows.emplace_back();
    std::stringstream fields(line + ",");
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  ASSERT_EQ(rows.size(), 12u);  // header, rest, 10 steps
  const auto filled = [&](const std::string& organ) {
    const auto column = std::find(rows[0].begin(), rows[0].end(), organ + ".max_stretch") - rows[0].begin();
    std::vector<std::size_t> out;
    for (std::size_t k = 1; k < rows.size(); ++k) {
      EXPECT_EQ(rows[k].size(), rows[0].size()) << k;
      if (!rows[k].at(static_cast<std::size_t>(column)).empty()) out.push_back(k - 1);
    }
    return out;
  };
  const auto from_to = [](std::size_t first, std::size_t last) {
    std::vector<std::size_t> out;
    for (std::size_t k = first; k <= last; ++k) out.push_back(k);
    return out;
  };
  EXPECT_EQ(filled("ball"), from_to(0, 10));
  EXPECT_EQ(filled("duct"), from_to(0, 3));
  EXPECT_EQ(filled("vein"), from_to(0, 3));
  EXPECT_EQ(filled("duct.patient"), from_to(4, 10));
  EXPECT_EQ(filled("duct.specimen"), from_to(4, 10));
  EXPECT_EQ(filled("third"), from_to(7, 10));
  const std::map<std::string, double> metrics =
      measure(script.definition().scene, result.traces, result.progress);
  for (const char* organ : {"ball", "duct", "vein", "duct.patient", "duct.specimen", "third"})
    EXPECT_TRUE(metrics.contains(std::string(organ) + ".max_stretch")) << organ;
  EXPECT_EQ(result.traces.organs[1].size(), 4u);
}

TEST(ChangingOrgans, AReplayRunsTheSameStepsToTheSameBits) {
  const test::Folder folder;
  const std::string path = (folder.path() / "recording.jsonl").string();
  ChangingScript script(changing_exercise());
  const World at_rest = World::create(script.definition().scene).value();
  Result<RecordingWriter> writer =
      RecordingWriter::create(path, recording_header(script.definition(), at_rest, "small.lua"));
  ASSERT_TRUE(writer);
  SessionOptions options;
  options.recording = &writer.value();
  const SessionResult first = played_changing(script, script.demo(), options);
  const Result<Recording> recording = read_recording(path);
  ASSERT_TRUE(recording) << to_text(recording.failure());
  ChangingScript again(changing_exercise());
  ReplaySource source(recording.value());
  const SessionResult second = played_changing(again, source, {});
  EXPECT_EQ(second.state_hashes, first.state_hashes);
  ASSERT_EQ(recording->steps.size() + 1, second.state_hashes.size());
  for (std::size_t k = 0; k < recording->steps.size(); ++k)
    EXPECT_EQ(recording->steps[k].state_hash, second.state_hashes[k + 1]) << k;
  EXPECT_EQ(first.state_hashes.size(), 11u);
}

}  // namespace
}  // namespace calot
