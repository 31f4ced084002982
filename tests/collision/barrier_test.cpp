#include "collision/barrier.h"

#include <gtest/gtest.h>

#include <limits>

namespace calot {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

class EachBarrier : public testing::TestWithParam<Barrier> {
 protected:
  const Barrier barrier = GetParam();
};
INSTANTIATE_TEST_SUITE_P(Barrier, EachBarrier,
                         testing::Values(Barrier{}, Barrier{.steep = true},
                                         Barrier{.core = 52.5e-6, .core_stiffness = 400e3}),
                         [](const auto& param) {
                           return param.param.steep      ? "Steep"
                                  : param.param.core > 0 ? "WithACore"
                                                         : "Logarithmic";
                         });

TEST_P(EachBarrier, DerivativesMatchFiniteDifferences) {
  for (double share = 0.02; share < 0.99; share += 0.01) {
    const double d = share * barrier.range, h = 1e-4 * d;
    const BarrierSample at = barrier.sample(d), ahead = barrier.sample(d + h), behind = barrier.sample(d - h);
    // The central difference errs by h^2/6 times the third derivative, up to 1e-7 of the value where the
    // barrier is steep; near the range all vanish together, so the scale is taken from its middle.
    const BarrierSample scale = barrier.sample(barrier.range / 2);
    EXPECT_NEAR(at.derivative, (ahead.energy - behind.energy) / (2 * h),
                1e-6 * std::max(std::abs(at.derivative), std::abs(scale.derivative)));
    EXPECT_NEAR(at.second, (ahead.derivative - behind.derivative) / (2 * h),
                1e-6 * std::max(at.second, scale.second));
  }
}

TEST(Barrier, PressureAtHalfTheRangeIsTheClosedForm) {
  const Barrier barrier;
  // -b'(range/2) = stiffness (ln 2 + 1/2)
  EXPECT_NEAR(-barrier.sample(barrier.range / 2).derivative, barrier.stiffness * (std::log(2.0) + 0.5), 1e-9);
}

TEST(Barrier, ASteepOneHasAsMuchPressureThere) {
  const Barrier steep{.steep = true};
  // -b'(range/2) = 0.6 stiffness (3/2 + 1/2); the plain one has ln 2 + 1/2 = 1.19 of it.
  EXPECT_NEAR(-steep.sample(steep.range / 2).derivative, 1.2 * steep.stiffness, 1e-9);
  const double near = 1e-4 * steep.range;
  EXPECT_NEAR(-steep.sample(near).derivative / (0.6e8 * steep.stiffness), 1, 1e-3);
}

TEST(Barrier, ACoreAddsASteepOneBelowItAndNothingAbove) {
  const Barrier plain, cored{.core = 5e-6, .core_stiffness = 4e6},
      core{.range = cored.core, .stiffness = cored.core_stiffness, .steep = true};
  for (const double d : {5e-6, 8e-6, 0.4e-3}) EXPECT_EQ(cored.sample(d).second, plain.sample(d).second);
  for (const double d : {4.9e-6, 2e-6, 1e-9}) {
    EXPECT_DOUBLE_EQ(cored.sample(d).energy, plain.sample(d).energy + core.sample(d).energy);
    EXPECT_DOUBLE_EQ(cored.sample(d).derivative, plain.sample(d).derivative + core.sample(d).derivative);
    EXPECT_DOUBLE_EQ(cored.sample(d).second, plain.sample(d).second + core.sample(d).second);
  }
  EXPECT_GT(cored.sample(1e-9).energy, 100 * plain.sample(1e-9).energy)
      << "the logarithm alone resists no step";
}

TEST_P(EachBarrier, JoinsZeroSmoothlyToTheSecondDerivative) {
  for (const double beyond : {barrier.range, 1.5 * barrier.range, 1.0, infinity}) {
    EXPECT_EQ(barrier.sample(beyond).energy, 0.0);
    EXPECT_EQ(barrier.sample(beyond).derivative, 0.0);
    EXPECT_EQ(barrier.sample(beyond).second, 0.0);
  }
  // With gap g = range - d the leading term is stiffness / range^2 g^3, 0.6 of it where it is steep: value, slope and
  // curvature vanish as g^3, 3 g^2 and 6 g; the next term is smaller by g / range.
  for (const double share : {1e-2, 1e-3, 1e-4}) {
    const double gap = share * barrier.range,
                 lead = (barrier.steep ? 0.6 : 1.0) * barrier.stiffness / barrier.range / barrier.range;
    const BarrierSample near = barrier.sample(barrier.range - gap);
    EXPECT_NEAR(near.energy / (lead * gap * gap * gap), 1.0, 2 * share);
    EXPECT_NEAR(near.derivative / (-3 * lead * gap * gap), 1.0, 2 * share);
    EXPECT_NEAR(near.second / (6 * lead * gap), 1.0, barrier.steep ? 4 * share : 2 * share);
  }
}

TEST_P(EachBarrier, PushesHarderTheCloserWithoutBound) {
  BarrierSample before = barrier.sample(0.999 * barrier.range);
  for (double d = 0.99 * barrier.range; d > 1e-15; d *= 0.9) {
    const BarrierSample now = barrier.sample(d);
    EXPECT_GT(now.energy, before.energy);
    EXPECT_LT(now.derivative, before.derivative);
    EXPECT_GT(now.second, before.second);
    before = now;
  }
  EXPECT_GT(-before.derivative, 1e9 * barrier.stiffness);
}

TEST(Barrier, WithASoftShareGoesOnSmoothlyAndPushesOutFromInside) {
  const Barrier hard, soft{.soft_share = 0.1};
  const double start = soft.soft_share * soft.range, h = 1e-6 * soft.range;
  for (double d = start; d < 1.1 * soft.range; d += 0.01 * soft.range) {
    EXPECT_EQ(soft.sample(d).energy, hard.sample(d).energy);
    EXPECT_EQ(soft.sample(d).second, hard.sample(d).second);
  }
  for (double d = start - h; d > -10 * soft.range; d -= 0.1 * soft.range) {
    const BarrierSample at = soft.sample(d), ahead = soft.sample(d + h / 2), behind = soft.sample(d - h / 2);
    // A parabola's central differences are exact, to the rounding of energies.
    EXPECT_NEAR((ahead.energy - behind.energy) / h / at.derivative, 1, 1e-8);
    EXPECT_NEAR((ahead.derivative - behind.derivative) / h / at.second, 1, 1e-8);
    EXPECT_EQ(at.second, hard.sample(start).second);
  }
  EXPECT_NEAR(soft.sample(start - h).derivative / hard.sample(start).derivative, 1, 1e-4);
  EXPECT_NEAR(soft.sample(start - h).energy / hard.sample(start).energy, 1, 1e-4);
}

TEST(Barrier, IsInfiniteAtTouchAndInside) {
  for (const double d : {0.0, -1e-6, -infinity}) {
    const BarrierSample at = Barrier{}.sample(d);
    EXPECT_EQ(at.energy, infinity);
    EXPECT_EQ(at.derivative, -infinity);
    EXPECT_EQ(at.second, infinity);
  }
}

}  // namespace
}  // namespace calot
