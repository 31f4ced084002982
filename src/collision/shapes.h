#pragma once
// Rigid shapes with signed distance, gradient and Hessian side by side. "Distance" is never squared.

#include <variant>

#include "geometry/types.h"

namespace calot {

/// Half space: solid where normal . (x - point) < 0.
struct Plane {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< unit
  bool operator==(const Plane&) const = default;
};

/// Ball swept along a segment.
struct Capsule {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();  ///< m
  double radius = 0;                        ///< m
  bool operator==(const Capsule&) const = default;
};

/// Box grown by a radius: an instrument's jaw. `half` are the half extents of the inner box.
struct RoundedBox {
  Pose pose = Pose::Identity();  ///< box frame to world
  Vec3 half = Vec3::Zero();      ///< m
  double radius = 0;             ///< m, > 0
  bool operator==(const RoundedBox& other) const {
    return pose.matrix() == other.pose.matrix() && half == other.half && radius == other.radius;
  }
};

using Shape = std::variant<Plane, Capsule, RoundedBox>;

double signed_distance(const Shape& shape, const Vec3& x);

struct DistanceSlope {
  double distance = 0;           ///< m, negative inside
  Vec3 gradient = Vec3::Zero();  ///< by the point, unit length
};
/// Distance and gradient, and the Hessian by the point (1/m) where those are known already.
/// Exact inside and out. The Hessian is zero (to rounding) on flat faces and jumps where a flat, an edge and
/// a corner meet. Where the direction outward is not unique (a capsule's axis, a box's inner box at equal
/// depths) one of the candidates is returned, with a zero Hessian: values stay finite. All three shapes are
/// convex, and so is their signed distance.
DistanceSlope distance_slope(const Shape& shape, const Vec3& x);
Mat3 distance_hessian(const Shape& shape, const Vec3& x, const DistanceSlope& slope);

/// Bound on |signed_distance(a, x) - signed_distance(b, x)| over all x, m: how far the extreme points have
/// moved and the radius changed (the shapes are convex). Infinite for different kinds or different planes.
double distance_change(const Shape& a, const Shape& b);

/// The shape grown by `by` on all sides, shrunk where it is negative (by less than its radius): its signed distance is
/// that of `shape` less `by`, everywhere.
Shape offset(const Shape& shape, double by);

/// Smallest axis-aligned box around the shape: lower and upper corner. A plane has infinite bounds.
struct Bounds {
  Vec3 lower, upper;
};
Bounds bounds(const Shape& shape);

}  // namespace calot
