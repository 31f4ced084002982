#include "fem/rod.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "numerics/dense_cholesky.h"
#include "support/bodies.h"
#include "support/derivatives.h"
#include "support/rods.h"

namespace calot::rod_test {
namespace {

using std::numbers::pi;
constexpr double length = 30e-3, radius = 1.6e-3, wall = 0.4e-3, young = 3e5;
constexpr double high = 20e3;  // Pa: the hoop strains by 0.3 or so, far from nothing and from bursting

/// A duct that narrows, thrown about: stretched by tens of percent, bent to radii of a few millimetres.
struct ThrownDuct {
  test::StraightRod straight = test::straight_rod(
      6, length, [](double share) { return tube_section(young, (1 - 0.4 * share) * radius, wall); });
  const Rod& rod = straight.rod;
  VecX x;

  explicit ThrownDuct(std::uint64_t seed) {
    Rng rng(seed);
    x = straight.rest + test::random_coordinates(rng, static_cast<int>(straight.rest.size()), 2.5e-3);
  }
};

VecX rod_gradient(const Rod& rod, const VecX& x, double pressure) {
  VecX g = VecX::Zero(x.size());
  rod.add_gradient(x, pressure, g);
  return g;
}

Eigen::MatrixXd rod_hessian(const test::StraightRod& straight, const VecX& x, double pressure) {
  BlockMatrix matrix = straight.matrix();
  straight.rod.add_hessian(x, pressure, matrix);
  return test::dense(matrix);
}

TEST(Rod, GradientAndHessianAreTheDerivativesOfTheEnergy) {
  for (double pressure : {0.0, high, -high}) {
    const ThrownDuct duct(1);
    double bent = 0, stretched = 0;
    for (const Rod::Sample& at : duct.rod.samples(duct.x, pressure)) {
      bent = std::max(bent, at.bending);
      stretched = std::max(stretched, std::abs(at.stretch - 1));
    }
    EXPECT_GT(bent, 100.0);
    EXPECT_GT(stretched, 0.2);
    // Spans of 5e-3 m: differences are wrong by (1e-7 / 5e-3)^2 times higher derivatives, and by rounding.
    const auto value = [&](const VecX& y) { return duct.rod.value(y, pressure); };
    const auto gradient = [&](const VecX& y) { return rod_gradient(duct.rod, y, pressure); };
    EXPECT_GT(gradient(duct.x).norm(), 1e-2);
    EXPECT_LT(test::relative_error(gradient(duct.x), test::difference_gradient(value, duct.x, 1e-7)), 1e-7);
    const Eigen::MatrixXd hessian = rod_hessian(duct.straight, duct.x, pressure);
    EXPECT_LT(test::relative_error(hessian, test::difference_hessian(gradient, duct.x, 1e-7)), 1e-7);
  }
}

TEST(Rod, BendingAloneHasExactDerivatives) {
  // Beside a wall that cannot stretch, bending would be lost in the differences: one as soft as air instead.
  const test::StraightRod soft =
      test::straight_rod(5, length, RodSection{.axial = 1e-12, .bending = 2e-6, .radius = radius});
  Rng rng(2);
  const VecX x = soft.rest + test::random_coordinates(rng, static_cast<int>(soft.rest.size()), 2.5e-3);
  const auto value = [&](const VecX& y) { return soft.rod.value(y, 0); };
  const auto gradient = [&](const VecX& y) { return rod_gradient(soft.rod, y, 0); };
  EXPECT_GT(gradient(x).norm(), 1e-4);
  EXPECT_LT(test::relative_error(gradient(x), test::difference_gradient(value, x, 1e-7)), 1e-6);
  EXPECT_LT(test::relative_error(rod_hessian(soft, x, 0), test::difference_hessian(gradient, x, 1e-7)), 1e-6);
}

TEST(Rod, AStraightRestCarriesNothingHoweverItIsMoved) {
  Rng rng(3);
  const ThrownDuct duct(3);
  const VecX there = test::moved(test::random_motion(rng, 0.1), duct.straight.rest);
  const double scale = duct.rod.value(duct.x, 0);
  EXPECT_GT(scale, 0);
  EXPECT_LT(duct.rod.value(there, 0), 1e-24 * scale);  // strains are right to 1e-14 or so
  EXPECT_LT(rod_gradient(duct.rod, there, 0).norm(), 1e-12 * rod_gradient(duct.rod, duct.x, 0).norm());
}

TEST(Rod, RigidMotionsChangeNoEnergyAndTurnTheForcesWhichAreInBalance) {
  Rng rng(4);
  const ThrownDuct duct(4);
  const Pose motion = test::random_motion(rng, 0.1);
  const VecX there = test::moved(motion, duct.x);
  const double energy = duct.rod.value(duct.x, high);
  EXPECT_GT(std::abs(energy), 1e-6);
  EXPECT_NEAR(duct.rod.value(there, high), energy, 1e-11 * std::abs(energy));
  const VecX f = rod_gradient(duct.rod, duct.x, high);
  EXPECT_LT(test::relative_error(rod_gradient(duct.rod, there, high), test::turned(motion.linear(), f)),
            1e-11);
  EXPECT_LT(test::net_force(f).norm(), 1e-12 * f.norm());
  EXPECT_LT(test::net_torque(duct.x, f, Vec3::Zero()).norm(), 1e-12 * f.norm() * length);
}

TEST(Rod, OnlyRigidMotionsAreFree) {
  // Two Gauss points a span miss nothing, down to the shortest line. The turn about the rod moves no node.
  for (int spans : {2, 3, 8}) {
    const test::StraightRod straight =
        test::straight_rod(spans, 1.0, RodSection{.axial = 1, .bending = 1, .radius = 1});
    const Eigen::MatrixXd hessian = rod_hessian(straight, straight.rest, 0);
    const int size = static_cast<int>(hessian.rows());
    Eigen::MatrixXd held = hessian;
    for (int motion = 0; motion < 5; ++motion) {
      VecX moved = VecX::Zero(size);
      for (int i = 0; i < size; i += 3)
        moved.segment<3>(i) =
            motion < 3 ? Vec3::Unit(motion) : Vec3::Unit(motion - 2).cross(straight.rest.segment<3>(i));
      EXPECT_LT((hessian * moved).norm(), 1e-12 * hessian.norm() * moved.norm());
      held += moved * moved.transpose();
    }
    ASSERT_TRUE(cholesky_in_place(held)) << spans;
    // A miss would leave rounding; bending at the finest spans is (1 / spans)^4 of its stiffest.
    EXPECT_GT(held.diagonal().minCoeff(), 1e-4 * held.diagonal().maxCoeff()) << spans;
  }
}

TEST(Rod, ATubesSectionIsThatOfAThinAnnulusAndAThreadsThatOfADisc) {
  const double thin = 0.02 * radius, outer = radius + thin / 2, inner = radius - thin / 2;
  const RodSection tube = tube_section(young, radius, thin), thread = solid_section(young, radius);
  const auto disc = [](double r) { return young * pi * r * r; };
  const auto second = [](double r) { return young * pi * r * r * r * r / 4; };
  EXPECT_NEAR(tube.axial, disc(outer) - disc(inner), 1e-12 * tube.axial);
  EXPECT_NEAR(tube.bending, second(outer) - second(inner), 1.01e-4 * tube.bending) << "(t / r)^2 / 4";
  EXPECT_NEAR(thread.axial, disc(radius), 1e-12 * thread.axial);
  EXPECT_NEAR(thread.bending, second(radius), 1e-12 * thread.bending);
  EXPECT_EQ(thread.hoop, 0);
}

TEST(Rod, TheRadiusUnderPressureIsThatOfLeastEnergy) {
  const RodSection duct = tube_section(young, radius, wall);
  const double stretch = 1.2;
  const auto energy = [&](double r) {
    const double grown = r - radius;
    return duct.axial / 2 * 0.04 + pi * duct.hoop * grown * grown / radius - high * pi * r * r * stretch;
  };
  const SectionAnswer at = answer(duct, stretch, high);
  EXPECT_GT(at.radius, 1.2 * radius);
  EXPECT_NEAR(at.energy, energy(at.radius), 1e-12 * std::abs(at.energy));
  EXPECT_GT(energy(0.999 * at.radius), at.energy);
  EXPECT_GT(energy(1.001 * at.radius), at.energy);
  // Hoop strain p r / (E t) where it is small: the error falls with the pressure.
  for (double pressure : {200.0, 100.0}) {
    const double strain = pressure * radius / duct.hoop;
    EXPECT_NEAR(answer(duct, 1, pressure).radius / radius - 1, strain, 1.01 * strain * strain);
  }
}

TEST(Rod, PressureDoesItsWorkOnTheLumensVolume) {
  // The radius being of least energy, the energy's derivative by the pressure is minus the volume.
  const ThrownDuct duct(5);
  const double h = 1, volume = duct.rod.volume(duct.x, high);
  EXPECT_GT(volume, pi * 1e-6 * length);
  EXPECT_NEAR((duct.rod.value(duct.x, high - h) - duct.rod.value(duct.x, high + h)) / (2 * h), volume,
              1e-7 * volume);
}

TEST(Rod, APressureThatNoRadiusHoldsAndALineWithoutDirectionAreNotAdmissible) {
  const ThrownDuct duct(6);
  const double bursts = 0.99 * young * wall / radius;  // at rest just held
  EXPECT_TRUE(std::isfinite(duct.rod.value(duct.straight.rest, bursts)));
  EXPECT_EQ(duct.rod.value(1.05 * duct.straight.rest, bursts), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(rod_gradient(duct.rod, 1.05 * duct.straight.rest, bursts).allFinite());
  EXPECT_EQ(duct.rod.value(0 * duct.x, 0), std::numeric_limits<double>::infinity());
}

TEST(Rod, PressureDoesNothingToASolidThread) {
  const test::StraightRod thread = test::straight_rod(4, length, solid_section(young, radius));
  const VecX x = 1.1 * thread.rest;
  EXPECT_GT(thread.rod.value(x, 0), 0);
  EXPECT_EQ(thread.rod.value(x, high), thread.rod.value(x, 0));
  EXPECT_EQ(thread.rod.volume(x, high), 0);
}

TEST(Rod, BadRestLinesAndSectionsAreRefused) {
  const Centreline line = Centreline::create(5).value();
  const VecX rest = line.along({Vec3::Zero(), Vec3::UnitX()}).value();
  const RodSection good = solid_section(young, radius);
  RodSection limp = good, unknown = good, inverted = tube_section(young, radius, wall);
  limp.bending = 0;
  unknown.axial = std::numeric_limits<double>::quiet_NaN();
  inverted.hoop *= -1;
  const auto made = [&](const VecX& x, const RodSection& section) {
    return Rod::create(line.quadrature(), x, std::vector<RodSection>(4, section));
  };
  EXPECT_TRUE(made(rest, good));
  EXPECT_EQ(made(0 * rest, good).failure().kind, FailureKind::scenario);
  for (const RodSection& section : {limp, unknown, inverted})
    EXPECT_EQ(made(rest, section).failure().kind, FailureKind::scenario);
}

}  // namespace
}  // namespace calot::rod_test
