// --dry-run: a command's arguments and the files that they name are checked, and nothing else happens.

#include <set>

#include "app/program.h"

namespace calot::test {
namespace {

class DryRun : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    spill(folder_ / "scenarios" / "small.lua", small_scenario());
    fs::create_directories(folder_ / "scripts" / "lua");
    spill(folder_ / "registration.lua", R"(return {
  version = 1, exercise = "small", format = "csv",
  instruments = { { name = "left", source = "left", port = { -0.08, 0.07, 0 } } },
}
)");
    spill(folder_ / "motion.csv", "time,tip_x,tip_y,tip_z\n0,-0.078,0.09,-0.03\n0.1,-0.078,0.091,-0.032\n");
    spill(folder_ / "benchmarks.lua", R"(return { name = "Ours", version = 1, exercise = "small" })");
  }

  static std::vector<std::string> dry(std::vector<std::string> arguments) {
    arguments.emplace_back("--dry-run");
    return arguments;
  }

  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_))
      names.insert(entry.path().string());
    return names;
  }
};

TEST_F(DryRun, RightCommandsSayAndWriteNothing) {
  ASSERT_EQ(calot({"run", "small.lua", "--no-render", "-o", "played"}).code, 0);
  const std::set<std::string> before = files();
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"run", "small.lua", "--param", "height=4", "-o", "elsewhere"},
           {"operate", "small.lua", "--exam"},
           {"operate", "--devices"},
           {"operate", "small.lua", "--no-window", "--input", "unix:socket"},
           {"replay", "played/recording.jsonl"},
           {"score", "small.lua", "played", "--benchmarks", "benchmarks.lua", "-o", "scores"},
           {"page", "played"},
           {"import", "small.lua", "motion.csv", "--registration", "registration.lua", "-o", "imported"},
           {"check", "scenarios", "--build"},
           {"list", "small.lua"},
           {"new", "mine"},
           {"golden", "test"},
           {"golden", "report", "small/t000.40s"},
           {"golden", "accept", "small"},
           {"bench"},
           {"doctor"}}) {
    const Outcome outcome = calot(dry(arguments));
    SCOPED_TRACE(arguments.front());
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(files(), before);
  }
}

TEST_F(DryRun, WrongCommandsFailAsTheyDoInEarnest) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"run", "none.lua"},
           {"run", "small.lua", "--param", "hieght=3"},
           {"run", "small.lua", "--exma"},
           {"operate", "small.lua", "--no-window", "--input", "none"},
           {"operate", "small.lua", "--no-window", "--input", "motion.csv"},
           {"replay", "none.jsonl"},
           {"score", "small.lua", "scenarios"},
           {"score", "small.lua", "none.jsonl", "--benchmarks", "none.lua"},
           {"page", "none.jsonl"},
           {"import", "small.lua", "none.csv", "--registration", "registration.lua", "-o", "imported"},
           {"import", "small.lua", "motion.csv", "--registration", "none.lua", "-o", "imported"},
           {"check", "none.lua"},
           {"list", "none.lua"},
           {"new", "7up"},
           {"golden", "test", "none"},
           {"golden", "accept", "none"}}) {
    SCOPED_TRACE(arguments.front() + " " + arguments.back());
    const Outcome real = calot(arguments), tried = calot(dry(arguments));
    EXPECT_NE(tried.code, 0);
    EXPECT_EQ(tried.code, real.code);
    EXPECT_EQ(tried.err, real.err);
  }
}

TEST_F(DryRun, AFrameThatNobodyKnowsAndARecordingThatIsNoneAreFound) {
  EXPECT_EQ(calot({"golden", "test", "small/t000.50s", "--dry-run"}).code, 4);
  EXPECT_EQ(calot({"score", "small.lua", "none.jsonl", "--dry-run"}).code, 4);
  EXPECT_EQ(calot({"operate", "small.lua", "--device", "none", "--dry-run"}).code, 4);
  const std::vector<std::string> igtl{"operate",        "small.lua", "--igtl",   "18944",
                                      "--registration", "none.lua",  "--dry-run"};
  EXPECT_EQ(calot(igtl).code, 4);
}

TEST_F(DryRun, HelpDoesNotShowIt) {
  EXPECT_EQ(calot({"run", "--help"}).out.find("--dry-run"), std::string::npos);
}

}  // namespace
}  // namespace calot::test
