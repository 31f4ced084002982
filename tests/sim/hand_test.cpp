// Hands that give way.

#include "tools/hand.h"

#include "numerics/dense_cholesky.h"
#include "numerics/modes.h"
#include "support/derivatives.h"
#include "support/random.h"

namespace calot {
namespace {

struct HeldTool {
  Tool tool;
  InstrumentPose command{0.3, -0.5, 0.18, 0.7, 0.4};
  Hand hand{tool, command, hand_of(tool)};
  ToolVector goal = tool_coordinates(command);
};

TEST(Hand, ItsForcesAreTheSlopesOfItsEnergyNearAndFarAndBeyondTheStops) {
  const HeldTool held;
  Rng rng(3);
  for (double reach : {0.02e-3, 0.5e-3, 5e-3})
    for (double jaw : {-1.0, 0.0, 1.0}) {  // beyond closed, between, beyond open
      ToolVector q = held.goal + test::random_coordinates(rng, 6, reach);
      if (jaw < 0) q[4] = -0.04e-3;
      if (jaw > 0) q[4] = held.tool.geometry.jaw_opening * jaw_lever + 0.03e-3;
      const Hand::Sample at = held.hand.sample(q);
      const auto energy = [&](const VecX& near) { return held.hand.sample(near).energy; };
      const auto slope = [&](const VecX& near) -> VecX { return held.hand.sample(near).gradient; };
      EXPECT_LT(test::relative_error(at.gradient, test::difference_gradient(energy, q, 1e-8)), 1e-6);
      EXPECT_LT(test::relative_error(at.hessian, test::difference_hessian(slope, q, 1e-8)), 1e-6);
      EXPECT_GT(at.gradient.cwiseAbs().minCoeff(), 1e-3);
      EXPECT_GT(modes(at.hessian).value().values[0], 0);
    }
}

TEST(Hand, AtItsCommandItDoesNothing) {
  const HeldTool held;
  const Hand::Sample at = held.hand.sample(held.goal);
  EXPECT_EQ(at.energy, 0);
  EXPECT_EQ(at.gradient, ToolVector::Zero());
  EXPECT_EQ(held.hand.effort(held.goal).tip, 0);
}

/// Where a force on the tip (N) brings the tool that the hand holds, by Newton's method. The tip's way to first order.
ToolVector pushed(const HeldTool& held, const Vec3& force) {
  ToolVector q = held.goal;
  const PosedPart shaft(held.tool, held.command, 0);
  const Vec3 tip = tip_position(held.tool.trocar, held.command, held.tool.geometry);
  ToolVector load = shaft.slopes(tip).transpose() * force;
  load[3] = load[4] = 0;
  for (int k = 0; k < 50; ++k) {
    const Hand::Sample at = held.hand.sample(q);
    Eigen::MatrixXd factor = at.hessian;
    EXPECT_TRUE(cholesky_in_place(factor));
    q -= cholesky_solve(factor, VecX(at.gradient - load));
  }
  return q;
}

TEST(Hand, ANewtonMovesTheTipByTwoHundredthsOfAMillimetreWhereverItPoints) {
  const HeldTool held;
  const PosedPart shaft(held.tool, held.command, 0);
  const Vec3 tip = tip_position(held.tool.trocar, held.command, held.tool.geometry);
  Rng rng(5);
  for (int k = 0; k < 10; ++k) {
    const Vec3 force = test::random_vector(rng, 1.0).normalized();
    const ToolVector q = pushed(held, force);
    const Vec3 way = shaft.slopes(tip) * held.hand.lag(q);
    EXPECT_LT(way.norm(), 0.02e-3);
    EXPECT_GT(way.dot(force), 0.01e-3);
    EXPECT_LT((way - way.dot(force) * force).norm(),
              1e-9);  // alike in all directions: straight along the force
    EXPECT_NEAR(held.hand.effort(q).tip, 1.0, 1e-9);
  }
}

TEST(Hand, ItNeverDoesMoreThanItsStrengthHoweverFarItsToolIsKept) {
  const HeldTool held;
  ToolVector q = held.goal;
  double before = 0;
  for (double way : {0.1e-3, 1e-3, 10e-3, 100e-3}) {
    q = held.goal - ToolVector{way, way, way, way, -way, 0};
    const Hand::Effort effort = held.hand.effort(q);
    EXPECT_GT(effort.tip, before);
    EXPECT_LT(effort.tip, 20);
    EXPECT_LT(effort.roll, 0.2);
    EXPECT_LT(effort.pinch, held.tool.definition.pinch_force);
    before = effort.tip;
  }
  const Hand::Effort most = held.hand.effort(q);
  EXPECT_GT(most.tip, 0.999 * 20);
  EXPECT_GT(most.roll, 0.999 * 0.2);
  EXPECT_GT(most.pinch, 0.999 * held.tool.definition.pinch_force);
}

TEST(Hand, ThePinchIsAMomentAboutTheHingeAtThePadsLever) {
  const HeldTool held;
  ToolVector q = held.goal;
  q[4] += 20e-3;  // held wide open
  Tool loose = held.tool;
  loose.geometry.jaw_opening = 4;  // no stop there
  const Hand hand(loose, held.command, hand_of(loose));
  // Both pads do work on what they hold: each at half the angle.
  const double moment = hand.sample(q).gradient[4] * jaw_lever;  // N m, by the whole angle
  EXPECT_NEAR(moment, hand.effort(q).pinch * 0.5 * held.tool.geometry.jaw_length, 1e-12);
  EXPECT_NEAR(hand.effort(q).pinch, held.tool.definition.pinch_force, 1e-3);
}

}  // namespace
}  // namespace calot
