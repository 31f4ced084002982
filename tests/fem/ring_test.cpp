// The flattening of a tube's section, against the elastica; and what it is in series with a barrier.

#include "fem/ring.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "collision/barrier.h"

namespace calot {
namespace ring_test {
namespace {

using std::numbers::pi;

constexpr double young = 3e5, middle = 1.6e-3, thickness = 0.4e-3, filled = 1.5e3;  // Pa: 11 mmHg

FlatRing duct() { return FlatRing::of_tube(young, middle, thickness); }

/// Integral over [0, 1] by Gauss in pieces.
template <class F>
double integral(const F& f) {
  constexpr int pieces = 200;
  const double at = 0.5 / std::sqrt(3.0);
  double sum = 0;
  for (int k = 0; k < pieces; ++k)
    for (double side : {-at, at}) sum += f((k + 0.5 + side) / pieces) / (2 * pieces);
  return sum;
}

/// A ring of unit radius and rigidity under two opposite loads, by the first integral of the elastica: the angle t of
/// its tangent turns by t'^2 = c + load sin t, c the square of the curvature under the load.
struct Pressed {
  double closing = 0, load = 0;

  /// Before it lies on flats: 0 < c < 1. The quarter is pi / 2 long.
  static Pressed by_curvature(double c) {
    const auto quarter = [&](double pressed_by, bool height) {
      return integral([&](double u) {  // t = pi/2 u^2: no root is left at the end
        const double t = 0.5 * pi * u * u;
        return pi * u * (height ? std::sin(t) : 1) / std::sqrt(c + pressed_by * std::sin(t));
      });
    };
    double low = 0, high = 10;
    for (int k = 0; k < 60; ++k) {
      const double load = 0.5 * (low + high);
      (quarter(load, false) > 0.5 * pi ? low : high) = load;
    }
    return {2 - 2 * quarter(low, true), low};
  }
  static Pressed on_flats(double closing) {
    const double height =
        integral([](double u) { return pi * u * 2 * std::sqrt(std::sin(0.5 * pi * u * u)); });
    return {closing, std::pow(height / (2 - closing), 2)};
  }
};

TEST(FlatRing, AtFirstItIsTimoshenkosRing) {
  const FlatRing ring = duct();
  const double rigidity = young * std::pow(thickness, 3) / 12, load = 1e-4;
  const double closing = 0.149 * load * std::pow(middle, 3) / rigidity;  // of three digits
  EXPECT_LT(closing, 1e-3 * ring.lumen);
  EXPECT_NEAR(ring.sample(closing, 0).slope, load, 2e-3 * load);
  EXPECT_NEAR(ring.sample(closing, 0).energy, 0.5 * load * closing, 2e-3 * load * closing);
  EXPECT_EQ(ring.sample(0, 0).energy, 0);
  EXPECT_EQ(ring.sample(0, filled).slope, 0);
}

TEST(FlatRing, AThinWallFollowsTheElasticaFromRoundToFlat) {
  // Unit radius and rigidity; the lumen is 2 but for the wall.
  constexpr double wall = 1e-4;
  const FlatRing ring = FlatRing::of_tube(12 / std::pow(wall, 3), 1, wall);
  EXPECT_NEAR(ring.sample(1e-4, 0).slope, 1e-4 / (pi / 4 - 2 / pi), 1e-7);
  // The elastica used here is that of the ring: small loads, and both kinds meet where the curvature is gone.
  const Pressed small = Pressed::by_curvature(0.99), last = Pressed::by_curvature(1e-9);
  EXPECT_NEAR(small.closing, (pi / 4 - 2 / pi) * small.load, 0.01 * small.closing);
  EXPECT_NEAR(last.closing, 0.564, 1e-3);
  EXPECT_NEAR(Pressed::on_flats(last.closing).load, last.load, 1e-3);
  double worst = 0;
  for (double c : {0.99, 0.9, 0.8, 0.6, 0.4, 0.2, 0.1, 0.03, 1e-3}) {
    const Pressed exact = Pressed::by_curvature(c);
    worst = std::max(worst, std::abs(ring.sample(exact.closing, 0).slope / exact.load - 1));
  }
  for (double closing = 0.6; closing < 1.9; closing += 0.1)
    worst = std::max(worst, std::abs(ring.sample(closing, 0).slope / Pressed::on_flats(closing).load - 1));
  EXPECT_LT(worst, 0.072);
  EXPECT_NEAR(ring.sample(1.9, 0).slope, Pressed::on_flats(1.9).load, 2e-3 * Pressed::on_flats(1.9).load);
}

TEST(FlatRing, SlopeAndBendAreDerivativesAndGrowWithoutBound) {
  const FlatRing ring = duct();
  for (double pressure : {0.0, filled, -0.5 * filled}) {
    double before = 0;
    for (double share : {0.05, 0.2, 0.4, 0.6, 0.8, 0.95}) {
      const double at = share * ring.lumen, h = 1e-5 * ring.lumen;
      const SectionSample s = ring.sample(at, pressure), up = ring.sample(at + h, pressure),
                          down = ring.sample(at - h, pressure);
      EXPECT_NEAR((up.energy - down.energy) / (2 * h), s.slope, 1e-6 * s.slope);
      EXPECT_NEAR((up.slope - down.slope) / (2 * h), s.bend, 1e-6 * s.bend);
      EXPECT_GT(s.slope, before);
      before = s.slope;
    }
  }
  EXPECT_GT(ring.sample(0.999 * ring.lumen, 0).slope, 1e4 * ring.sample(0.2 * ring.lumen, 0).slope);
  EXPECT_EQ(ring.sample(ring.lumen, 0).energy, std::numeric_limits<double>::infinity());
}

TEST(FlatRing, PressureAddsItsWorkOnTheAreaThatTheLumenLoses) {
  const FlatRing ring = duct();
  EXPECT_NEAR(ring.lumen_area(0), pi * std::pow(middle - thickness / 2, 2), 1e-18);
  EXPECT_EQ(ring.lumen_area(ring.lumen), 0);
  for (double share : {0.1, 0.5, 0.9}) {
    const double d = share * ring.lumen;
    const double by_pressure = ring.sample(d, filled).energy - ring.sample(d, 0).energy;
    EXPECT_NEAR(by_pressure, filled * (ring.lumen_area(0) - ring.lumen_area(d)), 1e-12 * by_pressure);
    // The same area by the stadium's flats and round ends, inside of the wall.
    const double height = ring.half_height(d) - thickness,
                 flats = 2 * (ring.half_width(d) - ring.half_height(d));
    EXPECT_NEAR(ring.lumen_area(d), 2 * height * flats + pi * height * height,
                1e-3 * ring.lumen_area(0) * thickness);
  }
}

TEST(FlatRing, StandsUntilItIsSuckedOnAboutAsHardAsARingBuckles) {
  const FlatRing ring = duct();
  const double buckles = 3 * young * std::pow(thickness, 3) / 12 / std::pow(middle, 3);
  EXPECT_TRUE(ring.stands(filled));
  EXPECT_TRUE(ring.stands(-0.8 * buckles));
  EXPECT_FALSE(ring.stands(-buckles));
  // Where it stands, more closing always takes more force.
  for (double share = 0; share < 0.99; share += 0.01)
    EXPECT_GT(ring.sample(share * ring.lumen, -0.8 * buckles).bend, 0);
}

using Law = RodContactLaw<Barrier>;

Law duct_law() { return {duct(), Barrier{0.5e-3, 20e3}, middle}; }

TEST(RodContactLaw, IsNothingOutOfReachAndWithoutBoundAtTheFoldedWall) {
  const Law law = duct_law();
  const double reach = law.ring.outer + law.gap.range;
  EXPECT_EQ(law.sample(reach, filled).section.energy, 0);
  EXPECT_EQ(law.sample(2 * reach, filled).section.slope, 0);
  EXPECT_NEAR(law.ring.folded(), thickness, 1e-18);
  EXPECT_EQ(law.sample(law.ring.folded(), filled).section.energy, std::numeric_limits<double>::infinity());
  double before = 0;
  for (double left : {1e-4, 1e-5, 1e-6, 1e-7}) {
    const double force = -law.sample(law.ring.folded() + left, filled).section.slope;
    EXPECT_TRUE(std::isfinite(force));
    EXPECT_GT(force, 2 * before);
    before = force;
  }
}

TEST(RodContactLaw, SlopeAndBendAreDerivativesAndHaveNoLeap) {
  const Law law = duct_law();
  const double near = law.ring.folded() + 0.02e-3, far = law.ring.outer + law.gap.range;
  for (double pressure : {0.0, filled, -0.5 * filled}) {
    constexpr int steps = 8000;
    const double onset =
        1.01 * 6 * law.width * law.gap.stiffness / std::pow(law.gap.range, 2) * (far - near) / steps;
    EXPECT_LT(onset, 0.2 * law.ring.sample(0, pressure).bend);
    double energy = std::numeric_limits<double>::infinity(), bend = law.sample(near, pressure).section.bend;
    for (int k = 0; k < steps; ++k) {
      const double at = near + (far - near) * k / steps, h = 2e-9;
      const SectionSample s = law.sample(at, pressure).section;
      const SectionSample up = law.sample(at + h, pressure).section,
                          down = law.sample(at - h, pressure).section;
      // Of lengths of 1e-5 m and more: the square of h against that, and rounding by 1 / h.
      const double top = -law.sample(near, pressure).section.slope;
      EXPECT_NEAR((up.energy - down.energy) / (2 * h), s.slope, 1e-5 * -s.slope + 1e-11 * top);
      EXPECT_NEAR((up.slope - down.slope) / (2 * h), s.bend, 1e-5 * s.bend + 1e-7 * top);
      EXPECT_LT(s.energy, energy);
      EXPECT_GE(s.bend, 0);
      // C2: from one place to the next a share of itself, or what a barrier gains where it begins: far less than the ring.
      EXPECT_LT(std::abs(s.bend - bend), 0.15 * std::max(s.bend, bend) + onset) << at;
      energy = s.energy;
      bend = s.bend;
    }
  }
}

TEST(RodContactLaw, TheSectionAndTheGapCarryTheSameForceAndShareTheWay) {
  const Law law = duct_law();
  for (double distance : {2.2e-3, 1.8e-3, 1.4e-3, 0.8e-3, 0.5e-3}) {
    const Law::Sample s = law.sample(distance, filled);
    const double force = -s.section.slope;
    EXPECT_GT(s.gap, 0);
    EXPECT_GT(s.closing, 0);
    EXPECT_NEAR(law.ring.half_height(s.closing) + s.gap, distance, 1e-15);
    EXPECT_NEAR(law.ring.sample(s.closing, filled).slope, force, 1e-9 * force);
    EXPECT_NEAR(-law.width * law.gap.sample(s.gap).derivative, force, 1e-9 * force);
  }
  // Soft while it flattens: a third of the force of a wall that does not give, and far less.
  Law stiff = law;
  stiff.ring.lumen = 0;
  EXPECT_LT(law.sample(1.85e-3, filled).section.slope / stiff.sample(1.85e-3, filled).section.slope, 0.34);
}

TEST(RodContactLaw, ASolidThreadHasTheBarrierAlone) {
  const Law law{FlatRing{.outer = 1e-3}, Barrier{0.5e-3, 20e3}, 1e-3};
  const BarrierSample b = law.gap.sample(0.2e-3);
  const SectionSample s = law.sample(1.2e-3, filled).section;
  EXPECT_NEAR(s.energy, 1e-3 * b.energy, 1e-9 * s.energy);
  EXPECT_NEAR(s.slope, 1e-3 * b.derivative, -1e-9 * s.slope);
  EXPECT_EQ(law.ring.folded(), 1e-3);
  EXPECT_EQ(law.sample(1e-3, filled).section.energy, std::numeric_limits<double>::infinity());
}

TEST(RodContactLaw, ASectionThatDoesNotStandIsNotAdmissible) {
  EXPECT_EQ(duct_law().sample(1.7e-3, -1e4).section.energy, std::numeric_limits<double>::infinity());
  EXPECT_EQ(duct_law().sample(3e-3, -1e4).section.energy, 0) << "unless nothing is near";
}

}  // namespace
}  // namespace ring_test
}  // namespace calot
