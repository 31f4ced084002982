// calot import: what a table may say, and motion from elsewhere that is scored in the end.

#include <fmt/format.h>

#include "app/program.h"
#include "session/json.h"

namespace calot::test {
namespace {

constexpr const char* clinic_registration = R"(local calot = require "calot"
local mm, deg = calot.units.mm, calot.units.deg
return {
  version = 2, exercise = "small", format = "csv", unit = 1 * mm, angle_unit = 1 * deg,
  columns = { time = "t", insertion = "depth" },
  instruments = {
    { name = "left", source = "grasper" },
  },
}
)";

class Import : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    spill(folder_ / "table.lua", clinic_registration);
    std::string rows = "t,pitch,yaw,depth\n";
    for (int k = 0; k <= 20; ++k)
      rows += fmt::format("{:.2f},{},0,{}\n", k / 30.0, 10 + k % 2, 30 + k / 10.0);
    spill(folder_ / "anna.csv", rows);
  }
  Outcome import(const std::string& registration, std::vector<std::string> more = {"anna.csv"}) {
    spill(folder_ / "table.lua", registration);
    more.insert(more.begin(), {"import", "small.lua", "--registration", "table.lua", "-o", "in"});
    return calot(more);
  }
  static std::string changed(std::string text, const std::string& from, const std::string& to) {
    EXPECT_NE(text.find(from), std::string::npos) << from;
    return text.replace(text.find(from), from.size(), to);
  }
};

TEST_F(Import, MotionFromElsewhereIsScoredAndABrokenFileCostsOnlyItself) {
  const std::string good = slurp(folder_ / "anna.csv");
  spill(folder_ / "ben.csv", changed(good, "0.20,10,", "0.20,ten,"));
  const Outcome both = import(clinic_registration, {"ben.csv", "anna.csv"});
  EXPECT_EQ(both.code, 4);
  EXPECT_NE(both.err.find("ben.csv:8: pitch is \"ten\", no number"), std::string::npos) << both.err;
  expect_next_command(both);
  const Outcome scored = calot({"score", "small.lua", "in", "--json"});
  EXPECT_EQ(scored.code, 0) << scored.err;
  const Json json = Json::parse(scored.out);
  ASSERT_EQ(json["recordings"].size(), 1u);
  const Json& anna = json["recordings"][0];
  EXPECT_EQ(anna["file"], "in/anna.jsonl");
  EXPECT_EQ(anna["why"], "the recording does not hold what was measured");
  EXPECT_GT(anna["metrics"]["left.path_length_mm"].get<double>(), 1);

  const Outcome again = import(clinic_registration);
  EXPECT_EQ(again.code, 4) << "nothing is written over";
  EXPECT_NE(again.err.find("in/anna.jsonl is there already"), std::string::npos) << again.err;
}

TEST_F(Import, MistakesInTheTableAreNamedAtTheirLines) {
  const auto complains = [&](const std::string& from, const std::string& to, const std::string& begin) {
    const Outcome outcome = import(changed(clinic_registration, from, to));
    EXPECT_EQ(outcome.code, 6) << outcome.err;
    EXPECT_NE(outcome.err.find(begin), std::string::npos) << begin << " is missing in\n" << outcome.err;
    expect_next_command(outcome);
  };
  complains("\"csv\"", "\"cvs\"", "table.lua:4: format: ");
  complains("\"csv\"", "\"jigsaws\"", "table.lua:4: format: \"time_step\" is missing");
  complains("\"csv\"", "\"jigsaws\", time_step = 0.1", "table.lua:7: instruments[1].source: ");
  complains("unit = 1 * mm", "unit = 0", "table.lua:4: unit: ");
  complains("depth\" }", "depth\", jaws = 'j' }", "table.lua:5: columns.jaws: unknown key \"jaws\"");
  complains("\"grasper\"", "\"grasper\", jaw_open = 1",
            "table.lua:7: instruments[1]: one of jaw_closed and jaw_open");
  complains("\"grasper\"", "\"grasper\", along = { 0, 0, 0 }",
            "table.lua:7: instruments[1].along: this has no direction");
  complains("\"left\"", "\"right\"", "table.lua:7: instruments[1]: the exercise has no instrument \"right\"");
  complains("1 * deg,", "1 * deg, x_axis = { 0, 1, 0 },",
            "table.lua:4: x_axis: these axes are not of length 1");
  complains("1 * deg,", "1 * deg, x_axis = { -1, 0, 0 },", "table.lua:4: x_axis: these axes are left-handed");
  complains("exercise = \"small\",", "", "\"exercise\" is missing");
}

TEST_F(Import, WithoutWhatItNeedsItSaysSo) {
  EXPECT_EQ(calot({"import"}).code, 4);
  EXPECT_EQ(calot({"import", "small.lua", "anna.csv", "-o", "in"}).code, 4) << "no registration";
  EXPECT_EQ(calot({"import", "small.lua", "anna.csv", "-o", "in", "--registration", "nowhere.lua"}).code, 4);
  EXPECT_EQ(import(clinic_registration, {"nowhere.csv"}).code, 4);
}

}  // namespace
}  // namespace calot::test
