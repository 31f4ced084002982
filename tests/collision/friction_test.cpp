#include "collision/friction.h"

#include <gtest/gtest.h>

#include "random_shapes.h"

namespace calot {
namespace {

constexpr double reach = 20e-6;  // m

StickSlip random_hold(Rng& rng) {
  StickSlip hold;
  hold.anchor = test::random_vector(rng, 10e-3);
  hold.normal = test::random_direction(rng);
  hold.limit = rng.uniform(1e-3, 1e-1);
  hold.stiffness = hold.limit / reach;
  return hold;
}

/// A place whose tangential way from the anchor is `share` of the reach.
Vec3 place_at(const StickSlip& hold, double share, Rng& rng) {
  Vec3 across = hold.normal.cross(test::random_direction(rng)).normalized();
  return hold.anchor + share * reach * across + rng.uniform(-1e-4, 1e-4) * hold.normal;
}

TEST(Friction, DerivativesMatchFiniteDifferencesStickingAndSliding) {
  Rng rng(1);
  for (double share : {0.1, 0.5, 0.9, 1.1, 2.0, 30.0}) {
    for (int k = 0; k < 20; ++k) {
      const StickSlip hold = random_hold(rng);
      const Vec3 x = place_at(hold, share, rng), d = test::random_direction(rng);
      // The energy is quadratic or, sliding, of curvature 1 / way: central differences err by (h / way)^2 of
      // it, 1e-6, and by the rounding of coordinates, 1e-18 m over h.
      const double h = 1e-3 * share * reach;
      const FrictionSample at = hold.sample(x), ahead = hold.sample(x + h * d),
                           behind = hold.sample(x - h * d);
      EXPECT_GT(at.energy, 0);
      EXPECT_GT(at.gradient.norm(), 0);
      EXPECT_NEAR(at.gradient.dot(d), (ahead.energy - behind.energy) / (2 * h), 1e-5 * hold.limit);
      EXPECT_GT((at.hessian * d).norm(), 0);
      EXPECT_LT((at.hessian * d - (ahead.gradient - behind.gradient) / (2 * h)).norm(),
                1e-5 * at.hessian.norm());
    }
  }
}

TEST(Friction, HessianIsPositiveSemidefiniteAndMeetsNoResistanceAlongTheNormal) {
  Rng rng(2);
  for (double share : {0.0, 0.5, 0.999, 1.001, 50.0}) {
    const StickSlip hold = random_hold(rng);
    const FrictionSample at = hold.sample(place_at(hold, share, rng));
    EXPECT_LT((at.hessian * hold.normal).norm(), 1e-12 * hold.stiffness);
    // Across the normal its eigenvalues are not negative where their sum and product are not.
    Eigen::Matrix<double, 3, 2> across;
    across.col(0) = hold.normal.unitOrthogonal();
    across.col(1) = hold.normal.cross(across.col(0));
    const Eigen::Matrix2d h = across.transpose() * at.hessian * across;
    EXPECT_GE(h.trace(), 0);
    EXPECT_GE(h.determinant(), -1e-12 * hold.stiffness * hold.stiffness);
    EXPECT_LT(std::abs(at.gradient.dot(hold.normal)), 1e-12 * hold.limit);
  }
}

TEST(Friction, NeverLeavesTheConeAndSlidesOnIt) {
  Rng rng(3);
  for (double share = 0; share < 4; share += 0.01) {
    const StickSlip hold = random_hold(rng);
    const double force = hold.sample(place_at(hold, share, rng)).gradient.norm();
    EXPECT_LE(force, hold.limit * (1 + 1e-12));
    // Coordinates of 10 mm are rounded to 1e-18 m, 1e-13 of the reach.
    EXPECT_NEAR(force / hold.limit, std::min(share, 1.0), 1e-10);
  }
}

TEST(Friction, EnergyAndForceJoinWhereSlidingBegins) {
  Rng rng(4);
  const StickSlip hold = random_hold(rng);
  const Vec3 across = hold.normal.unitOrthogonal();
  const auto at = [&](double share) { return hold.sample(hold.anchor + share * reach * across); };
  EXPECT_NEAR(at(1 - 1e-9).energy, at(1 + 1e-9).energy, 1e-8 * hold.limit * reach);
  EXPECT_LT((at(1 - 1e-9).gradient - at(1 + 1e-9).gradient).norm(), 1e-8 * hold.limit);
}

TEST(Friction, TheAnchorStaysWhileItSticksAndFollowsWhenItSlidesWithoutChangeOfForce) {
  Rng rng(5);
  for (double share : {0.0, 0.3, 0.99, 1.01, 3.0, 100.0}) {
    StickSlip hold = random_hold(rng);
    const Vec3 x = place_at(hold, share, rng), before = hold.anchor;
    const Vec3 force = hold.sample(x).gradient;
    hold.anchor = hold.anchor_after(x);
    EXPECT_EQ(hold.anchor == before, share < 1);
    EXPECT_LT((hold.sample(x).gradient - force).norm(), 1e-10 * hold.limit);
    const Vec3 again = hold.anchor_after(x);
    EXPECT_LT((again - hold.anchor).norm(), 1e-12 * reach + 1e-17) << "no creep";
  }
}

// The elastic energy at the end, plus what sliding lost, is the work done on it: never less than was lost.
TEST(Friction, AClosedCycleLosesEnergyWhateverThePressureDoesMeanwhile) {
  Rng rng(6);
  for (int cycle = 0; cycle < 50; ++cycle) {
    StickSlip hold = random_hold(rng);
    hold.limit = 0.02;
    hold.stiffness = 1e3;
    const Vec3 home = hold.anchor;
    Vec3 x = home;
    double work = 0;
    bool slid = false;
    for (int k = 0; k < 400; ++k) {
      const Vec3 next = k == 399 ? home : Vec3(home + test::random_vector(rng, 40e-6));
      constexpr int parts = 50;
      const Vec3 step = (next - x) / parts;
      for (int p = 0; p < parts; ++p) {
        const Vec3 middle = x + 0.5 * step;
        const Vec3 anchor = hold.anchor_after(x + step);
        work += hold.sample(middle).gradient.dot(step);
        slid |= anchor != hold.anchor;
        hold.anchor = anchor;
        x += step;
      }
      hold.limit = rng.uniform(0.0, 0.04);
      hold.anchor = hold.anchor_after(x);
    }
    EXPECT_TRUE(slid);
    EXPECT_GT(work, 0);
  }
}

TEST(Friction, IsTheSameInEveryFrame) {
  Rng rng(7);
  for (double share : {0.5, 2.0}) {
    const StickSlip hold = random_hold(rng);
    const Vec3 x = place_at(hold, share, rng);
    const Pose motion = test::random_pose(rng, 20e-3);
    const Vec3 turned = motion.linear() * hold.sample(x).gradient;
    EXPECT_LT((hold.carried(motion).sample(motion * x).gradient - turned).norm(), 1e-9 * hold.limit);
  }
}

TEST(Friction, WithoutPressureThereIsNone) {
  StickSlip hold;
  hold.stiffness = 1e3;
  const FrictionSample at = hold.sample(Vec3(1e-3, 0, 0));
  EXPECT_EQ(at.energy, 0);
  EXPECT_EQ(at.gradient, Vec3::Zero());
  EXPECT_EQ(at.hessian, Mat3::Zero());
}

}  // namespace
}  // namespace calot
