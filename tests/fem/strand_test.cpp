#include "fem/strand.h"

#include <gtest/gtest.h>

#include "support/derivatives.h"

namespace calot {
namespace {

Strand strand(StrandLaw::Setup setup = {}) { return {StrandLaw::create(setup).value()}; }

/// Bent at its node, as a hook bends it, `way` long in all.
StrandVector bent(const Strand& of, double way) {
  StrandVector places;
  places << 1e-3, -2e-3, 0.5e-3, 1.2e-3, -1.1e-3, 1.4e-3, 1.3e-3, 0.2e-3, 0.7e-3;
  return places * (way / of.way(places));
}

double way_at(const StrandLaw& law, double strain) { return law.setup().taut + strain * law.setup().length; }

struct Case {
  const char* what;
  double strain, opened, delay, stiffening;
};

class StrandDerivatives : public testing::TestWithParam<Case> {};

TEST_P(StrandDerivatives, AreTheEnergys) {
  const Case& c = GetParam();
  StrandLaw::Setup setup;
  setup.stiffening = c.stiffening;
  setup.break_energy = 8e-4;
  const Strand one = strand(setup);
  const StrandPast past{c.opened, c.delay};
  const StrandVector places = bent(one, way_at(one.law, c.strain));
  const auto value = [&](const VecX& x) { return one.value(x, past); };
  const auto gradient = [&](const VecX& x) -> VecX { return one.gradient(x, past); };
  const VecX exact = one.gradient(places, past);
  EXPECT_GT(exact.norm(), 1e-5) << c.what;
  // Third derivatives are of the order of the second ones over the switch's 60 um.
  EXPECT_LT(test::relative_error(exact, test::difference_gradient(value, places, 1e-8)), 1e-5) << c.what;
  const StrandMatrix hessian = one.hessian(places, past);
  EXPECT_LT(test::relative_error(hessian, test::difference_hessian(gradient, places, 1e-8)), 1e-5) << c.what;
  EXPECT_LT(test::relative_error(hessian, hessian.transpose()), 1e-14) << c.what;
}

INSTANTIATE_TEST_SUITE_P(
    , StrandDerivatives,
    testing::Values(Case{"slack", -0.2, 0, 0, 1.5}, Case{"becoming taut", 0.01, 0, 0, 1.5},
                    Case{"stiffening", 0.7, 0, 0, 1.5}, Case{"without stiffening", 0.7, 0, 0, 0},
                    Case{"tearing", 1.6, 0, 0, 1.5}, Case{"tearing as time passes", 1.6, 0, 0.25, 1.5},
                    Case{"tearing on", 1.9, 1.6, 0.25, 1.5}, Case{"relaxed after", 1.2, 1.6, 0.25, 1.5},
                    Case{"parting now", 9, 1.6, 0.25, 1.5}, Case{"torn", 9, 9, 0.25, 1.5}),
    [](const auto& one) {
      std::string name = one.param.what;
      for (char& c : name) c = c == ' ' ? '_' : c;
      return name;
    });

TEST(StrandLaw, ResistsTautUpToItsStrengthAndThenNoMore) {
  const StrandLaw law = strand().law;
  const StrandLaw::Setup& setup = law.setup();
  const auto tension = [&](double strain) { return law.sample(way_at(law, strain), {}).tension; };
  EXPECT_LT(tension(-0.3), 1e-6 * setup.strength);
  // Well beyond the switch as if it were sharp.
  const double taut = 0.5;
  EXPECT_NEAR(tension(taut), setup.stiffness * std::expm1(setup.stiffening * taut) / setup.stiffening,
              1e-6 * setup.strength);
  EXPECT_NEAR(tension(law.peak()), setup.strength, 1e-9 * setup.strength);
  EXPECT_NEAR(tension(law.peak() + 0.5 * law.tail()), 0.5 * setup.strength, 1e-9 * setup.strength);
  EXPECT_NEAR(tension(law.peak() + law.tail()), 0, 1e-12 * setup.strength);
  EXPECT_EQ(tension(10), 0);
}

TEST(StrandLaw, TheAreaUnderItsCurveIsItsBreakEnergy) {
  for (double length : {0.5e-3, 2e-3, 4e-3}) {
    StrandLaw::Setup setup;
    setup.length = setup.taut = length;
    setup.taut += 2e-3;  // what of its way lies within a body is not stretched
    const StrandLaw law = strand(setup).law;
    const double from = way_at(law, -1), to = way_at(law, law.peak() + law.tail() + 0.1);
    constexpr int parts = 20000;
    double area = 0;
    for (int k = 0; k < parts; ++k)
      area += law.sample(from + (k + 0.5) * (to - from) / parts, {}).tension * (to - from) / parts;
    EXPECT_NEAR(area, setup.break_energy, 1e-5 * setup.break_energy);
    EXPECT_NEAR(law.sample(to, {}).energy - law.sample(from, {}).energy, setup.break_energy,
                1e-5 * setup.break_energy);
  }
}

TEST(StrandLaw, TornInOneStepOrInManyItTakesTheSameEnergy) {
  const StrandLaw law = strand().law;
  const double end = law.peak() + law.tail() + 0.01;
  for (int steps : {1, 7, 300}) {
    double opened = 0, work = 0, strain = -0.5;
    for (int k = 1; k <= steps; ++k) {
      const double next = -0.5 + k * (end + 0.5) / steps;
      const StrandPast past{opened, 0};
      work += law.sample(way_at(law, next), past).energy - law.sample(way_at(law, strain), past).energy;
      strain = next;
      opened = std::max(opened, strain);
    }
    EXPECT_NEAR(work, law.setup().break_energy, 1e-6 * law.setup().break_energy) << steps;
    EXPECT_TRUE(law.torn(opened));
  }
}

TEST(StrandLaw, WhatWasTornStaysTorn) {
  const StrandLaw law = strand().law;
  const double half = law.peak() + 0.5 * law.tail();
  const StrandPast past{half, 0};
  const auto tension = [&](double strain) { return law.sample(way_at(law, strain), past).tension; };
  EXPECT_NEAR(tension(half), 0.5 * law.setup().strength, 1e-9);
  // Relaxed it follows the elastic curve less its damage, not the way it came.
  const double whole = law.sample(way_at(law, 0.5), {}).tension;
  EXPECT_NEAR(tension(0.5), (1 - law.damage(half)) * whole, 1e-12);
  EXPECT_LT(tension(0.5), 0.5 * whole);
  EXPECT_GT(tension(0.5), 0);
}

TEST(StrandLaw, TornQuicklyItResistsMoreByItsDelayAlone) {
  const StrandLaw law = strand().law;
  const double from = law.peak() + 0.2 * law.tail(), to = law.peak() + 0.5 * law.tail();
  const double rate = 0.3 * law.tail() / 0.02;  // in 20 ms
  const double slow = law.sample(way_at(law, to), {from, 0}).tension,
               quick = law.sample(way_at(law, to), {from, tearing_delay / 0.02}).tension;
  EXPECT_NEAR(quick / slow, 1 + tearing_delay * rate / law.tail(), 1e-12);
  // What does not tear is not slowed.
  EXPECT_EQ(law.sample(way_at(law, 0.5), {0, 0.25}).tension, law.sample(way_at(law, 0.5), {}).tension);
}

TEST(StrandLaw, ABreakEnergyTooSmallForItsStrengthIsRefused) {
  StrandLaw::Setup setup;
  setup.break_energy = 0.99 * StrandLaw::least_break_energy(setup);
  const Result<StrandLaw> brittle = StrandLaw::create(setup);
  ASSERT_FALSE(brittle);
  EXPECT_NE(to_text(brittle.failure()).find("takes at least"), std::string::npos);
  setup.break_energy = StrandLaw::least_break_energy(setup);
  ASSERT_TRUE(StrandLaw::create(setup));
  EXPECT_NEAR(StrandLaw::create(setup).value().tail(), least_tail, 1e-9);
}

TEST(Strand, AHookUnderItFeelsBothHalvesPull) {
  const Strand one = strand();
  StrandVector places = bent(one, way_at(one.law, 0.6));
  const double tension = one.tension(places, {});
  EXPECT_GT(tension, 0.1 * one.law.setup().strength);
  const Vec3 a = places.head<3>(), m = places.segment<3>(3), b = places.tail<3>();
  const Vec3 pulls = tension * ((a - m).normalized() + (b - m).normalized());
  const Vec3 felt = -one.gradient(places, {}).segment<3>(3);
  EXPECT_NEAR((felt - pulls).norm(), 0, 0.02 * pulls.norm());  // but for centring
  EXPECT_GT(pulls.norm(), 0.1 * tension);
}

TEST(Strand, TornItHangsAtItsFirstPlaceAndPullsOnNothing) {
  const Strand one = strand();
  StrandVector places = bent(one, way_at(one.law, 9));
  places.segment<3>(3) = places.head<3>();
  EXPECT_EQ(one.gradient(places, {9, 0}).norm(), 0);
  EXPECT_GT(one.hessian(places, {9, 0}).block(3, 3, 3, 3).determinant(), 0);
}

}  // namespace
}  // namespace calot
