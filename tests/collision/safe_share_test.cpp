#include <gtest/gtest.h>

#include <limits>

#include "collision/barrier.h"
#include "collision/random_shapes.h"

namespace calot {
namespace {

using test::random_direction;
using test::random_shapes;
using test::random_vector;

constexpr double keep = 0.1;

auto at_rest(const Shape& shape) {
  return [shape](double) { return shape; };
}

/// An even screw motion about the origin.
struct Screw {
  Vec3 travel = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
  double angle = 0;
  Pose at(double share) const {
    return Eigen::Translation3d(share * travel) * Eigen::AngleAxisd(share * angle, axis);
  }
  /// Each point keeps its distance from the axis, so its speed is at most this.
  double speed_bound(const Shape& shape) const {
    if (std::holds_alternative<Plane>(shape)) return travel.norm();
    const Bounds box = bounds(shape);
    return travel.norm() + std::abs(angle) * box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs()).norm();
  }
};

/// Smallest distance over a dense sampling of the motion up to `share`.
double least_distance(const Vec3& x, const Vec3& motion, const std::function<Shape(double)>& shape_at,
                      double share) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 300; ++i) {
    const double s = share * i / 300;
    least = std::min(least, signed_distance(shape_at(s), x + s * motion));
  }
  return least;
}

TEST(SafeShare, NeverComesNearerThanPromisedToAMovingShape) {
  Rng rng(1);
  int stopped = 0, passed = 0;
  for (int trial = 0; trial < 1500; ++trial)
    for (const Shape& shape : random_shapes(rng)) {
      Screw screw{random_vector(rng, 20e-3), random_direction(rng), rng.uniform(-2.0, 2.0)};
      if (std::holds_alternative<Plane>(shape)) screw.angle = 0;  // an endless plane turns endlessly fast
      const auto shape_at = [&](double s) { return moved(shape, screw.at(s)); };
      const Vec3 x = random_vector(rng, 15e-3), motion = random_vector(rng, 30e-3);
      const double before = signed_distance(shape, x);
      const double share = safe_share(x, motion, shape_at, screw.speed_bound(shape), keep);
      ASSERT_GE(share, 0.0);
      ASSERT_LE(share, 1.0);
      if (before <= 0) {
        EXPECT_EQ(share, 0.0);
        continue;
      }
      EXPECT_GT(share, 0.0);
      ++(share < 1 ? stopped : passed);
      EXPECT_GE(least_distance(x, motion, shape_at, share),
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
      const double share = safe_share(x, motion, at_rest(shape), 0, keep);
      const double after = signed_distance(shape, x + share * motion);
      EXPECT_GE(least_distance(x, motion, at_rest(shape), share), keep * before - 1e-15);
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
  const double share = safe_share(from, shot, at_rest(sheet), 0, keep);
  EXPECT_NEAR(signed_distance(sheet, from + share * shot), keep * signed_distance(sheet, from), 1e-9);
}

TEST(SafeShare, AThinBoxSweptOverAPointStopsBeforeIt) {
  const RoundedBox sheet{Pose::Identity(), {20e-3, 20e-3, 0.01e-3}, 0.01e-3};
  const Vec3 x(1e-3, 2e-3, 30e-3);
  const Screw rise{{0, 0, 1.0}, Vec3::UnitZ(), 0};
  const auto shape_at = [&](double s) { return moved(sheet, rise.at(s)); };
  const double share = safe_share(x, Vec3::Zero(), shape_at, rise.speed_bound(sheet), keep);
  EXPECT_NEAR(signed_distance(shape_at(share), x), keep * signed_distance(sheet, x), 1e-9);
}

TEST(SafeShare, SlidingAlongAPlaneOrLeavingAShapeIsFree) {
  Rng rng(3);
  for (int trial = 0; trial < 100; ++trial) {
    const Plane plane{Vec3::Zero(), Vec3::UnitZ()};
    Vec3 slide = random_vector(rng, 100e-3);
    slide.z() = 0;
    EXPECT_EQ(safe_share({0, 0, 1e-9}, slide, at_rest(plane), 0, keep), 1.0);
    for (const Shape& shape : random_shapes(rng)) {
      const Vec3 x = random_vector(rng, 15e-3);
      const DistanceSample at = sample_distance(shape, x);
      if (at.distance <= 0) continue;
      EXPECT_EQ(safe_share(x, 50e-3 * at.gradient, at_rest(shape), 0, keep), 1.0);
    }
  }
}

TEST(SafeShare, APointCarriedAlongByItsShapeGoesAllTheWay) {
  // A fold between jaws: 0.1 mm away, moved 2 mm with the jaw in any direction.
  Rng rng(4);
  for (int trial = 0; trial < 200; ++trial) {
    const RoundedBox box = test::random_box(rng);
    const Vec3 start = box.pose * Vec3(0, 0, box.half.z() + box.radius + 0.1e-3);
    const Screw carry{2e-3 * random_direction(rng), Vec3::UnitZ(), 0};
    const auto shape_at = [&](double s) { return moved(box, carry.at(s)); };
    EXPECT_EQ(safe_share(start, carry.travel, shape_at, carry.speed_bound(box), keep), 1.0);
  }
}

TEST(SafeShare, IsZeroInsideAndForWhatIsNoNumber) {
  const Capsule capsule{{0, 0, 0}, {10e-3, 0, 0}, 2e-3};
  EXPECT_EQ(safe_share({5e-3, 1e-3, 0}, {0, 1, 0}, at_rest(capsule), 0, keep), 0.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(safe_share({nan, 0, 0}, {0, 1, 0}, at_rest(capsule), 0, keep), 0.0);
  EXPECT_EQ(safe_share({5e-3, 5e-3, 0}, {0, nan, 0}, at_rest(capsule), 0, keep), 0.0);
}

}  // namespace
}  // namespace calot
