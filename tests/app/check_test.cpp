// calot check: what it looks at, what it finds, what it costs.

#include <sys/resource.h>

#include "app/program.h"

namespace calot::test {
namespace {

using Check = ProgramTest;

TEST_F(Check, LooksBelowAFolderAndKnowsModules) {
  spill(folder_ / "set" / "good.lua", "local grips = require 'grips'\n" + small_scenario());
  spill(folder_ / "set" / "grips.lua", "return { fold = function() end }");
  spill(folder_ / "set" / "deeper" / "still" / "good.lua", small_scenario());
  spill(folder_ / "set" / ".hidden" / "bad.lua", ")");
  const Outcome good = calot({"check", "set"});
  EXPECT_EQ(good.code, 0) << good.err;
  EXPECT_NE(good.out.find("set/deeper/still/good.lua: A small exercise"), std::string::npos) << good.out;
  EXPECT_NE(good.out.find("set/grips.lua: a module"), std::string::npos) << good.out;
  EXPECT_NE(calot({"check", "set", "--json"}).out.find("\"module\": true"), std::string::npos);
  const Outcome named = calot({"check", "set/grips.lua"});
  EXPECT_EQ(named.code, 6);
  EXPECT_NE(named.err.find("set/grips.lua:1: the scenario returns no exercise"), std::string::npos)
      << named.err;
  spill(folder_ / "set" / "deeper" / "bad.lua", ")");
  EXPECT_EQ(calot({"check", "set"}).code, 6);
}

TEST_F(Check, SaysWhatIsWrongWithThePathNotWithLines) {
  const Outcome missing = calot({"check", "smal.lua"});
  EXPECT_EQ(missing.code, 4);
  EXPECT_NE(missing.err.find("there is no file smal.lua"), std::string::npos) << missing.err;
  EXPECT_EQ(missing.err.find("mend the lines"), std::string::npos) << missing.err;
  expect_next_command(missing);
  fs::create_symlink("/proc/self/mem", folder_ / "unreadable.lua");
  EXPECT_EQ(calot({"check", "unreadable.lua"}).code, 4);
  EXPECT_EQ(calot({"run", "unreadable.lua"}).code, 4);
}

TEST_F(Check, SaysThatASceneWithoutInstrumentsIsNotOperated) {
  const std::string said = "the scene has no instruments";
  spill(folder_ / "with.lua", small_scenario());
  EXPECT_EQ(calot({"check", "with.lua"}).out.find(said), std::string::npos);
  spill(folder_ / "without.lua",
        "local calot = require 'calot'\n"
        "return calot.exercise { api = 2, id = 'without', title = 'Nobody', time_limit = 1,\n"
        "scene = function() return { anatomy = { organs = { { shape = { type = 'sphere' }, nodes = 61,\n"
        "  neck = { 0, 0.1, -0.1 }, held = { { landmark = 'bed' } } } } } } end,\n"
        "steps = function(t) t:wait(0.1) end }");
  const Outcome without = calot({"check", "without.lua"});
  EXPECT_EQ(without.code, 0) << without.err;
  EXPECT_NE(without.out.find(said), std::string::npos) << without.out;
  EXPECT_NE(calot({"operate", "without.lua"}).code, 0);
}

TEST_F(Check, WithBuildSaysWhatComesToRestFarFromWhereItIsDrawn) {
  std::string text = small_scenario();
  const std::string anatomy = "anatomy = { ";
  text.replace(text.find(anatomy), anatomy.size(), anatomy + "rest_within = 0.001 * mm, ");
  spill(folder_ / "tight.lua", text);
  const std::string said = "ball came to rest ", furthest = " mm from where it is drawn, furthest near ball.";
  EXPECT_EQ(calot({"check", "tight.lua"}).out.find(said), std::string::npos) << "it is not built";
  const Outcome built = calot({"check", "--build", "tight.lua"});
  EXPECT_EQ(built.code, 0) << built.err;
  EXPECT_NE(built.out.find(said), std::string::npos) << built.out;
  EXPECT_NE(built.out.find(furthest), std::string::npos) << built.out;
  text.replace(text.find("0.001 * mm"), 10, "900 * mm");
  spill(folder_ / "wide.lua", text);
  EXPECT_EQ(calot({"check", "--build", "wide.lua"}).out.find(said), std::string::npos);
  const Outcome ran = calot({"run", "--no-render", "tight.lua"});
  EXPECT_NE(ran.out.find(furthest), std::string::npos) << ran.out;
}

TEST_F(Check, WithBuildFindsWhatRunWouldMeetAndRunSaysSo) {
  spill(folder_ / "far.lua",
        small_scenario("t:step('a', 'A') t:wait(0.1 * s)", "\nt.left:move_to({ 400 * mm, 0, -300 * mm })"));
  EXPECT_EQ(calot({"check", "far.lua"}).code, 0);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"check", "--build", "far.lua"},
        std::vector<std::string>{"run", "--no-render", "far.lua"}}) {
    const Outcome far = calot(arguments);
    EXPECT_EQ(far.code, 6);
    EXPECT_NE(far.err.find("far.lua:15: the tip cannot go to"), std::string::npos) << far.err;
    EXPECT_NE(far.err.find("calot check --build far.lua\n"), std::string::npos) << far.err;
  }
  std::string full = small_scenario();
  full.replace(full.find("nodes = 61"), 10, "nodes = 61,\nbile = { fill_volume = 900e-6 }");
  spill(folder_ / "full.lua", full);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"check", "--build", "full.lua"},
        std::vector<std::string>{"run", "--no-render", "full.lua"}}) {
    const Outcome outcome = calot(arguments);
    EXPECT_EQ(outcome.code, 6);
    EXPECT_NE(outcome.err.find("full.lua:9: scene.anatomy.organs[1].bile.fill_volume: organ 'ball' holds"),
              std::string::npos)
        << outcome.err;
  }
}

TEST_F(Check, TakesLittleMemoryForWhateverItIsGiven) {
  spill(folder_ / "strings.lua",
        "local big, list = string.rep('x', 1e7), {} for i = 1, 300 do list[i] = big end\n"
        "return require('calot').exercise { golden = { at = list } }");
  std::string nest = "return ";
  for (int i = 0; i < 40'000; ++i) nest += "{a=";
  spill(folder_ / "nest.lua", nest);
  spill(folder_ / "zeros.lua", "");
  fs::resize_file(folder_ / "zeros.lua", 100'000'000);
  std::string wide = "local b = string.rep('x', 1e7) print(b";
  for (int i = 0; i < 60; ++i) wide += ", b";
  spill(folder_ / "wide.lua", wide + ")");
  spill(folder_ / "keys.lua",
        "local t = {} for i = 1, 2e6 do t[i] = true end for k in pairs(t) do break end");
  for (const char* file : {"strings.lua", "nest.lua", "zeros.lua", "wide.lua", "keys.lua"}) {
    const Outcome outcome = calot({"check", file});
    EXPECT_TRUE(outcome.code == 6 || outcome.code == 7) << file << " " << outcome.code;
    EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err.substr(0, 1000);
    EXPECT_LT(outcome.err.size(), 10'000u) << file;
  }
  rusage most{};  // of any of them
  getrusage(RUSAGE_CHILDREN, &most);
#ifndef __SANITIZE_ADDRESS__
  EXPECT_LT(most.ru_maxrss, 600 * 1024) << "KiB resident";
#endif
}

}  // namespace
}  // namespace calot::test
