#include "collision/shapes.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "collision/random_shapes.h"

namespace calot::shapes_test {
namespace {

using test::DistanceSample;
using test::random_box;
using test::random_capsule;
using test::random_pose;
using test::random_shapes;
using test::random_vector;
using test::sample_distance;

constexpr double step = 1e-7;  // m, of finite differences; the shapes measure millimetres

/// Which smooth piece of the distance a point belongs to: the pieces meet with a kink in the second
/// derivative.
int region(const Capsule& capsule, const Vec3& x) {
  const Vec3 axis = capsule.b - capsule.a;
  const double along = (x - capsule.a).dot(axis) / axis.squaredNorm();
  return along < 0 ? 0 : along > 1 ? 1 : 2;
}

int region(const RoundedBox& box, const Vec3& x) {
  const Vec3 local = box.pose.inverse() * x;
  const Vec3 beyond = local.cwiseAbs() - box.half;
  int index = 0;  // three states an axis: below, within, above
  for (int axis = 0; axis < 3; ++axis) index = 3 * index + (beyond[axis] <= 0 ? 1 : local[axis] < 0 ? 0 : 2);
  int nearest_face = 0;
  beyond.maxCoeff(&nearest_face);
  return index == 13 ? 100 + 2 * nearest_face + (local[nearest_face] < 0 ? 1 : 0) : index;
}

int axes_beyond(const RoundedBox& box, const Vec3& x) {
  return static_cast<int>(((box.pose.inverse() * x).cwiseAbs().array() > box.half.array()).count());
}

template <class Solid>
bool same_region_around(const Solid& solid, const Vec3& x) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      if (region(solid, x + side * step * Vec3::Unit(axis)) != region(solid, x)) return false;
  return true;
}

/// Gradient and Hessian against central differences of the distance and of the gradient. Those err by step^2
/// times derivatives of order 1 / r^2 (gradient) and 1 / r^3 (Hessian): with r >= 0.1 mm by 1e-6 and 1e-6 /
/// r.
void expect_derivatives(const Shape& shape, const Vec3& x, double r) {
  const DistanceSample at = sample_distance(shape, x);
  EXPECT_EQ(at.distance, signed_distance(shape, x));
  EXPECT_NEAR(at.gradient.norm(), 1.0, 1e-12);  // rounding
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 h = step * Vec3::Unit(axis);
    const double slope = (signed_distance(shape, x + h) - signed_distance(shape, x - h)) / (2 * step);
    EXPECT_NEAR(at.gradient[axis], slope, 1e-5);
    const Vec3 curve =
        (sample_distance(shape, x + h).gradient - sample_distance(shape, x - h).gradient) / (2 * step);
    EXPECT_LT((at.hessian.col(axis) - curve).norm(), 1e-4 / r) << "axis " << axis;
  }
  EXPECT_LT((at.hessian - at.hessian.transpose()).norm(), 1e-12 / r);
}

TEST(Shapes, CapsuleDerivativesMatchFiniteDifferencesOnSideAndBothEnds) {
  Rng rng(1);
  std::map<int, int> seen;
  for (int trial = 0; trial < 2000; ++trial) {
    const Capsule capsule = random_capsule(rng);
    const Vec3 x = random_vector(rng, 15e-3);
    const double r = signed_distance(capsule, x) + capsule.radius;
    if (r < 0.1e-3 || !same_region_around(capsule, x)) continue;
    ++seen[region(capsule, x)];
    expect_derivatives(capsule, x, r);
    // A cylinder is curved across one direction, a ball across two: the Hessian's trace says so.
    const double curvatures = region(capsule, x) == 2 ? 1.0 : 2.0;
    EXPECT_NEAR(sample_distance(capsule, x).hessian.trace() * r, curvatures, 1e-9);
  }
  EXPECT_EQ(seen.size(), 3u);
}

TEST(Shapes, BoxDerivativesMatchFiniteDifferencesOnEveryFaceEdgeCornerAndInside) {
  Rng rng(2);
  std::map<int, int> seen;
  for (int trial = 0; trial < 6000; ++trial) {
    const RoundedBox box = random_box(rng);
    const Vec3 reach = box.half + Vec3::Constant(2e-3);
    const Vec3 x = box.pose * random_vector(rng, 1.0).cwiseProduct(reach);
    const int piece = region(box, x);
    const double r = piece >= 100 ? box.radius : signed_distance(box, x) + box.radius;
    if (r < 0.1e-3 || !same_region_around(box, x)) continue;
    ++seen[piece];
    expect_derivatives(box, x, r);
    // Face, edge and corner are curved across none, one and two directions.
    const double curvatures = std::max(0, axes_beyond(box, x) - 1);
    EXPECT_NEAR(sample_distance(box, x).hessian.trace() * r, curvatures, 1e-9) << "piece " << piece;
  }
  EXPECT_EQ(seen.size(),
            32u);  // 6 faces + 12 edges + 8 corners outside the inner box, 6 nearest faces inside it
}

TEST(Shapes, PlaneDistanceIsLinear) {
  Rng rng(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Plane plane = test::random_plane(rng);
    const Vec3 x = random_vector(rng, 10e-3);
    expect_derivatives(plane, x, 1.0);
    EXPECT_EQ(sample_distance(plane, x).hessian, Mat3::Zero());
    EXPECT_NEAR(signed_distance(plane, plane.point + 3e-3 * plane.normal), 3e-3, 1e-15);
  }
}

TEST(Shapes, DistanceIsThatOfTheNearestSampledPoint) {
  // Both solids are all points within a radius of a core, so the distance is that to the core less the
  // radius. A grid over the core overestimates it by at most the grid's half diagonal.
  Rng rng(4);
  constexpr int n = 40;
  for (int trial = 0; trial < 30; ++trial) {
    const Capsule capsule = random_capsule(rng);
    const RoundedBox box = random_box(rng);
    const Vec3 x = random_vector(rng, 20e-3);
    double to_segment = 1, to_box = 1;
    for (int i = 0; i <= n; ++i) {
      to_segment = std::min(to_segment, (x - capsule.a - (capsule.b - capsule.a) * i / n).norm());
      for (int j = 0; j <= n; ++j)
        for (int k = 0; k <= n; ++k) {
          const Vec3 share = 2.0 * Vec3(i, j, k) / n - Vec3::Ones();
          to_box = std::min(to_box, (x - box.pose * share.cwiseProduct(box.half)).norm());
        }
    }
    const double segment_error = to_segment - capsule.radius - signed_distance(capsule, x);
    EXPECT_GE(segment_error, -1e-15);
    EXPECT_LE(segment_error, (capsule.b - capsule.a).norm() / n / 2);
    if (signed_distance(box, x) <= -box.radius) continue;  // in the inner box itself
    const double box_error = to_box - box.radius - signed_distance(box, x);
    EXPECT_GE(box_error, -1e-15);
    EXPECT_LE(box_error, box.half.norm() / n);
  }
}

TEST(Shapes, SteppingBackAlongTheGradientLandsOnTheSurface) {
  Rng rng(5);
  for (int trial = 0; trial < 1000; ++trial)
    for (const Shape& shape : random_shapes(rng)) {
      const Vec3 x = random_vector(rng, 15e-3);
      const DistanceSample at = sample_distance(shape, x);
      EXPECT_NEAR(signed_distance(shape, x - at.distance * at.gradient), 0.0, 1e-14);  // rounding at 15 mm
    }
}

TEST(Shapes, DistanceIsConvexAndNeverSteeperThanOne) {
  Rng rng(6);
  for (int trial = 0; trial < 2000; ++trial)
    for (const Shape& shape : random_shapes(rng)) {
      const Vec3 x = random_vector(rng, 15e-3), y = random_vector(rng, 15e-3);
      const DistanceSample at = sample_distance(shape, x);
      const double there = signed_distance(shape, y);
      EXPECT_LE(std::abs(there - at.distance), (y - x).norm() + 1e-15);
      EXPECT_GE(there, at.distance + at.gradient.dot(y - x) - 1e-15);  // what safe_share rests on
    }
}

TEST(Shapes, MovingShapeAndPointTogetherChangesNothing) {
  Rng rng(7);
  for (int trial = 0; trial < 200; ++trial)
    for (const Shape& shape : random_shapes(rng)) {
      const Pose motion = random_pose(rng, 50e-3);
      const Vec3 x = random_vector(rng, 15e-3);
      const DistanceSample before = sample_distance(shape, x);
      const DistanceSample after = sample_distance(test::moved(shape, motion), motion * x);
      const Mat3 turned = motion.linear() * before.hessian * motion.linear().transpose();
      EXPECT_NEAR(after.distance, before.distance, 1e-15);
      // Rounding of 60 mm coordinates (1e-17 m) against an axis distance r turns the gradient by 1e-17 / r.
      const double r = before.hessian.norm() > 0 ? 1 / before.hessian.norm() : 1.0;
      EXPECT_LT((after.gradient - motion.linear() * before.gradient).norm(), 1e-14 + 1e-15 / r);
      EXPECT_LT((after.hessian - turned).norm() * r, 1e-12 + 1e-14 / r);
    }
}

TEST(Shapes, NoDistanceChangesMoreThanTheBoundWhenAShapeMovesAndSomeNearlySo) {
  Rng rng(17);
  double tightest = 0;
  for (int trial = 0; trial < 300; ++trial)
    for (const Shape& shape : random_shapes(rng)) {
      if (std::holds_alternative<Plane>(shape)) continue;
      const Shape after = test::moved(shape, random_pose(rng, 3e-3));
      const double bound = distance_change(shape, after);
      for (int k = 0; k < 30; ++k) {
        const Vec3 x = random_vector(rng, 30e-3);
        const double change = std::abs(signed_distance(after, x) - signed_distance(shape, x));
        EXPECT_LE(change, bound + 1e-15);
        tightest = std::max(tightest, change / bound);
      }
    }
  EXPECT_GT(tightest, 0.95);
  const Plane plane{Vec3::Zero(), Vec3::UnitZ()};
  EXPECT_EQ(distance_change(plane, plane), 0.0);
  EXPECT_EQ(distance_change(plane, Plane{Vec3::UnitZ(), Vec3::UnitZ()}),
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(distance_change(plane, Capsule{}), std::numeric_limits<double>::infinity());
}

TEST(Shapes, BoundsEncloseTheShapeAndTouchItOnEverySide) {
  Rng rng(8);
  for (int trial = 0; trial < 50; ++trial)
    for (const Shape& shape : {Shape(random_capsule(rng)), Shape(random_box(rng))}) {
      const Bounds box = bounds(shape);
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
          // From far away the nearest point of the solid is its furthest point that way, to size^2 /
          // distance.
          constexpr double far = 1e3;
          const Vec3 from = side * far * Vec3::Unit(axis);
          const double furthest = side * (far - signed_distance(shape, from));
          EXPECT_NEAR(side < 0 ? box.lower[axis] : box.upper[axis], furthest, 1e-6);
        }
    }
  const Bounds everywhere = bounds(Plane{});
  EXPECT_EQ(everywhere.lower, -Vec3::Constant(std::numeric_limits<double>::infinity()));
  EXPECT_EQ(everywhere.upper, Vec3::Constant(std::numeric_limits<double>::infinity()));
}

TEST(Shapes, PlacesWithoutADirectionOutwardStayFinite) {
  const Capsule capsule{{0, 0, 0}, {10e-3, 0, 0}, 2e-3}, ball{{1e-3, 0, 0}, {1e-3, 0, 0}, 2e-3};
  const RoundedBox box{Pose::Identity(), {1e-3, 2e-3, 3e-3}, 0.5e-3},
      dot{Pose::Identity(), Vec3::Zero(), 0.5e-3};
  const Vec3 tiny = Vec3::Constant(1e-200);
  const std::vector<std::pair<Shape, Vec3>> places = {
      {capsule, {5e-3, 0, 0}}, {capsule, {0, 0, 0}}, {capsule, {10e-3, 0, 0}}, {ball, {1e-3, 0, 0}},
      {box, {0, 0, 0}},        {box, box.half},      {dot, {0, 0, 0}},         {dot, tiny}};
  for (const auto& [shape, x] : places) {
    const DistanceSample at = sample_distance(shape, x);
    EXPECT_TRUE(std::isfinite(at.distance));
    EXPECT_LT(at.distance, 0.0);
    EXPECT_NEAR(at.gradient.norm(), 1.0, 1e-12);
    EXPECT_TRUE(at.hessian.allFinite());
  }
}

TEST(Offset, ChangesTheDistanceByAsMuchEverywhere) {
  Rng rng(21);
  int inside = 0;
  for (int trial = 0; trial < 300; ++trial)
    for (const Shape& shape : random_shapes(rng))
      for (double by : {0.2e-3, -0.2e-3}) {
        const Vec3 x = random_vector(rng, 15e-3);
        inside += signed_distance(shape, x) < 0;
        EXPECT_NEAR(signed_distance(offset(shape, by), x), signed_distance(shape, x) - by, 1e-16);
      }
  EXPECT_GT(inside, 50);
}

}  // namespace
}  // namespace calot::shapes_test
