// Which part of an instrument feels what, where, and what its jaws are doing.

#include <gtest/gtest.h>

#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

TEST(PartLoads, OfJawsAndShaftMakeTheWholeAndGripsTellWhatTheyDo) {
  CALOT_SLOW_WHEN_SANITIZED("a whole gallbladder");
  test::FundusPath path(test::ball_scene());
  path.driver.watch = [](const StepReport& report) {
    const InstrumentState& tool = report.instruments[0];
    const PartLoad &jaws = tool.load_on(ToolPart::jaws), &shaft = tool.load_on(ToolPart::shaft);
    // Summed in another order: rounding of some hundred forces of a newton.
    EXPECT_LT((jaws.force + shaft.force - tool.force).norm(), 1e-12);
    EXPECT_EQ(tool.touching, jaws.touches + shaft.touches > 0);
    EXPECT_LE(tool.load_on(ToolPart::tip).touches, jaws.touches);
    EXPECT_EQ(tool.grip == GripState::holding, !tool.holds.empty());
  };
  const auto grip = [&] { return path.world.report().instruments[0].grip; };
  EXPECT_EQ(grip(), GripState::empty) << "it waits closed in its trocar";
  ASSERT_TRUE(path.driver.go(path.fundus + 15e-3 * path.out, test::open_jaw, 3));
  EXPECT_EQ(grip(), GripState::open);
  ASSERT_TRUE(path.driver.go(path.fundus + 15e-3 * path.out, 0, 3));
  EXPECT_EQ(grip(), GripState::empty);
  EXPECT_EQ(path.driver.count(EventKind::empty_grasp), 1) << "closed in the air";
  ASSERT_TRUE(path.grasp() && path.lift()) << path.driver.why();
  EXPECT_EQ(grip(), GripState::holding);
  const InstrumentState& lifted = path.world.report().instruments[0];
  const PartLoad& jaws = lifted.load_on(ToolPart::jaws);
  EXPECT_EQ(jaws.organ, "ball");
  EXPECT_GT(jaws.force.dot(-path.out), 0.1) << "what is lifted draws the tool into the body";
  EXPECT_LT((jaws.at - lifted.tip).norm(), 20e-3) << "within the jaws' length of their tip";
  ASSERT_TRUE(path.release()) << path.driver.why();
  EXPECT_EQ(grip(), GripState::open);
  EXPECT_EQ(path.driver.count(EventKind::empty_grasp), 1);
}

TEST(PartLoads, AGripThatIsPulledOffHasSlippedUntilTheJawsOpen) {
  CALOT_SLOW_WHEN_SANITIZED("a fold pulled through the jaws");
  SceneDefinition scene = test::ball_scene();
  scene.instruments[0].pinch_force = 0.05;
  test::FundusPath path(scene);
  ASSERT_TRUE(path.grasp(2)) << path.driver.why();
  ASSERT_TRUE(path.driver.go(path.fundus + 30e-3 * path.out, 0, 10)) << path.driver.why();
  EXPECT_EQ(path.world.report().instruments[0].grip, GripState::slipped);
  ASSERT_TRUE(path.driver.go(path.fundus + 30e-3 * path.out, test::open_jaw, 3)) << path.driver.why();
  EXPECT_EQ(path.world.report().instruments[0].grip, GripState::open);
}

TEST(PartLoads, AnElectrodeThatPressesFeelsItAtItsTip) {
  test::FundusPath path(test::scene_with(InstrumentType::bipolar_electrode));
  ASSERT_TRUE(path.driver.go(path.fundus + 5e-3 * path.out, 0, 3)) << path.driver.why();
  ASSERT_TRUE(path.driver.go(path.fundus - 4e-3 * path.out, 0, 4)) << path.driver.why();
  const InstrumentState& tool = path.world.report().instruments[0];
  EXPECT_GT(tool.load_on(ToolPart::tip).force.dot(path.out), 0.05) << "it is pushed back";
  EXPECT_EQ(tool.load_on(ToolPart::shaft).touches, 0);
  // The hardest point is on the round end: within its radius and the wall's way of the tip.
  EXPECT_LT((tool.load_on(ToolPart::tip).at - tool.tip).norm(), 3e-3);
}

TEST(PartLoads, AShaftThatLeansOnTheBellyIsNotTheTip) {
  CALOT_SLOW_WHEN_SANITIZED("a whole gallbladder");
  SceneDefinition scene = test::grasper_scene();
  scene.instruments[0].force_limit = 0.05;
  test::FundusPath path(scene);
  // Beside the organ and past its fundus, then across until the shaft lies against it.
  const auto beside = [&](double across) {
    return Vec3(path.fundus - 70e-3 * path.out + Vec3(-across, 0, 0));
  };
  ASSERT_TRUE(path.driver.go(path.fundus + Vec3(-60e-3, 0, 0), 0, 4)) << path.driver.why();
  ASSERT_TRUE(path.driver.go(beside(60e-3), 0, 4)) << path.driver.why();
  double across = 60e-3;
  const auto leans = [&] {
    return path.world.report().instruments[0].load_on(ToolPart::shaft).force.norm() > 0.05;
  };
  while (across > 0 && !leans())
    ASSERT_TRUE(path.driver.go(beside(across -= 2e-3), 0, 1)) << path.driver.why();
  const InstrumentState& tool = path.world.report().instruments[0];
  ASSERT_TRUE(leans());
  EXPECT_EQ(tool.load_on(ToolPart::tip).touches, 0);
  EXPECT_EQ(tool.load_on(ToolPart::jaws).touches, 0);
  EXPECT_EQ(tool.load_on(ToolPart::tip).force.norm(), 0);
  EXPECT_TRUE(tool.touching);
  EXPECT_GT(tool.force.norm(), scene.instruments[0].force_limit);
  EXPECT_EQ(path.driver.count(EventKind::overforce), 0) << "its limit is that of the jaws";
}

}  // namespace
}  // namespace calot
