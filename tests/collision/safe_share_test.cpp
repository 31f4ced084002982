#include <gtest/gtest.h>

#include <limits>

#include "collision/barrier.h"
#include "collision/random_shapes.h"

namespace calot {
namespace {

using test::random_shapes;
using test::random_vector;

constexpr double keep = 0.1;

/// Smallest distance over a dense sampling of the motion up to `share`.
double least_distance(const Vec3& x, const Vec3& motion, const Shape& shape, double share) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 300; ++i) {
    const double s = share * i / 300;
    least = std::min(least, signed_distance(shape, x + s * motion));
  }
  return least;
}

TEST(SafeShare, NeverComesNearerThanPromised) {
  Rng rng(1);
  int stopped = 0, passed = 0;
  for (int trial = 0; trial < 1500; ++trial)
    for (const Shape& shape : random_shapes(rng)) {
      const Vec3 x = random_vector(rng, 15e-3), motion = random_vector(rng, 30e-3);
      const double before = signed_distance(shape, x);
      const double share = safe_share(x, motion, shape, keep);
      ASSERT_GE(share, 0.0);
      ASSERT_LE(share, 1.0);
      if (before <= 0) {
        EXPECT_EQ(share, 0.0);
        continue;
      }
      EXPECT_GT(share, 0.0);
      ++(share < 1 ? stopped : passed);
      EXPECT_GE(least_distance(x, motion, shape, share),
                keep * before - 1e-15);  // rounding of coordinates
    }
  EXPECT_GT(stopped, 100);
  EXPECT_GT(passed, 100);
}

TEST(SafeShare, StopsNoEarlierThanItMustBeforeAShapeAtRest) {
  Rng rng(2);
  for (int trial = 0; trial < 1500; ++trial)
    for (const Shape& shape : random_shapes(rng)) {
      const Vec3 x = random_vector(rng, 15e-3), motion = random_vector(rng, 30e-3);
      const double before = signed_distance(shape, x);
      if (before <= 0) continue;
      const double share = safe_share(x, motion, shape, keep);
      const double after = signed_distance(shape, x + share * motion);
      EXPECT_GE(least_distance(x, motion, shape, share), keep * before - 1e-15);
      // The last step is a share below 1e-9, so at most that part of the motion's length is left.
      if (share < 1) {
        EXPECT_LE(after, keep * before + 1e-9 * motion.norm());
      }
    }
}

TEST(SafeShare, AFastPointStopsBeforeAThinBox) {
  const RoundedBox sheet{Pose::Identity(), {20e-3, 20e-3, 0.01e-3}, 0.01e-3};
  const Vec3 from(1e-3, 2e-3, 30e-3), shot(0, 0, -1.0);
  EXPECT_GT(signed_distance(sheet, from + shot), 0.0);  // it would be out on the other side
  const double share = safe_share(from, shot, sheet, keep);
  EXPECT_NEAR(signed_distance(sheet, from + share * shot), keep * signed_distance(sheet, from), 1e-9);
}

TEST(SafeShare, SlidingAlongAPlaneOrLeavingAShapeIsFree) {
  Rng rng(3);
  for (int trial = 0; trial < 100; ++trial) {
    const Plane plane{Vec3::Zero(), Vec3::UnitZ()};
    Vec3 slide = random_vector(rng, 100e-3);
    slide.z() = 0;
    EXPECT_EQ(safe_share({0, 0, 1e-9}, slide, plane, keep), 1.0);
    for (const Shape& shape : random_shapes(rng)) {
      const Vec3 x = random_vector(rng, 15e-3);
      const test::DistanceSample at = test::sample_distance(shape, x);
      if (at.distance <= 0) continue;
      EXPECT_EQ(safe_share(x, 50e-3 * at.gradient, shape, keep), 1.0);
    }
  }
}

TEST(SafeShare, IsZeroInsideAndForWhatIsNoNumber) {
  const Capsule capsule{{0, 0, 0}, {10e-3, 0, 0}, 2e-3};
  EXPECT_EQ(safe_share({5e-3, 1e-3, 0}, {0, 1, 0}, capsule, keep), 0.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(safe_share({nan, 0, 0}, {0, 1, 0}, capsule, keep), 0.0);
  EXPECT_EQ(safe_share({5e-3, 5e-3, 0}, {0, nan, 0}, capsule, keep), 0.0);
}

}  // namespace
}  // namespace calot
