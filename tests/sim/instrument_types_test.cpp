// What the other instruments do to a gallbladder: the electrode pushes and never grips, Semm's forceps grip.

#include <gtest/gtest.h>

#include "rig.h"
#include "sim/field_state.h"
#include "support/long_run.h"

namespace calot {
namespace {

TEST(Electrode, PushesTheWallWithoutGoingInAndLetsItSpringBack) {
  CALOT_SLOW_WHEN_SANITIZED("a whole push");
  test::FundusPath path(test::scene_with(InstrumentType::bipolar_electrode));
  const double pressure = path.world.report().organs[0].pressure;
  ASSERT_TRUE(path.driver.go(path.fundus + 5e-3 * path.out, 0, 3)) << path.driver.why();
  ASSERT_TRUE(path.driver.go(path.fundus - 6e-3 * path.out, 0, 6)) << path.driver.why();
  const StepReport& pressed = path.world.report();
  EXPECT_GT(pressed.instruments[0].tip_force.dot(path.out), 0.1) << "it is pushed back";
  EXPECT_GT(pressed.organs[0].pressure, pressure);
  EXPECT_LT(path.world.deepest_penetration(), 0.1e-3);
  // The wall has gone along: it covers the tip, within the contact's range and half a grid of the skin.
  double nearest = 1;
  for (const Vec3& p : path.world.skin_positions(0))
    nearest = std::min(nearest, (p - pressed.instruments[0].tip).norm());
  EXPECT_LT(nearest, 1e-3);
  EXPECT_EQ(pressed.instruments[0].grip_points, 0);
  ASSERT_TRUE(path.driver.go(path.fundus + 5e-3 * path.out, 0, 6)) << path.driver.why();
  EXPECT_FALSE(path.world.report().instruments[0].touching);
  // A state is known to the solver's tolerance of the organ's size.
  EXPECT_LT((path.world.landmark("gallbladder.fundus") - path.fundus).norm(), 1e-5);
  EXPECT_EQ(path.driver.count(EventKind::contact), 1);
  EXPECT_EQ(path.driver.count(EventKind::grasp), 0);
}

TEST(Electrode, RefusesAJawAngleAndChangesNothing) {
  CALOT_SLOW_WHEN_SANITIZED("a world pressed on");
  test::FundusPath path(test::scene_with(InstrumentType::bipolar_electrode));  // where the skin is touched
  ASSERT_TRUE(path.driver.go(path.fundus + 5e-3 * path.out, 0, 1)) << path.driver.why();
  ASSERT_TRUE(path.driver.go(path.fundus - 1e-3 * path.out, 0, 1)) << path.driver.why();
  ASSERT_TRUE(path.world.report().instruments[0].touching);
  const FieldState before = path.world.state();
  const test::Driver driver = path.driver;
  const std::uint64_t hash = path.world.state_hash();
  const auto goes_on = [&] {
    EXPECT_TRUE(path.driver.go(path.fundus - 2e-3 * path.out, 0, 1)) << path.driver.why();
    return path.world.state_hash();
  };
  const std::uint64_t spared = goes_on();  // had it not been asked for one
  ASSERT_TRUE(path.world.restore(before));
  path.driver.follow(driver);
  for (double jaw : {0.1, -1e-10}) {
    StepInput input;
    input.instruments = {path.world.report().instruments[0].pose};
    input.instruments[0].insertion += 1e-3;
    input.instruments[0].jaw = jaw;
    const Result<StepReport> step = path.world.step(input);
    ASSERT_FALSE(step) << jaw;
    EXPECT_NE(to_text(step.failure()).find("no jaws"), std::string::npos) << to_text(step.failure());
    EXPECT_EQ(path.world.state_hash(), hash);
  }
  EXPECT_EQ(goes_on(), spared);
}

TEST(SemmGrasp, GripsLiftsAndLetsGo) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  test::FundusPath path(test::scene_with(InstrumentType::semm_forceps));
  double deepest = 0;
  path.driver.watch = [&](const StepReport&) {
    deepest = std::max(deepest, path.world.deepest_penetration());
  };
  ASSERT_TRUE(path.grasp()) << path.driver.why();
  EXPECT_EQ(path.world.report().instruments[0].holds, "gallbladder");
  ASSERT_TRUE(path.lift()) << path.driver.why();
  EXPECT_EQ(path.world.report().instruments[0].holds, "gallbladder");
  EXPECT_LT(path.world.report().instruments[0].tip_force.dot(path.out), -0.2) << "it pulls";
  ASSERT_TRUE(path.release() && path.withdraw()) << path.driver.why();
  EXPECT_EQ(path.world.report().instruments[0].holds, "");
  EXPECT_EQ(path.driver.count(EventKind::release), 1);
  EXPECT_LT(deepest, 0.1e-3);
}

}  // namespace
}  // namespace calot
