// What the other instruments do to a gallbladder: the electrode pushes and never grips, Semm's forceps grip.

#include <gtest/gtest.h>

#include "field/field_state.h"
#include "milestone.h"
#include "rig.h"
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
  EXPECT_GT(pressed.instruments[0].force.dot(path.out), 0.1) << "it is pushed back";
  EXPECT_GT(pressed.organs[0].pressure, pressure);
  EXPECT_LT(path.world.deepest_penetration(), 0.1e-3);
  // The wall has gone along: it covers the tip, within the contact's range and half a grid of the skin.
  double nearest = 1;
  for (const Vec3& p : path.world.skin_positions(OrganIndex(0)))
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
  test::expect_refused_without_a_trace(path, [&] {
    for (double jaw : {0.1, -1e-10}) {
      StepInput input;
      input.instruments = {path.world.report().instruments[0].pose};
      input.instruments[0].insertion += 1e-3;
      input.instruments[0].jaw = jaw;
      const Result<StepReport> step = path.world.step(input);
      ASSERT_FALSE(step) << jaw;
      EXPECT_NE(to_text(step.failure()).find("no jaws"), std::string::npos) << to_text(step.failure());
    }
  });
}

TEST(Electrode, AnActivationIsAnEventWhereItBeginsAndNamesWhatIsTouched) {
  CALOT_SLOW_WHEN_SANITIZED("a world pressed on");
  SceneDefinition scene = test::ball_scene();
  scene.instruments[0] = test::scene_with(InstrumentType::bipolar_electrode).instruments[0];
  test::FundusPath path(scene);
  const auto act = [&](InstrumentAction action) {
    const StepInput input{{path.world.report().instruments[0].pose}, {action}};
    const Result<StepReport> step = path.world.step(input);
    EXPECT_TRUE(step);
    EXPECT_EQ(step->instruments[0].action, action);
    return step->events;
  };
  const std::vector<WorldEvent> in_the_air = act(InstrumentAction::activate);
  ASSERT_EQ(in_the_air.size(), 1u);
  EXPECT_EQ(in_the_air[0].kind, EventKind::activation);
  EXPECT_EQ(in_the_air[0].organ, "");
  EXPECT_TRUE(act(InstrumentAction::activate).empty()) << "it goes on";
  const std::uint64_t active = path.world.state_hash();
  const FieldState state = path.world.state();
  EXPECT_TRUE(act(InstrumentAction::none).empty());
  ASSERT_TRUE(path.world.restore(state));
  EXPECT_EQ(path.world.state_hash(), active);
  EXPECT_TRUE(act(InstrumentAction::activate).empty()) << "it went on before";
  ASSERT_TRUE(path.driver.go(path.fundus + 5e-3 * path.out, 0, 1)) << path.driver.why();
  ASSERT_TRUE(path.driver.go(path.fundus - 1e-3 * path.out, 0, 2)) << path.driver.why();
  ASSERT_TRUE(path.world.report().instruments[0].touching);
  const std::vector<WorldEvent> pressed = act(InstrumentAction::activate);
  ASSERT_EQ(pressed.size(), 1u) << "the driver asks for no action: it began anew";
  EXPECT_EQ(pressed[0].organ, "ball");
}

TEST(Instruments, AnActionThatOneDoesNotKnowIsRefusedAndChangesNothing) {
  World world = World::create(test::ball_scene()).value();
  const std::uint64_t hash = world.state_hash();
  StepInput input{{world.report().instruments[0].pose}, {InstrumentAction::activate}};
  const Result<StepReport> refused = world.step(input);
  ASSERT_FALSE(refused);
  EXPECT_NE(to_text(refused.failure()).find("cannot activate: its type is atraumatic_grasper"),
            std::string::npos)
      << to_text(refused.failure());
  input.actions = {InstrumentAction::none, InstrumentAction::none};
  EXPECT_EQ(world.step(input).failure().kind, FailureKind::internal);
  EXPECT_EQ(world.state_hash(), hash);
  for (const std::string& name : instrument_action_names())
    EXPECT_EQ(to_text(*instrument_action_called(name)), name);
  EXPECT_FALSE(instrument_action_called("explode"));
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
  EXPECT_LT(path.world.report().instruments[0].force.dot(path.out), -0.2) << "it pulls";
  ASSERT_TRUE(path.release() && path.withdraw()) << path.driver.why();
  EXPECT_EQ(path.world.report().instruments[0].holds, "");
  EXPECT_EQ(path.driver.count(EventKind::release), 1);
  EXPECT_LT(deepest, 0.1e-3);
}

}  // namespace
}  // namespace calot
