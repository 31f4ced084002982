// A rigid body of four nodes: its derivatives, its mass, and how rigid it is.

#include "fem/affine.h"

#include <gtest/gtest.h>

#include "numerics/modes.h"
#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace {

/// A clip: a box and a capsule at an angle, away from the origin.
SolidMoments odd_solid() {
  return joined(moved(box_moments({5e-3, 2e-3, 1e-3}), Pose(Eigen::Translation3d(0.03, -0.02, 0.01))),
                capsule_moments({0.035, -0.02, 0.01}, {0.037, -0.016, 0.012}, 1e-3));
}

AffineBody odd_body() { return AffineBody::create(odd_solid()).value(); }

/// Strained by tens of percent.
AffineBody::Coordinates thrown(const AffineBody& body, std::uint64_t seed) {
  Rng rng(seed);
  AffineBody::Coordinates x = body.placed(test::random_motion(rng, 0.1));
  for (int i = 0; i < 12; ++i) x[i] += rng.uniform(-1e-3, 1e-3);
  return x;
}

Vec3 at(const AffineBody& body, const AffineBody::Coordinates& x, const Vec3& point) {
  const StencilTable table = body.stencils(std::span(&point, 1));
  return blend(table, table.value, 0, x);
}

TEST(AffineBody, GradientAndHessianAreTheDerivativesOfTheEnergy) {
  const AffineBody body = odd_body();
  for (std::uint64_t seed : {1, 2, 3}) {
    const VecX x = thrown(body, seed);
    EXPECT_GT(body.distortion(x), 0.1);
    const auto value = [&](const VecX& y) { return body.value(y); };
    const auto gradient = [&](const VecX& y) { return VecX(body.sample(y).gradient); };
    const AffineBody::Sample sample = body.sample(x);
    EXPECT_EQ(sample.energy, body.value(x));
    // Widths of 1e-3 m: differences are wrong by (1e-7 / 1e-3)^2 and by rounding.
    EXPECT_LT(test::relative_error(sample.gradient, test::difference_gradient(value, x, 1e-7)), 1e-6);
    EXPECT_LT(test::relative_error(sample.hessian, test::difference_hessian(gradient, x, 1e-7)), 1e-6);
  }
}

TEST(AffineBody, RigidMotionsCostNothingAndChangeNoEnergy) {
  Rng rng(4);
  const AffineBody body = odd_body();
  const VecX x = thrown(body, 5);
  const double energy = body.value(x);
  const AffineBody::Coordinates f = body.sample(x).gradient;
  EXPECT_GT(energy, 1.0);
  for (int trial = 0; trial < 10; ++trial) {
    const Pose motion = test::random_motion(rng, 0.1);
    EXPECT_LT(body.value(body.placed(motion)), 1e-24 * energy);
    const VecX there = test::moved(motion, x);
    EXPECT_NEAR(body.value(there), energy, 1e-11 * energy);
    EXPECT_LT(test::relative_error(body.sample(there).gradient, test::turned(motion.linear(), f)), 1e-11);
  }
  EXPECT_LT(test::net_force(f).norm(), 1e-12 * f.norm());
  EXPECT_LT(test::net_torque(x, f, Vec3::Zero()).norm(), 1e-12 * f.norm() * x.norm());
}

TEST(AffineBody, EveryPointOfItIsCarriedAlong) {
  Rng rng(6);
  const AffineBody body = odd_body();
  for (int trial = 0; trial < 20; ++trial) {
    const Pose motion = test::random_motion(rng, 0.1);
    const Vec3 point = Vec3(0.03, -0.02, 0.01) + test::random_vector(rng, 5e-3);
    EXPECT_LT((at(body, body.placed(motion), point) - motion * point).norm(), 1e-15);
    const Pose found = body.pose(body.placed(motion));
    EXPECT_LT((found.matrix() - motion.matrix()).norm(), 1e-12);
  }
  const Vec3 point(0.03, -0.02, 0.01);
  const StencilTable shifted = body.stencils(std::span(&point, 1), 7);
  EXPECT_EQ(shifted.node, (std::vector<int>{7, 8, 9, 10}));
}

TEST(AffineBody, ItsMassIsAQuarterAtEachNodeAndHasTheSolidsInertia) {
  constexpr double density = 4500;
  const SolidMoments solid = odd_solid();
  const AffineBody body = odd_body();
  const Eigen::Matrix4d mass = body.mass(solid, density);
  const double whole = density * solid.volume;
  EXPECT_LT((mass - whole / 4 * Eigen::Matrix4d::Identity()).norm(), 1e-12 * whole);
  // Another solid that moves along is not diagonal, but has its own kinetic energy: of a spin, by its second moments.
  const SolidMoments ball = ball_moments({0.05, 0, 0.02}, 3e-3);
  const Eigen::Matrix4d carried = body.mass(ball, density);
  const Vec3 spin(3, -2, 5), shift(0.1, 0.2, -0.1);
  double energy = 0;
  for (int k = 0; k < 4; ++k)
    for (int l = 0; l < 4; ++l)
      energy +=
          0.5 * carried(k, l) * (shift + spin.cross(body.rest()[k])).dot(shift + spin.cross(body.rest()[l]));
  const Vec3 middle = shift + spin.cross(ball.centroid);
  const double expected =
      0.5 * density *
      (ball.volume * middle.squaredNorm() + 0.4 * ball.volume * 3e-3 * 3e-3 * spin.squaredNorm());
  EXPECT_NEAR(energy, expected, 1e-11 * expected);
}

/// In balance with forces on points of it, which sum to no force and no torque: Newton with the smallest steps.
AffineBody::Coordinates loaded(const AffineBody& body, const std::vector<Vec3>& points,
                               const std::vector<Vec3>& forces) {
  VecX load = VecX::Zero(12);
  spread(body.stencils(points), forces, load);
  AffineBody::Coordinates x = body.placed();
  for (int step = 0; step < 20; ++step) {
    const AffineBody::Sample s = body.sample(x);
    const Modes shapes = modes(Eigen::MatrixXd(s.hessian)).value();
    const double largest = shapes.values.cwiseAbs().maxCoeff();
    for (int k = 0; k < 12; ++k) {
      const double stiffness = shapes.values[k], force = shapes.vectors.col(k).dot(s.gradient - load);
      if (std::abs(stiffness) > 1e-14 * largest) x -= force / stiffness * shapes.vectors.col(k);
    }
  }
  EXPECT_LT((body.sample(x).gradient - load).norm(), 1e-6 * load.norm());
  return x;
}

TEST(AffineBody, AnInstrumentDistortsItByLessThanOneInTenThousand) {
  constexpr double radius = 5e-3, force = 10;
  const AffineBody ball = AffineBody::create(ball_moments(Vec3::Zero(), radius)).value();
  const AffineBody box = AffineBody::create(box_moments(Vec3::Constant(radius))).value();
  for (const AffineBody& body : {ball, box}) {
    for (const Vec3& along : {Vec3(1, 0, 0), Vec3(Vec3(1, 2, -2) / 3)}) {
      const AffineBody::Coordinates x =
          loaded(body, {-radius * along, radius * along}, {-force * along, force * along});
      EXPECT_LT(body.distortion(x), 1e-4);
      // What the header says of the strain, to first order in it.
      const double strain = force * 2 * radius / (8 * AffineBody::default_stiffness * body.volume());
      EXPECT_NEAR(body.distortion(x), strain, 1e-3 * strain);
    }
    // Sheared: two couples.
    const Vec3 x = radius * Vec3::UnitX(), y = radius * Vec3::UnitY();
    const AffineBody::Coordinates sheared = loaded(
        body, {x, -x, y, -y},
        {force * Vec3::UnitY(), -force * Vec3::UnitY(), force * Vec3::UnitX(), -force * Vec3::UnitX()});
    EXPECT_LT(body.distortion(sheared), 1e-4);
    EXPECT_GT(body.distortion(sheared), 1e-6);
  }
}

TEST(AffineBody, WhatHasNoVolumeNoThicknessOrNoStiffnessIsRefused) {
  SolidMoments flat = box_moments({1, 1, 1});
  flat.second(2, 2) = 0;
  SolidMoments inside_out = box_moments({1, 1, 1});
  inside_out.volume *= -1;
  for (const SolidMoments& bad : {SolidMoments(), flat, inside_out})
    EXPECT_EQ(AffineBody::create(bad).failure().kind, FailureKind::scenario);
  for (double stiffness : {0.0, -1.0, std::nan("")})
    EXPECT_EQ(AffineBody::create(box_moments({1, 1, 1}), stiffness).failure().kind, FailureKind::scenario);
  EXPECT_TRUE(AffineBody::create(box_moments({1, 1e-3, 1})));
}

TEST(AffineBody, ACurvedStepIsTheStraightOneToFirstOrderAndTurnsWithoutStrain) {
  Rng rng(11);
  const AffineBody body = AffineBody::create(box_moments(Vec3(4e-3, 3e-3, 2e-3)), 1e8).value();
  Pose there = Pose::Identity();
  there.rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  const AffineBody::Coordinates x = body.placed(there);
  AffineBody::Coordinates step;
  const Vec3 turn(20, -30, 10), shift(1e-3, 2e-3, -1e-3);  // rad and m, in a unit of the step
  for (int k = 0; k < AffineBody::nodes; ++k) {
    const Vec3 at = x.segment<3>(3 * k);
    step.segment<3>(3 * k) = turn.cross(at) + shift + test::random_vector(rng, 1e-7);
  }
  std::vector<double> off;
  for (const double share : {1e-2, 5e-3}) {
    const AffineBody::Coordinates straight = share * step, curved = body.curved(x, straight);
    off.push_back((curved - straight).norm());
    EXPECT_LT(body.distortion(x + curved), 1e-3 * body.distortion(x + straight)) << share;
  }
  EXPECT_GT(off[1], 1e-5) << "it turns far";
  EXPECT_NEAR(off[0] / off[1], 4, 0.1) << "they part by the square of the way";
}

}  // namespace
}  // namespace calot
