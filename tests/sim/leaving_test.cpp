// What opening jaws let go where masses count.

#include "field/leaving.h"

#include <gtest/gtest.h>

#include "field/grip.h"
#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

SceneDefinition moving_ball(double rate) {
  SceneDefinition scene = test::with_strong_jaws(test::ball_scene());
  scene.solver.motion = SolverMotion::dynamics;
  scene.solver.rate = rate;
  return scene;
}

/// A fold of a ball that is held 4 mm above where it was.
struct HeldFold {
  test::FundusPath path;
  VecX rest;
  double rate;

  explicit HeldFold(double of_rate) : path(moving_ball(of_rate)), rate(of_rate) {
    rest = organ().state.x;
    EXPECT_TRUE(path.grasp(steps(0.2)) && path.lift(steps(0.4)) && path.driver.stay(steps(0.4)))
        << path.driver.why();
    EXPECT_GT(grip_count(organ(), ToolIndex(0)), 4);
  }
  const Organ& organ() const { return path.world.field().organs[0]; }
  int steps(double seconds) const { return static_cast<int>(std::lround(seconds * rate)); }
  bool open() { return path.driver.go(path.fundus + 4e-3 * path.out, test::open_jaw, 1); }
  double from_rest() const { return (organ().state.x - rest).lpNorm<Eigen::Infinity>(); }
};

TEST(Leaving, AFoldThatOpeningJawsLetGoIsFreeInTimeAndNotAtOnce) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  for (const double rate : {25.0, 100.0}) {
    HeldFold fold(rate);
    const VecX held = fold.organ().state.x;
    const double away = fold.from_rest();
    ASSERT_GT(away, 3e-3);
    ASSERT_TRUE(fold.open()) << fold.path.driver.why();
    EXPECT_EQ(fold.path.driver.count(EventKind::release), 1);
    EXPECT_EQ(grip_count(fold.organ(), ToolIndex(0)), 0) << "nothing is held";
    EXPECT_FALSE(fold.organ().leaving.empty());
    EXPECT_LT((fold.organ().state.x - held).lpNorm<Eigen::Infinity>(), 0.1 * away) << "it rubs on the pads";
    ASSERT_TRUE(fold.path.driver.stay(fold.steps(leaving_time))) << fold.path.driver.why();
    EXPECT_TRUE(fold.organ().leaving.empty());
    ASSERT_TRUE(fold.path.withdraw(fold.steps(0.4)) && fold.path.driver.stay(fold.steps(1)));
    EXPECT_LT(fold.from_rest(), 0.02 * away) << "it is where it was";
  }
}

TEST(Leaving, ItsWayDependsNotOnTheRate) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  std::vector<double> ways;
  double away = 0;
  for (const double rate : {25.0, 100.0}) {
    HeldFold fold(rate);
    away = fold.from_rest();
    ASSERT_TRUE(fold.open() && fold.path.driver.stay(fold.steps(0.28) - 1)) << fold.path.driver.why();
    ways.push_back(fold.from_rest());
  }
  EXPECT_LT(ways[0], 0.8 * away) << "it is under way";
  EXPECT_GT(ways[0], 0.1 * away);
  // Implicit Euler of 40 ms in an exponential decay of 60 ms is off by a third of a step.
  EXPECT_NEAR(ways[0], ways[1], 0.15 * away);
}

TEST(Leaving, ItIsDraggedAgainstItsMeanMotionOnly) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  HeldFold fold(25);
  ASSERT_TRUE(fold.open());
  Organ organ = fold.organ();
  MotionPart& part = organ.state.motion;
  const Vec3 along(0.1, -0.2, 0.3);
  for (Eigen::Index i = 0; i < part.begin.velocity.size(); i += 3) part.begin.velocity.segment<3>(i) = along;
  const VecX together = part.begin.x + part.duration * part.begin.velocity;
  VecX force = VecX::Zero(together.size());
  const StencilTable& skin = organ.body->skin().stencils;
  leaving_springs(organ).add_gradient(skin, together, force);
  EXPECT_LT(force.lpNorm<Eigen::Infinity>(), 1e-6) << "N: nothing holds a fold that moves as one";
  leaving_springs(organ).add_gradient(skin, part.begin.x, force);
  EXPECT_GT(force.lpNorm<Eigen::Infinity>(), 1);
}

TEST(Leaving, JawsThatCloseAnewHoldWhatTheyLetGoAndDragNoneOfIt) {
  CALOT_SLOW_WHEN_SANITIZED("an organ that moves");
  HeldFold fold(25);
  ASSERT_TRUE(fold.open());
  ASSERT_FALSE(fold.organ().leaving.empty());
  const Vec3 down = fold.path.fundus - 4e-3 * fold.path.out;
  ASSERT_TRUE(fold.path.driver.go(down, test::open_jaw, 4) && fold.path.driver.go(down, 0, 6))
      << fold.path.driver.why();
  EXPECT_GT(grip_count(fold.organ(), ToolIndex(0)), 0);
  EXPECT_TRUE(fold.organ().leaving.empty());
}

}  // namespace
}  // namespace calot
