// A step that has spent its budget.

#include "motion/step_budget.h"

#include <gtest/gtest.h>

#include "acts/advance.h"
#include "acts/hard_hold.h"
#include "field/grip.h"
#include "motion/settle_field.h"
#include "motion/tool_loads.h"
#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

/// A grasper before the fundus of an organ with masses.
SceneDefinition moving_scene() {
  SceneDefinition scene = test::grasper_scene(80);
  scene.solver.motion = SolverMotion::dynamics;
  return scene;
}

/// A field of its own that goes on from where a world is, with so much for a step.
struct Budgeted {
  Field field;
  SolveStatistics last = {};
  int cut_short = 0;

  Budgeted(const World& world, const StepBudget& budget) : field(world.field()) { field.budget = budget; }
  void step(const InstrumentPose& to) {
    last = {};
    ASSERT_TRUE(advance(field, {to}, last));
    EXPECT_LE(last.newton_iterations, field.budget.begin + field.budget.balance + 1);
    cut_short += last.cut_short ? 1 : 0;
  }
};

TEST(StepBudget, WhatAStepLeavesUndoneTheNextOnesMakeGood) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  test::FundusPath path(moving_scene());
  ASSERT_TRUE(path.driver.go(path.fundus + 2e-3 * path.out, 0, 4)) << path.driver.why();
  Budgeted whole(path.world, {500, 0}), thrifty(path.world, {4, 0});
  const InstrumentPose start = path.world.report().instruments[0].pose;
  InstrumentPose in = start;
  in.insertion += 6e-3;
  constexpr int pushed = 4, rested = 40;
  for (int k = 1; k <= pushed + rested; ++k) {
    const InstrumentPose to = interpolate(start, in, std::min(1.0, static_cast<double>(k) / pushed));
    whole.step(to);
    thrifty.step(to);
  }
  EXPECT_EQ(whole.cut_short, 0);
  EXPECT_GT(thrifty.cut_short, 0);
  EXPECT_FALSE(thrifty.last.cut_short) << "it is in balance again";
  EXPECT_EQ(thrifty.field.tools[0].pose, in);
  // Both swing on a little, each in its own time.
  constexpr double near = 0.3e-3;  // m: what a trainee cannot tell apart
  EXPECT_LT((thrifty.field.organs[0].state.x - whole.field.organs[0].state.x).lpNorm<Eigen::Infinity>(),
            near);
  EXPECT_GT((whole.field.organs[0].state.x - path.world.field().organs[0].state.x).lpNorm<Eigen::Infinity>(),
            10 * near);
}

TEST(StepBudget, WhatLeavesAToolNoRoomEndsTheStepAndNotTheSession) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  test::FundusPath path(moving_scene());
  ASSERT_TRUE(path.driver.go(path.fundus + 2e-3 * path.out, 0, 4)) << path.driver.why();
  Budgeted thrifty(path.world, {1, 0});
  InstrumentPose in = path.world.report().instruments[0].pose;
  in.insertion += 15e-3;
  for (int k = 0; k < 60; ++k) thrifty.step(in);
  EXPECT_GT(thrifty.cut_short, 10);
  EXPECT_EQ(thrifty.field.tools[0].pose, in) << "it came there in the end";
}

TEST(StepBudget, AStepThatWasSolvedRoughlyOnTheWayEndsInBalance) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  test::FundusPath path(moving_scene());
  ASSERT_TRUE(path.driver.go(path.fundus - 3e-3 * path.out, test::open_jaw, 8)) << path.driver.why();
  Budgeted closing(path.world, {500, 0});
  InstrumentPose to = path.world.report().instruments[0].pose;
  int several = 0;
  while (to.jaw > 0) {
    to.jaw = std::max(0.0, to.jaw - 0.2);
    const VecX before = closing.field.organs[0].state.x;
    closing.step(to);
    const MotionPart& part = closing.field.organs[0].state.motion;
    EXPECT_EQ(part.duration, closing.field.step_time);
    EXPECT_EQ(part.begin.x, before) << "all its stops are in one step from where the last one ended";
    several += closing.last.solves > 3 ? 1 : 0;
    EXPECT_FALSE(closing.field.rough);
    SolveStatistics again;
    ASSERT_TRUE(settle_field(closing.field, "once more", again));
    EXPECT_EQ(again.newton_iterations, 0);
  }
  EXPECT_GT(several, 2) << "without stops on the way this says little";
  EXPECT_GT(grip_count(closing.field.organs[0], ToolIndex{0}), 5);
}

TEST(StepBudget, AStepWhoseToolsComeInPartsIsOneStepOfTheBodiesAndInBalanceAtItsEnd) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  test::FundusPath path(moving_scene());
  ASSERT_TRUE(path.driver.go(path.fundus + 2e-3 * path.out, 0, 4)) << path.driver.why();
  Budgeted pushing(path.world, {500, 0});
  InstrumentPose to = path.world.report().instruments[0].pose;
  int in_parts = 0;
  for (int k = 0; k < 5; ++k) {
    to.insertion += 2e-3;
    const VecX before = pushing.field.organs[0].state.x;
    pushing.step(to);
    in_parts += pushing.last.substeps > 1 ? 1 : 0;
    const MotionPart& part = pushing.field.organs[0].state.motion;
    EXPECT_EQ(part.duration, pushing.field.step_time);
    EXPECT_EQ(part.begin.x, before) << "it is one step from where the last one ended";
    SolveStatistics again;
    ASSERT_TRUE(settle_field(pushing.field, "once more", again));
    EXPECT_EQ(again.newton_iterations, 0);
    EXPECT_EQ(pushing.field.tools[0].pose, to);
  }
  EXPECT_GT(in_parts, 1) << "without parts this says little";
}

TEST(StepBudget, GraspingLiftingAndLettingGoKeepIt) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  test::FundusPath path(moving_scene());
  ASSERT_TRUE(path.driver.go(path.fundus - 3e-3 * path.out, test::open_jaw, 8)) << path.driver.why();
  Budgeted hands(path.world, StepBudget{});
  InstrumentPose to = path.world.report().instruments[0].pose;
  const double open = to.jaw;
  const auto in_steps = [&](int count, double jaw, double way) {
    const InstrumentPose from = to;
    to.jaw = jaw;
    to.insertion -= way;
    for (int k = 1; k <= count; ++k) hands.step(interpolate(from, to, static_cast<double>(k) / count));
  };
  in_steps(10, 0, 0);
  in_steps(10, 0, 10e-3);
  EXPECT_GT(grip_count(hands.field.organs[0], ToolIndex{0}), 5);
  in_steps(3, open, 0);
  EXPECT_EQ(grip_count(hands.field.organs[0], ToolIndex{0}), 0);
  in_steps(30, open, 0);
  EXPECT_EQ(hands.field.tools[0].pose, to) << "it came there in the end";
  EXPECT_TRUE(hands.last.balanced);
}

TEST(StepBudget, IsTheSameWorkForFewerNodesWithinReason) {
  const int usual = StepBudget{}.begin;
  EXPECT_EQ(budget_of(340).begin, usual);
  EXPECT_EQ(budget_of(10'000).begin, usual) << "no step of a large field is worth nothing";
  EXPECT_EQ(budget_of(170).begin, 2 * usual);
  EXPECT_EQ(budget_of(4).begin, budget_of(1).begin);
  EXPECT_GT(budget_of(4).begin, 2 * usual);
  EXPECT_EQ(budget_of(4).balance, StepBudget{}.balance);
}

// A person waits for such a step as for any other.
TEST(StepBudget, IsTheSameWhereNoToolMoves) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  test::FundusPath path(moving_scene());
  ASSERT_TRUE(path.driver.go(path.fundus - 3e-3 * path.out, test::open_jaw, 8)) << path.driver.why();
  Budgeted still(path.world, {500, 0});
  InstrumentPose in = path.world.report().instruments[0].pose;
  in.insertion += 3e-3;
  still.step(in);
  EXPECT_EQ(still.cut_short, 0);
  still.field.budget = {1, 1};
  for (int k = 0; k < 3; ++k) still.step(in);  // what it pushed goes on moving
  EXPECT_GT(still.cut_short, 0);
}

/// A tool that its user rams through an organ into the ground behind stops before it crushes the organ as no hand could, and
/// lets it go when it is drawn back.
TEST(StepBudget, WhatIsRammedAgainstGroundIsNotCrushedAndComesFree) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  SceneDefinition scene = test::ball_scene();
  scene.solver.motion = SolverMotion::dynamics;
  const test::FundusPath where(scene);
  GroundDefinition wall;
  wall.normal = where.out;
  wall.point = where.fundus - 42e-3 * where.out;  // 2 mm behind the ball
  scene.anatomy.ground = {wall};
  test::FundusPath path(scene);
  ASSERT_TRUE(path.driver.go(path.fundus + 2e-3 * path.out, 0, 4)) << path.driver.why();
  Field field = path.world.field();
  field.tools[0].definition.hand_force = 2;  // N: a weak hand's step is taken back above 40 N
  const InstrumentPose start = path.world.report().instruments[0].pose;
  const auto go = [&](double deeper) {
    InstrumentPose to = start;
    to.insertion += deeper;
    SolveStatistics statistics;
    const auto done = advance_unwedged(field, {to}, statistics);
    EXPECT_TRUE(done) << deeper << (done ? "" : to_text(done.failure()));
    return statistics.balanced;
  };
  for (int k = 1; k <= 10; ++k) go(8e-3 * k);
  EXPECT_LT(field.tools[0].pose.insertion, start.insertion + 50e-3) << "there is the wall";
  EXPECT_GT(tool_loads(field)[0].force.norm(), 10) << "that is ramming";
  EXPECT_FALSE(crushes(field));
  bool balanced = false;
  for (int k = 10; k >= -20; --k) balanced = go(4e-3 * std::max(k, 0));
  EXPECT_TRUE(balanced);
  EXPECT_EQ(field.tools[0].pose, start);
  EXPECT_LT(tool_loads(field)[0].force.norm(), 1);
}

TEST(StepBudget, WithoutMassesThereIsNone) {
  const World world = World::create(test::grasper_scene(80)).value();
  Field field = world.field();
  field.budget = {0, 0};
  SolveStatistics spent;
  spent.newton_iterations = 1000;
  EXPECT_FALSE(is_spent(field, spent));
  field.step_time = 0.02;
  EXPECT_TRUE(is_spent(field, spent));
}

}  // namespace
}  // namespace calot
