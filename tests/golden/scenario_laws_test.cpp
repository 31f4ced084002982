// Laws that hold all the way through the scenarios we ship.

#include <gtest/gtest.h>

#include "lua/load_exercise.h"
#include "session/runner.h"
#include "support/paths.h"

namespace calot {
namespace {

class Scenario : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Shipped, Scenario,
                         ::testing::Values("grasp_and_traction", "paper/figure_4", "paper/figure_2",
                                           "paper/section_6"));

TEST_P(Scenario, KeepsTheInstrumentsOutOfTheSkinAndTheBileIn) {
  LoadOptions options;
  options.modules = source_dir() + "/scripts/lua";
  auto script = load_exercise(source_dir() + "/scenarios/" + std::string(GetParam()) + ".lua", options);
  ASSERT_TRUE(script) << to_text(script.failure());
  World world = World::create(script.value()->definition().scene).value();
  std::vector<double> volumes;
  for (const auto& organ : world.report().organs) volumes.push_back(organ.volume);
  double deepest = 0, swelling = 0, strongest = 0;
  SessionOptions session;
  session.observer = [&](const World& now, const Progress&, bool) {
    deepest = std::max(deepest, now.deepest_penetration());
    for (std::size_t k = 0; k < volumes.size(); ++k)
      swelling = std::max(swelling, std::abs(now.report().organs[k].volume / volumes[k] - 1));
    for (const auto& tool : now.report().instruments)
      strongest = std::max(strongest, tool.tip_force.norm());
  };
  const SessionResult played = run_session(world, *script.value(), script.value()->demo(), session);
  EXPECT_EQ(played.end, SessionEnd::steps_done) << to_text(played.failure);
  EXPECT_GT(strongest, 1.0) << "a scenario without traction tests nothing";
  EXPECT_LT(deepest, 0.1e-3);
  EXPECT_LT(swelling, 1e-9);
  RecordProperty("deepest_um", static_cast<int>(1e6 * deepest));
}

}  // namespace
}  // namespace calot
