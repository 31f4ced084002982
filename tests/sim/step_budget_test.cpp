// A step that has spent its budget.

#include "motion/step_budget.h"

#include <gtest/gtest.h>

#include "acts/advance.h"
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

  Budgeted(const World& world, int budget) : field(world.field()) { field.step_budget = budget; }
  void step(const InstrumentPose& to) {
    last = {};
    ASSERT_TRUE(advance(field, {to}, last));
    EXPECT_LE(last.newton_iterations + last.substeps, field.step_budget + 1);
    cut_short += last.cut_short ? 1 : 0;
  }
};

TEST(StepBudget, WhatAStepLeavesUndoneTheNextOnesMakeGood) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  test::FundusPath path(moving_scene());
  ASSERT_TRUE(path.driver.go(path.fundus + 2e-3 * path.out, 0, 4)) << path.driver.why();
  Budgeted whole(path.world, 500), thrifty(path.world, 4);
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

TEST(StepBudget, WithoutMassesThereIsNone) {
  const World world = World::create(test::grasper_scene(80)).value();
  Field field = world.field();
  field.step_budget = 0;
  SolveStatistics spent;
  spent.newton_iterations = 1000;
  EXPECT_FALSE(is_spent(field, spent));
  field.step_time = 0.02;
  EXPECT_TRUE(is_spent(field, spent));
}

}  // namespace
}  // namespace calot
