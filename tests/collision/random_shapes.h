#pragma once
// Shapes of an instrument's size in random attitudes, and points around them.

#include "collision/shapes.h"
#include "support/random.h"

namespace calot::test {

struct DistanceSample {
  double distance = 0;
  Vec3 gradient = Vec3::Zero();
  Mat3 hessian = Mat3::Zero();
};
inline DistanceSample sample_distance(const Shape& shape, const Vec3& x) {
  const DistanceSlope at = distance_slope(shape, x);
  return {at.distance, at.gradient, distance_hessian(shape, x, at)};
}

inline Vec3 random_direction(Rng& rng) {
  Vec3 v = random_vector(rng, 1.0);
  while (v.norm() < 0.1 || v.norm() > 1.0) v = random_vector(rng, 1.0);
  return v.normalized();
}

inline Pose random_pose(Rng& rng, double reach) {
  return Eigen::Translation3d(random_vector(rng, reach)) *
         Eigen::AngleAxisd(rng.uniform(-3.0, 3.0), random_direction(rng));
}

inline Plane random_plane(Rng& rng) { return {random_vector(rng, 10e-3), random_direction(rng)}; }

inline Capsule random_capsule(Rng& rng) {
  return {random_vector(rng, 10e-3), random_vector(rng, 10e-3), rng.uniform(1e-3, 4e-3)};
}

inline RoundedBox random_box(Rng& rng) {
  const Vec3 half(rng.uniform(0.1e-3, 2e-3), rng.uniform(1e-3, 4e-3), rng.uniform(3e-3, 10e-3));
  return {random_pose(rng, 10e-3), half, rng.uniform(0.3e-3, 2e-3)};
}

/// One of each kind.
inline std::vector<Shape> random_shapes(Rng& rng) {
  return {random_plane(rng), random_capsule(rng), random_box(rng)};
}

/// The shape moved rigidly by `motion` (world to world).
inline Shape moved(const Shape& shape, const Pose& motion) {
  if (const auto* plane = std::get_if<Plane>(&shape))
    return Plane{motion * plane->point, motion.linear() * plane->normal};
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return Capsule{motion * capsule->a, motion * capsule->b, capsule->radius};
  RoundedBox box = std::get<RoundedBox>(shape);
  box.pose = motion * box.pose;
  return box;
}

}  // namespace calot::test
