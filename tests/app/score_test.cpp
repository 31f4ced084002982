// The score can fail: what a trainee does differently shows in the parts of the main scenario's score.

#include <set>

#include "app/program.h"
#include "session/json.h"
#include "support/long_run.h"
#include "support/paths.h"

namespace calot::test {
namespace {

class MainScenario : public ProgramTest {
 protected:
  /// The score of the main scenario when the instrument does this instead of the demo.
  Json score(const std::string& demo) {
    std::string text = slurp(source_dir() + "/scenarios/grasp_and_traction.lua");
    if (!demo.empty()) {
      const std::size_t begin = text.find("demo = function(t)"), end = text.find("\n  end,", begin);
      EXPECT_NE(end, std::string::npos);
      text.replace(begin, end - begin, "demo = function(t)\n" + demo);
    }
    spill(folder_ / "path.lua", text);
    const Outcome outcome = calot({"run", "path.lua", "--no-render", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::parse(outcome.out)["score"];
  }

  static Json part(const Json& score, const std::string& name) {
    for (const Json& part : score["parts"]) {
      if (part["name"] == name) return part;
    }
    ADD_FAILURE() << "no part " << name;
    return {};
  }
};

class Exposure : public MainScenario {};

TEST_F(Exposure, TheClassicMistakeLinesTheDuctsUpAndFails) {
  if (!long_run()) GTEST_SKIP() << "plays a whole pull in the field: half a minute";
  const std::string scenario = source_dir() + "/scenarios/exposure.lua";
  const Outcome outcome = calot({"run", scenario, "--param", "traction=cephalad", "--no-render", "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json score = Json::parse(outcome.out)["score"];
  EXPECT_TRUE(score["completed"].get<bool>());
  EXPECT_FALSE(score["passed"].get<bool>());
  const Json seen = part(score, "note.triangle_seen_mm2");
  EXPECT_EQ(seen["points"], 0) << seen.dump();
  EXPECT_NE(seen["explanation"].get<std::string>().find("no better than novice"), std::string::npos);
}

TEST_F(Exposure, EveryAnatomyIsExposedByTheSameHand) {
  if (!long_run()) GTEST_SKIP() << "plays the first act six times";
  for (const std::string field : {"short_cystic_duct", "low_union", "double_cystic_artery",
                                  "hepatic_artery_near_neck", "hydrops", "phrygian_cap"}) {
    const Outcome outcome = calot({"run", source_dir() + "/scenarios/exposure.lua", "--param",
                                   "field=" + field, "--no-render", "--json"});
    EXPECT_EQ(outcome.code, 0) << field << outcome.err;
    EXPECT_TRUE(Json::parse(outcome.out)["score"]["passed"].get<bool>()) << field;
  }
}

TEST_F(Exposure, AHydropsIsDrawnSlackBeforeItIsHeld) {
  if (!long_run()) GTEST_SKIP() << "plays the first act on a hydrops: half a minute";
  const Outcome outcome = calot(
      {"run", source_dir() + "/scenarios/exposure.lua", "--param", "field=hydrops", "--no-render", "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json report = Json::parse(outcome.out);
  EXPECT_TRUE(report["score"]["passed"].get<bool>()) << report["score"].dump(2);
  double aspirated = -1, drawn_mL = 0, held = -1, last = 0;
  for (const Json& event : report["events"]) {
    last = event["time_s"];
    if (event["event"] == "aspirated") {
      aspirated = last;
      drawn_mL = event["volume_mL"];
      EXPECT_EQ(event["instrument"], "needle");
      EXPECT_EQ(event["organ"], "gallbladder");
    }
    if (event["event"] == "grasp" && held < 0) held = last;
  }
  ASSERT_GT(aspirated, 0);
  EXPECT_LT(aspirated, held);
  EXPECT_LE(last, 30) << "s simulated";
  EXPECT_GT(drawn_mL, 1);
  EXPECT_DOUBLE_EQ(report["metrics"]["gallbladder.aspirated_mL"].get<double>(), drawn_mL);
  EXPECT_DOUBLE_EQ(report["metrics"]["total.aspirated_mL"].get<double>(), drawn_mL);
}

TEST_F(MainScenario, TellsThoseApartWhoNeverGraspPullTooHardOrLetGoEarly) {
  const std::string grasp = "t.left:approach('gallbladder.fundus')\n t.left:close()\n";
  const Json idle = score("t.left:wait(1 * s)");
  const Json hard =
      score(grasp + "t.left:move_by({ 0, 8 * mm, 30 * mm })\n t.left:wait(5 * s)\n t.left:open()");
  const Json early = score(
      grasp +
      "t.left:move_by({ 0, 4 * mm, 11 * mm }, { speed = 10 * mm / s })\n t.left:wait(5 * s)\n t.left:open()");

  EXPECT_FALSE(idle["passed"].get<bool>());
  EXPECT_FALSE(idle["completed"].get<bool>());
  EXPECT_EQ(part(idle, "hold.band.time_in_s")["measured"], 0);
  EXPECT_EQ(part(idle, "hold.band.time_in_s")["points"], 0);

  EXPECT_FALSE(hard["passed"].get<bool>());
  EXPECT_GT(part(hard, "overforce")["event_times_s"].size() + hard["critical"].size(), 0u) << hard.dump(2);

  EXPECT_FALSE(early["passed"].get<bool>());
  const double held = part(early, "hold.band.time_in_s")["measured"];
  EXPECT_GT(held, 3);
  EXPECT_LT(held, 7);
  EXPECT_EQ(part(early, "overforce")["measured"], 0);

  const std::set<double> totals{idle["total"], hard["total"], early["total"]};
  EXPECT_EQ(totals.size(), 3u) << idle["total"] << " " << hard["total"] << " " << early["total"];
  for (const Json& each : {idle, hard, early}) {
    EXPECT_LT(each["total"], 95) << "what the expert has, whom the shipped scenario's own test plays";
    double sum = 0;
    for (const Json& entry : each["parts"]) {
      EXPECT_FALSE(entry["explanation"].get<std::string>().empty());
      sum += entry["points"].get<double>();
    }
    EXPECT_NEAR(each["uncapped_total"].get<double>(), sum, 1e-9);
  }
}

}  // namespace
}  // namespace calot::test
