// Whose scenarios and goldens a command is about where the present folder is no project.

#include "app/program.h"
#include "support/paths.h"

namespace calot::test {
namespace {

constexpr const char* borrowed = "No project here";

class NoProject : public ProgramTest {
 protected:
  /// Who makes scenarios/ believes that this is a project.
  void make_half() const { spill(folder_ / "scenarios" / "small.lua", small_scenario()); }
  static std::size_t notes_of(const Outcome& outcome) {
    std::size_t count = 0;
    for (std::size_t at = outcome.err.find(borrowed); at != std::string::npos;
         at = outcome.err.find(borrowed, at + 1))
      ++count;
    return count;
  }
};

// No scenario of the source is called small: were these accepted, nothing of its goldens would be lost.
TEST_F(NoProject, GoldensAreNeverAcceptedIntoAnotherProject) {
  for (const bool half : {false, true}) {
    if (half) make_half();
    const Outcome outcome = calot({"golden", "accept", "small"});
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("would go into " + source_dir() + "/golden"), std::string::npos)
        << outcome.err;
    expect_next_command(outcome);
  }
  fs::create_directories(folder_ / "scripts" / "lua");
  EXPECT_EQ(calot({"golden", "accept", "small", "--dry-run"}).code, 0);
}

TEST_F(NoProject, GoldenCommandsAndDoctorSayOnceWhoseProjectTheyUse) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"golden", "test", "paper/figure_4", "--dry-run"}, {"golden", "report", "none"}, {"doctor"}}) {
    const Outcome outcome = calot(arguments);
    EXPECT_EQ(notes_of(outcome), 1u) << arguments.front() << ": " << outcome.err;
    EXPECT_NE(outcome.err.find(source_dir()), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out.find(borrowed), std::string::npos);
  }
}

TEST_F(NoProject, OfASingleScenarioItIsSaidOnlyBesideAFolderOfScenarios) {
  EXPECT_EQ(calot({"check", "small.lua"}).err, "");
  EXPECT_EQ(calot({"run", "small.lua", "--dry-run"}).err, "");
  make_half();
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"check", "scenarios"},
                                             {"list", "scenarios/small.lua"},
                                             {"run", "scenarios/small.lua", "--dry-run"}}) {
    const Outcome outcome = calot(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(notes_of(outcome), 1u) << arguments.front() << ": " << outcome.err;
  }
}

TEST_F(NoProject, AProjectAboveIsUsedSilently) {
  make_half();
  fs::create_directories(folder_ / "scripts" / "lua");
  spill(folder_ / "scenarios" / "scenarios" / "deep.lua", small_scenario());
  EXPECT_EQ(shell(folder_ / "scenarios", "$calot check scenarios/deep.lua >found"), 0);
  EXPECT_EQ(slurp(folder_ / "scenarios" / ".stderr"), "");
}

}  // namespace
}  // namespace calot::test
