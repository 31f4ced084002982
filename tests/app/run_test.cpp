// Playing, recording and replaying, from the outside.

#include <nlohmann/json.hpp>
#include <set>

#include "app/program.h"

namespace calot::test {
namespace {

using Json = nlohmann::json;

class Run : public ProgramTest {
 protected:
  /// The report of a run that must succeed.
  Json report(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    const Outcome outcome = calot(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::accept(outcome.out) ? Json::parse(outcome.out) : Json();
  }
};

TEST_F(Run, PrintsStepsMetricsAndScoreAndWritesEverythingIntoItsFolder) {
  const Outcome outcome = calot({"run", "small.lua", "-o", "here", "--size", "320x180"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* word :
       {"Steps", "move", "Metrics", "left.path_length_mm", "Score", "State hash", "here"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word << "\n" << outcome.out;
  }
  std::set<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "here"))
    files.insert(entry.path().filename());
  EXPECT_EQ(files, (std::set<std::string>{"end.png", "recording.jsonl", "report.json", "steps.csv",
                                          "t000.00s.png", "t000.40s.png"}));
}

TEST_F(Run, WritesIntoOutByDefault) {
  EXPECT_EQ(calot({"run", "small.lua", "--no-render"}).code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "out" / "small" / "report.json"));
}

TEST_F(Run, JsonPrintsTheReportAndNothingElse) {
  const Json printed = report({"run", "small.lua", "--no-render", "-o", "here"});
  EXPECT_EQ(printed, Json::parse(slurp(folder_ / "here" / "report.json")));
  EXPECT_EQ(printed["schema"], "calot.report/1");
  EXPECT_EQ(printed["scenario"], "small");
  EXPECT_EQ(printed["steps"][0]["outcome"], "done");
}

TEST_F(Run, JsonOfAFailureIsOneVersionedObjectToo) {
  const Outcome missing = calot({"run", "none.lua", "--json"});
  EXPECT_EQ(Json::parse(missing.out)["schema"], "calot.failure/1");
  EXPECT_EQ(Json::parse(missing.out)["exit_code"], 4);
  spill(folder_ / "broken.lua", "return {\n");
  const Outcome broken = calot({"run", "broken.lua", "--json"});
  EXPECT_EQ(broken.code, 6);
  EXPECT_EQ(Json::parse(broken.out)["problems"][0]["line"], 2) << broken.out;
}

TEST_F(Run, AScoreBelowTheMarkExitsWithOne) {
  EXPECT_EQ(calot({"run", "small.lua", "--no-render", "--fail-below", "1"}).code, 0);
  const Outcome outcome = calot({"run", "small.lua", "--no-render", "--fail-below", "99.9"});
  EXPECT_EQ(outcome.code, 1) << outcome.out;
  expect_next_command(outcome);
}

TEST_F(Run, SeedAndParametersReachTheReport) {
  const Json json = report({"run", "small.lua", "--no-render", "--seed", "42", "--param", "height=12"});
  EXPECT_EQ(json["seed"], 42);
  EXPECT_EQ(std::stod(json["params"]["height"].get<std::string>()), 12) << json["params"];
}

TEST_F(Run, ASyntaxErrorNamesFileAndLine) {
  spill(folder_ / "broken.lua", "local calot = require 'calot'\nreturn calot.exercise {\n  api = = 1,\n}\n");
  const Outcome outcome = calot({"run", "broken.lua"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_NE(outcome.err.find("broken.lua:3"), std::string::npos) << outcome.err;
  expect_next_command(outcome);
}

TEST_F(Run, AnErrorInsideAStepNamesFileAndLineAndKeepsWhatWasDone) {
  spill(
      folder_ / "late.lua",
      small_scenario("t:step('a', 'A')\n t:wait_until(function()\n return t:time() > 0.2 and nil + 1 end)"));
  const Outcome outcome = calot({"run", "late.lua", "--no-render", "-o", "here"});
  EXPECT_EQ(outcome.code, 6) << outcome.err;
  EXPECT_NE(outcome.err.find("late.lua:15"), std::string::npos) << outcome.err;
  expect_next_command(outcome);
  const Json json = Json::parse(slurp(folder_ / "here" / "report.json"));
  EXPECT_EQ(json["end"], "failed");
  EXPECT_EQ(json["steps"][0]["outcome"], "aborted");
  EXPECT_NE(outcome.out.find("Score none"), std::string::npos) << "it has none: it was broken off";
}

TEST_F(Run, AnEndlessLoopInAStepEndsWithTheResourceCode) {
  spill(folder_ / "loop.lua",
        small_scenario(
            "t:step('a', 'A')\n t:wait(0.1 * s)\n if t:time() > 0.05 then\n while true do end\n end"));
  const Outcome outcome = calot({"run", "loop.lua", "--no-render"});
  EXPECT_EQ(outcome.code, 7) << outcome.err;
  expect_next_command(outcome);
}

TEST_F(Run, APatternThatNeverEndsIsStoppedFromOutsideAndItsRecordingReplays) {
  spill(folder_ / "hang.lua",
        small_scenario("t:step('a', 'A')\n t:wait_until(function()\n return t:time() > 0.1 and "
                       "string.find(('a'):rep(60), ('a-'):rep(60) .. 'b') end)"));
  const Outcome outcome = calot({"run", "hang.lua", "--no-render", "-o", "here"});
  EXPECT_EQ(outcome.code, 7) << outcome.err;
  EXPECT_NE(outcome.err.find("hang.lua"), std::string::npos) << outcome.err;
  expect_next_command(outcome);
  spill(folder_ / "hang.lua", small_scenario());  // the same field, a script that ends
  const Outcome replay = calot({"replay", "here/recording.jsonl"});
  EXPECT_EQ(replay.code, 0) << replay.err;
  EXPECT_NE(replay.err.find("has changed since it was recorded"), std::string::npos) << replay.err;
}

TEST_F(Run, AnInterruptedRunKeepsItsReportAndARecordingThatReplays) {
  spill(folder_ / "long.lua",
        small_scenario(
            "t:step('wait', 'Wait'); t:wait(29 * s)",
            "while true do t.left:move_by({ 0, 0, -5 * mm }); t.left:move_by({ 0, 0, 5 * mm }) end"));
  const Outcome outcome = calot({"run", "long.lua", "--no-render", "-o", "here"}, [&](pid_t pid) {
    EXPECT_TRUE(wait_for_lines(folder_ / "here" / "recording.jsonl", 20));
    kill(pid, SIGINT);
  });
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  expect_next_command(outcome);
  const Json json = Json::parse(slurp(folder_ / "here" / "report.json"));
  EXPECT_EQ(json["end"], "interrupted");
  EXPECT_EQ(json["steps"][0]["outcome"], "aborted");
  const Json replayed = report({"replay", "here/recording.jsonl"});
  EXPECT_EQ(replayed["state_hash"], json["state_hash"]);
}

TEST_F(Run, AKilledRunsRecordingReplaysUpToItsLastStep) {
  spill(folder_ / "long.lua", small_scenario("t:step('wait', 'Wait'); t:wait(29 * s)"));
  const Outcome outcome = calot({"run", "long.lua", "--no-render", "-o", "here"}, [&](pid_t pid) {
    EXPECT_TRUE(wait_for_lines(folder_ / "here" / "recording.jsonl", 20));
    kill(pid, SIGKILL);
  });
  EXPECT_EQ(outcome.code, 128 + SIGKILL);
  const Json replayed = report({"replay", "here/recording.jsonl"});
  EXPECT_GE(replayed["timing"]["steps"].get<int>(), 18);
}

TEST_F(Run, AMotionThatCannotBeFollowedExitsWithEightAndSaysWhereWhenAndWhatToChange) {
  // A ball fixed to a table, and a tool that is sent through both.
  std::string text = small_scenario("t:step('push', 'Push'); t:wait(10 * s)",
                                    "t.left:move_to('ball.fundus', { speed = 100 * mm / s }); "
                                    "t.left:move_by({ 0, 0, -60 * mm }, { speed = 100 * mm / s })");
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  replace("anatomy = {", "anatomy = { support = { point = { -60 * mm, 100 * mm, -120.6 * mm } },");
  replace("name = \"ball\",",
          "name = \"ball\", neck = { -60 * mm, 100 * mm, -120 * mm }, fundus = { -60 * mm, 100 * mm, -80 * "
          "mm },");
  replace("{ landmark = \"bed\" }", "{ landmark = \"neck\", radius = 30 * mm, stiffness = 1e7 }");
  spill(folder_ / "through.lua", text);
  const Outcome outcome = calot({"run", "through.lua", "--no-render", "-o", "here"});
  EXPECT_EQ(outcome.code, 8) << outcome.out << outcome.err;
  for (const char* part : {"'left'", ") mm ", " s (", "move more slowly", "Next: calot replay"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << "\n" << outcome.err;
  EXPECT_TRUE(Json::accept(slurp(folder_ / "here" / "report.json")));
  EXPECT_EQ(calot({"replay", "here/recording.jsonl"}).code, 8) << "a replay fails where the run did";
}

TEST_F(Run, ReplayEqualsRun) {
  const Json run = report({"run", "small.lua", "--no-render", "-o", "here"});
  const Json replay = report({"replay", "here/recording.jsonl"});
  EXPECT_EQ(replay["state_hash"], run["state_hash"]);
  EXPECT_EQ(replay["metrics"], run["metrics"]);
  EXPECT_EQ(replay["score"], run["score"]);
  EXPECT_EQ(replay["events"], run["events"]);
}

TEST_F(Run, AReplayOfOtherInputsNamesTheFirstStepThatDiffers) {
  report({"run", "small.lua", "--no-render", "-o", "here"});
  const fs::path file = folder_ / "here" / "recording.jsonl";
  std::string text = slurp(file);
  // The roll of step 10 becomes 0.5 rad.
  std::size_t line = 0;
  for (int i = 0; i < 10; ++i) line = text.find('\n', line) + 1;
  const std::size_t end = text.find("]", line), jaw = text.rfind(',', end), roll = text.rfind(',', jaw - 1);
  text.replace(roll + 1, jaw - roll - 1, "0.5");
  spill(file, text);
  const Outcome outcome = calot({"replay", "here/recording.jsonl"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("at step 10 (0.200 s)"), std::string::npos) << outcome.err;
  expect_next_command(outcome);
}

TEST_F(Run, ARecordingOfAnotherScenarioIsRefused) {
  report({"run", "small.lua", "--no-render", "-o", "here"});
  std::string other = small_scenario();
  other.replace(other.find("id = \"small\""), 12, "id = \"other\"");
  spill(folder_ / "other.lua", other);
  const Outcome outcome = calot({"replay", "here/recording.jsonl", "--scenario", "other.lua"});
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  expect_next_command(outcome);
}

TEST_F(Run, ARecordingWhoseScenarioIsGoneAsksForItByOption) {
  ASSERT_EQ(calot({"run", "small.lua", "--no-render", "-o", "here"}).code, 0);
  fs::rename(folder_ / "small.lua", folder_ / "other.lua");
  const Outcome lost = calot({"replay", "here/recording.jsonl"});
  EXPECT_EQ(lost.code, 4);
  EXPECT_NE(lost.err.find("--scenario FILE"), std::string::npos) << lost.err;
  expect_next_command(lost);
  EXPECT_EQ(calot({"replay", "here/recording.jsonl", "--scenario", "other.lua"}).code, 0);
}

TEST_F(Run, TwentyFreshProcessesReachTheSameStateWithAndWithoutPictures) {
  std::set<std::string> hashes;
  for (int i = 0; i < 20; ++i) {
    std::vector<std::string> arguments{"run", "small.lua", "-o", "here", "--size", "160x90"};
    if (i % 2 == 0) arguments.push_back("--no-render");
    hashes.insert(report(arguments)["state_hash"].get<std::string>());
  }
  EXPECT_EQ(hashes.size(), 1u);
}

TEST_F(Run, CheckTellsGoodScenariosFromBadOnesAndPlaysNeither) {
  spill(folder_ / "set" / "good.lua", small_scenario());
  spill(folder_ / "set" / "bad.lua", small_scenario() + "\n)");
  EXPECT_EQ(calot({"check", "set/good.lua"}).code, 0);
  const Outcome both = calot({"check", "set"});
  EXPECT_EQ(both.code, 6);
  EXPECT_NE(both.out.find("set/good.lua"), std::string::npos);
  EXPECT_NE(both.err.find("set/bad.lua:"), std::string::npos) << both.err;
  expect_next_command(both);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  const Json json = Json::parse(calot({"check", "set", "--json"}).out);
  EXPECT_EQ(json["schema"], "calot.check/1");
  EXPECT_EQ(json["scenarios"].size(), 2u);
  fs::create_directories(folder_ / "empty");
  EXPECT_EQ(calot({"check", "empty"}).code, 5);
}

}  // namespace
}  // namespace calot::test
