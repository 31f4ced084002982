// Playing, recording and replaying, from the outside.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/program.h"
#include "play/play.h"

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
  EXPECT_EQ(files, (std::set<std::string>{"end.png", "events.csv", "recording.jsonl", "report.json",
                                          "steps.csv", "t000.00s.png", "t000.40s.png"}));
}

TEST_F(Run, AProfileHasARowForEachStepAndTheirTimesAreTheReports) {
  const Json json = report({"run", "small.lua", "--no-render", "--profile", "-o", "here"});
  std::istringstream rows(slurp(folder_ / "here" / "profile.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_TRUE(row.starts_with("time_s,wall_ms,parts,solves,newton_steps,factorisations,")) << row;
  double sum = 0, longest = 0;
  int count = 0;
  for (; std::getline(rows, row); ++count) {
    const double ms = std::stod(row.substr(row.find(',') + 1));
    sum += ms;
    longest = std::max(longest, ms);
  }
  EXPECT_EQ(count, json["timing"]["steps"]);
  EXPECT_NEAR(sum, 1e3 * json["timing"]["simulation_s"].get<double>(), 5e-4 * count) << "three decimals each";
  EXPECT_NEAR(longest, json["timing"]["step_ms"]["longest"].get<double>(), 5e-4);
  EXPECT_NE(slurp(folder_ / "here" / "profile.svg").find("<svg"), std::string::npos);
  EXPECT_EQ(calot({"replay", "here/recording.jsonl", "--profile"}).code, 4) << "it has nowhere to write it";
  EXPECT_EQ(calot({"replay", "here/recording.jsonl", "--no-render", "--profile", "-o", "again"}).code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "again" / "profile.csv"));
}

TEST_F(Run, UntilATimeIsPlayedNoFurtherScoredAsUnfinishedAndReplays) {
  const Json part = report({"run", "small.lua", "--until", "0.2", "-o", "here", "--size", "320x180"});
  EXPECT_EQ(part["end"], "source_ended");
  EXPECT_NEAR(part["metrics"]["total.time_s"].get<double>(), 0.2, 1e-9);
  EXPECT_EQ(part["score"]["outcome"], "unfinished");
  EXPECT_TRUE(fs::exists(folder_ / "here" / "t000.00s.png"));
  EXPECT_FALSE(fs::exists(folder_ / "here" / "t000.40s.png")) << "its time did not come";
  EXPECT_EQ(calot({"replay", "here/recording.jsonl"}).code, 0);
  for (const char* wrong : {"-1", "nan", "soon"})
    EXPECT_EQ(calot({"run", "small.lua", "--until", wrong}).code, 4) << wrong;
  EXPECT_EQ(calot({"run", "small.lua", "--at", "0.1,nan"}).code, 4);
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

TEST_F(Run, JawsOfTwoHandsThatCloseOnOneBeadComeFreeAgainAndFeelNoMoreThanHandsDo) {
  spill(folder_ / "lock.lua", R"(local calot = require "calot"
local mm, s, deg = calot.units.mm, calot.units.s, calot.units.deg
local start, ports = { -76 * mm, 95 * mm, -114.5 * mm }, { { -115 * mm, 60 * mm, -5 * mm }, { 5 * mm, 60 * mm, -5 * mm } }
return calot.exercise { api = 2, id = "lock", title = "Two hands at one bead", time_limit = 7.4 * s,
  scene = function() return {
    anatomy = { table_head_up = 0, table_left_down = 0, friction = 0.3,
      ground = { { name = "board", point = { 0, 0, -120 * mm }, friction = 0.4 } },
      organs = { { name = "bead", shape = { type = "rigid", rounding = 5 * mm, centre = start, density = 1100 } } } },
    ports = { a = ports[1], b = ports[2] }, instruments = { left = { port = "a" }, right = { port = "b" } },
    laparoscope = { look_at = "bead.centre" }, solver = { motion = "dynamic" } } end,
  steps = function(t) t:step("x", "X") t:wait(7.3 * s) end,
  demo = function(t)
    local function minus(a, b) return { a[1] - b[1], a[2] - b[2], a[3] - b[3] } end
    local function take(hand, port, off, past)
      local c = t:place("bead.centre")
      local at = { c[1] + off[1], c[2] + off[2], c[3] + off[3] }
      local way = minus(port, at)
      local long = math.sqrt(way[1] ^ 2 + way[2] ^ 2 + way[3] ^ 2)
      local function before(by) return { at[1] + by / long * way[1], at[2] + by / long * way[2], at[3] + by / long * way[3] } end
      hand:open(40 * deg)
      hand:move_to(before(20 * mm), { speed = 100 * mm / s })
      hand:move_to(before(-past), { speed = 40 * mm / s })
      hand:close()
    end
    local function carry(hand, to) hand:move_by(minus(to, t:place("bead.centre")), { speed = 60 * mm / s }) end
    take(t.left, ports[1], { 0, 0, 0 }, 2.5 * mm)
    carry(t.left, { -76 * mm, 95 * mm, -84.5 * mm })
    carry(t.left, { -57 * mm, 95 * mm, -80 * mm })
    take(t.right, ports[2], { 2 * mm, 0, 0 }, 2 * mm)
    t.left:open(40 * deg)
    t.left:move_by({ -20 * mm, -10 * mm, 12 * mm }, { speed = 60 * mm / s })
  end,
}
)");
  const Json json = report({"run", "lock.lua", "--no-render"});
  EXPECT_EQ(json["metrics"]["left.clashes"], 1);
  for (const char* hand : {"left", "right"}) {
    // A hand does 20 N at the tip.
    EXPECT_LT(json["metrics"][std::string(hand) + ".peak_handle_force_N"].get<double>(), 25) << hand;
    EXPECT_LT(json["metrics"][std::string(hand) + ".peak_lag_mm"].get<double>(), 5) << hand;
  }
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
  EXPECT_NE(outcome.err.find("Next: mend what is named above, then: calot check --build late.lua"),
            std::string::npos)
      << outcome.err;
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
  EXPECT_EQ(replay.code, 1) << replay.err;
  EXPECT_NE(replay.err.find("has changed since it was recorded"), std::string::npos) << replay.err;
  EXPECT_NE(replay.err.find("the recording has no end"), std::string::npos) << replay.err;
}

TEST_F(Run, AnInterruptedRunKeepsItsReportAndARecordingThatReplays) {
  spill(folder_ / "long.lua", endless_scenario());
  const Outcome outcome = calot({"run", "long.lua", "--no-render", "-o", "here"}, [&](pid_t pid) {
    EXPECT_TRUE(wait_for_lines(folder_ / "here" / "recording.jsonl", 20));
    kill(pid, SIGINT);
  });
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  expect_next_command(outcome);
  EXPECT_NE(outcome.err.find("what was done so far is in here"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("Score none"), std::string::npos) << outcome.out;
  const Json json = Json::parse(slurp(folder_ / "here" / "report.json"));
  EXPECT_EQ(json["end"], "interrupted");
  EXPECT_EQ(json["steps"][0]["outcome"], "aborted");
  EXPECT_TRUE(json["score"]["total"].is_null());
  const Json replayed = report({"replay", "here/recording.jsonl"});
  EXPECT_EQ(replayed["state_hash"], json["state_hash"]);
  EXPECT_TRUE(replayed["score"]["total"].is_null()) << "played again, it is still cut";
}

TEST_F(Run, AKilledRunsRecordingReplaysUpToItsLastStep) {
  spill(folder_ / "long.lua", endless_scenario());
  const Outcome outcome = calot({"run", "long.lua", "--no-render", "-o", "here"}, [&](pid_t pid) {
    EXPECT_TRUE(wait_for_lines(folder_ / "here" / "recording.jsonl", 20));
    kill(pid, SIGKILL);
  });
  EXPECT_EQ(outcome.code, 128 + SIGKILL);
  const Outcome replay = calot({"replay", "here/recording.jsonl", "--json", "--no-render", "-o", "again"});
  EXPECT_EQ(replay.code, 1) << replay.err;
  const Json replayed = Json::parse(replay.out);
  const int steps = replayed["timing"]["steps"];
  EXPECT_GE(steps, 18);
  EXPECT_NE(replay.err.find(fmt::format("it was cut, and stops at step {} ({:.3f} s)", steps, steps / 50.0)),
            std::string::npos)
      << replay.err;
  EXPECT_NE(replayed["notes"].dump().find("has no end"), std::string::npos);
  EXPECT_EQ(replay.err.find("parts from"), std::string::npos) << "every state is that of the recording";
  expect_next_command(replay);
  // What the replay wrote has an end, and says of what.
  EXPECT_NE(slurp(folder_ / "again/recording.jsonl").find("{\"end\":\"cut\",\"steps\":"), std::string::npos);
  const Outcome scored = calot({"score", "long.lua", "again/recording.jsonl", "--json"});
  EXPECT_EQ(scored.code, 1) << scored.err;
  const Json entry = Json::parse(scored.out)["recordings"][0];
  EXPECT_EQ(entry["from"], "recording");
  EXPECT_EQ(entry["end"], "cut");
  EXPECT_FALSE(entry["whole"].get<bool>());
  EXPECT_NE(entry["notes"].dump().find("is played from one without an end"), std::string::npos);
}

TEST_F(Run, AMotionThatCannotBeFollowedExitsWithEightAndSaysWhereWhenAndWhatToChange) {
  // A ball that is held by three quarters, and a tool that is sent through it by a strong hand, in steps of 95 mm.
  std::string text =
      small_scenario("t:step('push', 'Push'); t:wait(10 * s)",
                     "t.left:move_to({ -60 * mm, 100 * mm, -75 * mm }, { speed = 100 * mm / s }); "
                     "t.left:move_by({ 0, 0, -95 * mm }, { speed = 500 * mm / s })");
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  replace("laparoscope =", "solver = { rate = 5 }, laparoscope =");
  replace("name = \"ball\",",
          "name = \"ball\", neck = { -60 * mm, 100 * mm, -120 * mm }, fundus = { -60 * mm, 100 * mm, -80 * "
          "mm },");
  replace("nodes = 61", "nodes = 20");
  replace("port = \"right_subcostal\"", "port = \"right_subcostal\", hand_force = 100");
  replace("{ landmark = \"bed\" }", "{ landmark = \"neck\", radius = 30 * mm, stiffness = 1e7 }");
  spill(folder_ / "through.lua", text);
  const Outcome outcome = calot({"run", "through.lua", "--no-render", "-o", "here"});
  EXPECT_EQ(outcome.code, 8) << outcome.out << outcome.err;
  for (const char* part : {"'left'", ") mm ", " s (", "move more slowly", "Next: calot replay"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << "\n" << outcome.err;
  EXPECT_TRUE(Json::accept(slurp(folder_ / "here" / "report.json")));
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
  const Outcome changed = calot({"replay", "here/recording.jsonl"});
  EXPECT_EQ(changed.code, 4);
  EXPECT_NE(changed.err.find("are not those that were recorded"), std::string::npos) << changed.err;
  // Someone who means it takes the checksum out.
  const std::size_t checksum = text.rfind(",\"checksum\"");
  spill(file, text.substr(0, checksum) + "}\n");
  const Outcome outcome = calot({"replay", "here/recording.jsonl"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("at step 10 (0.200 s)"), std::string::npos) << outcome.err;
  expect_next_command(outcome);
}

TEST_F(Run, ARecordingNamesNoFolderOfTheMachineAndIsFoundBelowItsProject) {
  const fs::path project = folder_ / "project";
  spill(project / "scenarios" / "deep" / "mine.lua", small_scenario());
  fs::create_directories(project / "scripts");
  fs::create_directory_symlink(fs::path(source_dir()) / "scripts" / "lua", project / "scripts" / "lua");
  const fs::path file = project / "scenarios" / "deep" / "mine.lua";
  const auto recorded = [&] {
    return Json::parse(slurp(folder_ / "here" / "recording.jsonl")
                           .substr(0, slurp(folder_ / "here" / "recording.jsonl").find('\n')))["file"];
  };
  // From elsewhere: below the present folder.
  ASSERT_EQ(calot({"run", file.string(), "--no-render", "-o", "here"}).code, 0);
  EXPECT_EQ(recorded(), "project/scenarios/deep/mine.lua");
  EXPECT_EQ(slurp(folder_ / "here" / "recording.jsonl").find(folder_.string()), std::string::npos);
  folder_ = project;  // from the project
  ASSERT_EQ(calot({"run", file.string(), "--no-render", "-o", "here"}).code, 0);
  EXPECT_EQ(recorded(), "scenarios/deep/mine.lua");
  fs::create_directories(project / "below");
  fs::rename(project / "here", project / "below" / "here");
  // The scenario has moved: it is found by its id.
  fs::rename(file, project / "scenarios" / "moved.lua");
  const Outcome moved = calot({"replay", "below/here/recording.jsonl"});
  EXPECT_EQ(moved.code, 0) << moved.err;
  EXPECT_NE(moved.err.find("moved.lua, the scenario whose id is small"), std::string::npos) << moved.err;
  // Two others of that id: which one is not for the program to say.
  spill(project / "scenarios" / "a.lua", small_scenario() + "-- changed\n");
  fs::rename(project / "scenarios" / "moved.lua", project / "scenarios" / "moved");
  EXPECT_EQ(calot({"replay", "below/here/recording.jsonl"}).code, 0);
  spill(project / "scenarios" / "b.lua", small_scenario() + "-- changed too\n");
  const Outcome several = calot({"replay", "below/here/recording.jsonl"});
  EXPECT_EQ(several.code, 4);
  EXPECT_NE(several.err.find("several scenarios"), std::string::npos) << several.err;
  folder_ = project.parent_path();
}

TEST_F(Run, PosesFromElsewhereArePlayedAndScoredAndSaidNotToBeCompared) {
  std::string text =
      R"({"schema":"calot.recording/1","scenario":"small","file":"small.lua","rate_Hz":50,"instruments":["left"]})"
      "\n";
  for (int i = 1; i <= 40; ++i)
    text += fmt::format(R"({{"time_s":{},"poses":[[0.6,0.25,{},0,0]]}})"
                        "\n",
                        i / 50.0, 0.03 + 0.0002 * i);
  spill(folder_ / "mine.jsonl", text + R"({"end":"done","steps":40})"
                                       "\n");
  const Outcome outcome = calot({"replay", "mine.jsonl"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("nothing was compared"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.out.find("Every state"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("of 100"), std::string::npos) << outcome.out;
}

TEST_F(Run, WhereTheCLibraryChoosesOtherMathematicsAReplayExpectsOtherBits) {
  const auto mathematics = [&] {
    const std::string out = calot({"doctor"}).out;
    const std::size_t at = out.find("mathematics: ");
    return out.substr(at, out.find('\n', at) - at);
  };
  const std::string here = mathematics();
  report({"run", "small.lua", "--no-render", "-o", "here"});
  setenv("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA", 1);
  const std::string there = mathematics();
  const Outcome outcome = calot({"replay", "here/recording.jsonl"});
  unsetenv("GLIBC_TUNABLES");
  if (here == there) GTEST_SKIP() << "this C library has no other mathematics on this processor";
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("other bits are expected"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.out.find("Every state"), std::string::npos) << outcome.out;
}

TEST_F(Run, ASecondRunLeavesTheFirstOnesFolderAloneUnlessAsked) {
  ASSERT_EQ(calot({"run", "small.lua", "--no-render"}).code, 0);
  const std::string first = slurp(folder_ / "out" / "small" / "report.json");
  const Outcome second = calot({"run", "small.lua", "--no-render", "--seed", "2"});
  EXPECT_NE(second.out.find("Written to out/small-2"), std::string::npos) << second.out;
  ASSERT_EQ(calot({"run", "small.lua", "--no-render", "--seed", "3"}).code, 0);
  EXPECT_EQ(slurp(folder_ / "out" / "small" / "report.json"), first);
  EXPECT_EQ(Json::parse(slurp(folder_ / "out" / "small-3" / "report.json"))["seed"], 3);
  ASSERT_EQ(calot({"run", "small.lua", "--no-render", "--seed", "4", "--overwrite"}).code, 0);
  EXPECT_EQ(Json::parse(slurp(folder_ / "out" / "small" / "report.json"))["seed"], 4);
  EXPECT_FALSE(fs::exists(folder_ / "out" / "small-4"));
}

TEST_F(Run, AFolderIsWrittenByOneRunAtATimeAndHoldsNothingOfOlderOnes) {
  spill(folder_ / "long.lua", endless_scenario());
  for (const char* old :
       {"report.json", "steps.csv", "end.png", "t003.20s.png", "t1003.20s.png", "report.json.part"})
    spill(folder_ / "here" / old, "of an older run");
  spill(folder_ / "here" / "notes.txt", "the user's");
  spill(folder_ / "here" / "tall.png", "the user's");
  const Outcome outcome = calot({"run", "long.lua", "--no-render", "-o", "here"}, [&](pid_t pid) {
    ASSERT_TRUE(wait_for_lines(folder_ / "here" / "recording.jsonl", 5));
    const Outcome second = calot({"run", "small.lua", "--no-render", "-o", "here"});
    EXPECT_EQ(second.code, 4);
    EXPECT_NE(second.err.find(fmt::format("process {} writes into here", pid)), std::string::npos)
        << second.err;
    expect_next_command(second);
    kill(pid, SIGKILL);
  });
  EXPECT_EQ(outcome.code, 128 + SIGKILL);
  std::set<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "here"))
    files.insert(entry.path().filename());
  EXPECT_EQ(files,
            (std::set<std::string>{".running", "notes.txt", "recording.jsonl", "steps.csv", "tall.png"}));
  EXPECT_EQ(slurp(folder_ / "here" / "steps.csv").find("older"), std::string::npos);
  // Killed as it was, it keeps nobody out.
  EXPECT_EQ(calot({"run", "small.lua", "--no-render", "-o", "here"}).code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "here" / ".running"));
}

TEST_F(Run, AReplayIsNotWrittenOverItsRecording) {
  report({"run", "small.lua", "--no-render", "-o", "here"});
  const std::string before = slurp(folder_ / "here" / "recording.jsonl");
  const Outcome outcome = calot({"replay", "here/recording.jsonl", "-o", "./here"});
  EXPECT_EQ(outcome.code, 4);
  expect_next_command(outcome);
  EXPECT_EQ(slurp(folder_ / "here" / "recording.jsonl"), before);
}

TEST_F(Run, TimesOfOnePictureAreDrawnOnceAndTooManyAreRefused) {
  const auto with_times = [](const std::string& times) {
    std::string text = small_scenario("t:step('a', 'A'); t:wait(0.02 * s)");
    text.replace(text.find("{ 0, 0.4 * s }"), 14, times);
    return text;
  };
  spill(folder_ / "same.lua", with_times("{ 0.01, 0, 0, 0.011, 0.014, 0.0 }"));
  PlayRequest request;
  request.scenario = folder_ / "same.lua";
  request.width = 64;
  request.height = 36;
  const Result<Played> played = play(request);
  ASSERT_TRUE(played) << to_text(played.failure());
  EXPECT_EQ(played->pictures, (std::vector<std::string>{"t000.00s", "t000.01s", "end"}));
  std::string many;
  for (int i = 0; i < 101; ++i) many += "0, ";
  spill(folder_ / "many.lua", with_times("{ " + many + "}"));
  const Outcome outcome = calot({"check", "many.lua"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_NE(outcome.err.find("many.lua:"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("101 pictures, more than 100"), std::string::npos) << outcome.err;
}

TEST_F(Run, AnInterruptionDoesNotWaitForAllThePicturesOfAMoment) {
  std::string times;
  for (int i = 0; i < 100; ++i) times += fmt::format("{}, ", i * 0.01);
  // One step a second: a hundred pictures fall due at once, 20 s of drawing.
  std::string text = small_scenario("t:step('a', 'A'); t:wait(5 * s)", "t.left:wait(1 * s)");
  text.replace(text.find("{ 0, 0.4 * s }"), 14, "{ " + times + "}");
  text.replace(text.find("laparoscope ="), 0, "solver = { rate = 1 }, ");
  spill(folder_ / "many.lua", text);
  using Clock = std::chrono::steady_clock;
  Clock::time_point asked;
  const Outcome outcome = calot({"run", "many.lua", "-o", "here"}, [&](pid_t pid) {
    for (int i = 0; i < 3000 && !fs::exists(folder_ / "here" / "t000.05s.png"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    asked = Clock::now();
    kill(pid, SIGINT);
  });
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_LT(std::chrono::duration<double>(Clock::now() - asked).count(), 5) << "a picture takes 0.2 s";
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
  // The ball is touched, pressed and grasped: without contact, states are easily the same.
  std::string text =
      small_scenario("t:step('take', 'Take it'); t:wait_until(function() return t.left:holds('ball') end)",
                     "t.left:approach('ball.fundus', { speed = 500 * mm / s }); t.left:close()");
  text.replace(text.find("nodes = 61"), 10, "nodes = 30");
  spill(folder_ / "take.lua", text);
  std::set<std::string> hashes;
  for (int i = 0; i < 20; ++i) {
    std::vector<std::string> arguments{"run", "take.lua", "-o", "here", "--size", "64x36"};
    if (i % 3 != 0) arguments.push_back("--no-render");
    const Json json = report(arguments);
    hashes.insert(json["state_hash"].get<std::string>());
    std::set<std::string> events;
    for (const Json& event : json["events"]) events.insert(event["event"].get<std::string>());
    ASSERT_TRUE(events.contains("contact") && events.contains("grasp")) << json["events"];
  }
  EXPECT_EQ(hashes.size(), 1u);
}

TEST_F(Run, AnInterruptedCheckSaysHowFarItCameAndExitsWithTwo) {
  for (int i = 0; i < 500; ++i) {
    fs::create_directories(folder_ / "set");
    fs::create_hard_link(folder_ / "small.lua", folder_ / "set" / fmt::format("{:03}.lua", i));
  }
  const Outcome outcome = calot({"check", "set"}, [&](pid_t pid) {
    EXPECT_TRUE(wait_for_lines(folder_ / ".stdout", 1));
    kill(pid, SIGINT);
  });
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("of 500 scenarios were checked"), std::string::npos) << outcome.err;
  expect_next_command(outcome);
}

TEST_F(Run, AnInterruptionWhileTheOrgansAreFilledEndsItWithTwo) {
  std::string text = small_scenario();
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("nodes = 61", "nodes = 1000, bile = { fill_volume = 200 * calot.units.mL }");  // takes ten seconds
  replace("scene = function()", "scene = function() print('here')");
  spill(folder_ / "slow.lua", text);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"run", "slow.lua", "--no-render"}, {"check", "--build", "slow.lua"}}) {
    fs::remove(folder_ / ".stderr");  // of the command before
    const Outcome outcome = calot(command, [&](pid_t pid) {
      EXPECT_TRUE(wait_for_lines(folder_ / ".stderr", 1));
      kill(pid, SIGINT);
    });
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(command[0] == "run" ? "interrupted while organ 'ball' was filled"
                                                   : "0 of 1 scenarios were checked"),
              std::string::npos)
        << outcome.err;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    expect_next_command(outcome);
  }
}

TEST_F(Run, APlaceOutOfReachIsSentToTheCheckThatFindsIt) {
  spill(folder_ / "far.lua",
        small_scenario("t:step('reach', 'Reach out'); t:wait(3 * s)",
                       "t.left:move_by({ 290 * mm, 290 * mm, 0 }, { speed = 500 * mm / s })\n"
                       "t.left:move_by({ 290 * mm, 290 * mm, 0 })"));
  const Outcome outcome = calot({"run", "far.lua", "--no-render"});
  EXPECT_EQ(outcome.code, 6) << outcome.err;
  EXPECT_NE(outcome.err.find("use another port"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("Next: mend what is named above, then: calot check --build far.lua\n"),
            std::string::npos)
      << outcome.err;
  const Outcome checked = calot({"check", "--build", "far.lua"});
  EXPECT_EQ(checked.code, 6);
  EXPECT_NE(checked.err.find("use another port"), std::string::npos) << checked.err;
}

TEST_F(Run, AnOrganThatCannotBeFilledIsNotToldToMoveMoreSlowly) {
  std::string text = small_scenario();
  text.replace(text.find("nodes = 61"), 10,
               "nodes = 30, bile = { fill_pressure = 90 * 133 }, wall = { shear_modulus = 1000 }");
  spill(folder_ / "full.lua", text);
  const Outcome outcome = calot({"run", "full.lua", "--no-render"});
  EXPECT_EQ(outcome.code, 6) << outcome.err << outcome.out;
  EXPECT_NE(outcome.err.find("while it was filled"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("fill it less"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("move more slowly"), std::string::npos) << outcome.err;
}

TEST_F(Run, ASceneThatIsRefusedCanBeLookedAtWithPinsWhereItsOrgansAreInEachOther) {
  std::string text = small_scenario();
  const std::string ball = "{ name = \"ball\",",
                    at = "neck = { 0.02, 0.1, -0.12 }, fundus = { 0.02, 0.1, -0.08 }";
  text.replace(text.find(ball), ball.size(), ball + " neck = { 0, 0.1, -0.12 }, fundus = { 0, 0.1, -0.08 },");
  text.insert(text.find("} } } },\n"), "} }, { name = 'other', shape = { type = 'sphere' }, nodes = 61, " +
                                           at + ", held = { { landmark = 'bed' } ");
  spill(folder_ / "refused.lua", text);
  const Outcome outcome = calot({"run", "refused.lua", "--show-refused", "-o", "there", "--size", "320x180"});
  EXPECT_EQ(outcome.code, 6) << outcome.out << outcome.err;
  EXPECT_NE(outcome.err.find("deep in each other"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("there/refused.png: 1 pin,"), std::string::npos) << outcome.out;
  expect_next_command(outcome);
  EXPECT_TRUE(fs::exists(folder_ / "there" / "refused.png"));
  const Outcome sound = calot({"run", "small.lua", "--show-refused"});
  EXPECT_EQ(sound.code, 0) << sound.err;
  EXPECT_NE(sound.out.find("not refused"), std::string::npos) << sound.out;
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
