// calot list, and what a run shows that its author asked for: notes, and frames at chosen times.

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace calot::test {
namespace {

using Json = nlohmann::json;

class List : public ProgramTest {};

bool has(const Json& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&](const Json& entry) { return entry["name"] == name; });
}

TEST_F(List, NamesWhatEveryScenarioCanSay) {
  const Outcome outcome = calot({"list", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["schema"], "calot.list/1");
  EXPECT_TRUE(has(json["ports"], "right_subcostal"));
  EXPECT_TRUE(has(json["landmarks"], "infundibulum"));
  EXPECT_TRUE(has(json["events"], "empty_grasp"));
  EXPECT_TRUE(has(json["metrics"], "<instrument>.peak_force_N"));
  const Outcome text = calot({"list"});
  EXPECT_EQ(text.code, 0);
  for (const char* name : {"right_subcostal", "infundibulum", "empty_grasp", "<step>.<hold>.time_in_s"})
    EXPECT_NE(text.out.find(name), std::string::npos) << name;
}

TEST_F(List, NamesWhatOneScenarioHas) {
  spill(folder_ / "small.lua", small_scenario("t:step('move', 'Move'); t:note('reach', 3)"));
  const Outcome outcome = calot({"list", "small.lua", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["scenario"], "small");
  EXPECT_TRUE(has(json["landmarks"], "ball.free_side"));
  EXPECT_FALSE(has(json["landmarks"], "ball.start")) << "a tube's";
  EXPECT_TRUE(has(json["instruments"], "left"));
  EXPECT_TRUE(has(json["metrics"], "left.peak_force_N"));
  EXPECT_TRUE(has(json["metrics"], "note.reach"));
  EXPECT_TRUE(has(json["steps"], "move"));
  ASSERT_TRUE(has(json["parameters"], "height"));
  EXPECT_EQ(json["parameters"][0]["default"], "10");
}

TEST_F(List, OfAScenarioWithMistakesSaysThem) {
  spill(folder_ / "bad.lua", "return 5");
  const Outcome outcome = calot({"list", "bad.lua"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_NE(outcome.err.find("calot check bad.lua"), std::string::npos) << outcome.err;
}

TEST_F(List, ARunReportsItsNotesAndDrawsFramesAtTheTimesAskedFor) {
  spill(folder_ / "small.lua",
        small_scenario("t:step('move', 'Move'); t:wait(0.1 * s); t:note('reach', 3, 'mm')"));
  const Outcome outcome = calot({"run", "small.lua", "-o", "out", "--size", "64x48", "--at", "0.04,0.08"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(folder_ / "out/t000.04s.png"));
  EXPECT_TRUE(fs::exists(folder_ / "out/t000.08s.png"));
  const Json report = Json::parse(slurp(folder_ / "out/report.json"));
  ASSERT_EQ(report["noted"].size(), 1u);
  EXPECT_EQ(report["noted"][0]["value"], 3);
  EXPECT_EQ(report["noted"][0]["unit"], "mm");
  EXPECT_EQ(report["noted"][0]["step"], "move");
  EXPECT_EQ(report["metrics"]["note.reach"], 3);
  EXPECT_NE(outcome.out.find("reach"), std::string::npos);
}

}  // namespace
}  // namespace calot::test
