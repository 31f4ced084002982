#include "collision/shapes.h"

#include <limits>
#include <type_traits>

namespace calot {
namespace {

/// Below this distance from a capsule's axis (or a box's inner edge) the direction outward is noise, m.
constexpr double on_axis = 1e-12;

double sign_of(double value) { return value < 0 ? -1.0 : 1.0; }

Vec3 any_perpendicular(const Vec3& axis) {
  Vec3 other = Vec3::Zero();
  int smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  other[smallest] = 1.0;
  return axis.squaredNorm() > 0 ? axis.cross(other).normalized() : other;
}

struct SegmentFoot {
  Vec3 point;    // nearest point of the segment
  bool on_side;  // between the ends, not at one of them
};

SegmentFoot nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& x) {
  const Vec3 axis = b - a;
  const double along = (x - a).dot(axis), squared_length = axis.squaredNorm();
  if (along <= 0) return {a, false};
  if (along >= squared_length) return {b, false};
  return {a + axis * (along / squared_length), true};
}

DistanceSlope slope(const Plane& plane, const Vec3& x) {
  return {plane.normal.dot(x - plane.point), plane.normal};
}
DistanceSlope slope(const Capsule& capsule, const Vec3& x) {
  const Vec3 outward = x - nearest_on_segment(capsule.a, capsule.b, x).point;
  const double r = outward.norm();
  return {r - capsule.radius, r < on_axis ? any_perpendicular(capsule.b - capsule.a) : Vec3(outward / r)};
}

// The curvature of a round shape at distance r from its axis or centre acts across the gradient only.
Mat3 curvature(const Plane&, const Vec3&, const DistanceSlope&) { return Mat3::Zero(); }
Mat3 curvature(const Capsule& capsule, const Vec3& x, const DistanceSlope& at) {
  const double r = at.distance + capsule.radius;
  if (r < on_axis) return Mat3::Zero();
  Mat3 across = Mat3::Identity() - at.gradient * at.gradient.transpose();
  if (nearest_on_segment(capsule.a, capsule.b, x).on_side) {
    const Vec3 along = (capsule.b - capsule.a).normalized();
    across -= along * along.transpose();
  }
  return across / r;
}

Vec3 in_frame(const RoundedBox& box, const Vec3& x) {
  return box.pose.linear().transpose() * (x - box.pose.translation());
}

// In the box's frame the inner box's nearest point differs from x only along the axes on which x is beyond
// it: one such axis is a face (flat), two an edge (a cylinder), three a corner (a ball).
DistanceSlope slope(const RoundedBox& box, const Vec3& x) {
  const Vec3 local = in_frame(box, x), beyond = local.cwiseAbs() - box.half;
  const double r = beyond.cwiseMax(0.0).norm();
  if (r < on_axis) {
    int face = 0;
    const double inside = beyond.maxCoeff(&face);
    return {inside - box.radius, box.pose.linear().col(face) * sign_of(local[face])};
  }
  Vec3 normal = beyond.cwiseMax(0.0) / r;
  for (int axis = 0; axis < 3; ++axis) normal[axis] *= sign_of(local[axis]);
  return {r - box.radius, box.pose.linear() * normal};
}
Mat3 curvature(const RoundedBox& box, const Vec3& x, const DistanceSlope& at) {
  const double r = at.distance + box.radius;
  if (r < on_axis) return Mat3::Zero();
  const Vec3 beyond = in_frame(box, x).cwiseAbs() - box.half;
  Mat3 across = -at.gradient * at.gradient.transpose();
  for (int axis = 0; axis < 3; ++axis)
    if (beyond[axis] > 0) across += box.pose.linear().col(axis) * box.pose.linear().col(axis).transpose();
  return across / r;
}

double change(const Plane& a, const Plane& b) {
  const bool same = a.point == b.point && a.normal == b.normal;
  return same ? 0.0 : std::numeric_limits<double>::infinity();
}
double change(const Capsule& a, const Capsule& b) {
  return std::max((a.a - b.a).norm(), (a.b - b.b).norm()) + std::abs(a.radius - b.radius);
}
double change(const RoundedBox& a, const RoundedBox& b) {
  double furthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Vec3 move = a.pose * sign.cwiseProduct(a.half) - b.pose * sign.cwiseProduct(b.half);
    furthest = std::max(furthest, move.norm());
  }
  return furthest + std::abs(a.radius - b.radius);
}

Bounds bounds_of(const Plane&) {
  const double infinity = std::numeric_limits<double>::infinity();
  return {Vec3::Constant(-infinity), Vec3::Constant(infinity)};
}
Bounds bounds_of(const Capsule& capsule) {
  const Vec3 radius = Vec3::Constant(capsule.radius);
  return {capsule.a.cwiseMin(capsule.b) - radius, capsule.a.cwiseMax(capsule.b) + radius};
}
Bounds bounds_of(const RoundedBox& box) {
  const Vec3 reach = box.pose.linear().cwiseAbs() * box.half + Vec3::Constant(box.radius);
  return {box.pose.translation() - reach, box.pose.translation() + reach};
}

}  // namespace

double signed_distance(const Shape& shape, const Vec3& x) {
  if (const auto* plane = std::get_if<Plane>(&shape)) return plane->normal.dot(x - plane->point);
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return (x - nearest_on_segment(capsule->a, capsule->b, x).point).norm() - capsule->radius;
  const auto& box = std::get<RoundedBox>(shape);
  const Vec3 beyond = in_frame(box, x).cwiseAbs() - box.half;
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0) - box.radius;
}

DistanceSlope distance_slope(const Shape& shape, const Vec3& x) {
  return std::visit([&](const auto& one) { return slope(one, x); }, shape);
}

Mat3 distance_hessian(const Shape& shape, const Vec3& x, const DistanceSlope& slope) {
  return std::visit([&](const auto& one) { return curvature(one, x, slope); }, shape);
}

double distance_change(const Shape& a, const Shape& b) {
  return std::visit(
      [](const auto& one, const auto& other) {
        if constexpr (std::is_same_v<decltype(one), decltype(other)>) return change(one, other);
        return std::numeric_limits<double>::infinity();
      },
      a, b);
}

Shape offset(const Shape& shape, double by) {
  Shape out = shape;
  if (auto* plane = std::get_if<Plane>(&out)) plane->point += by * plane->normal;
  if (auto* capsule = std::get_if<Capsule>(&out)) capsule->radius += by;
  if (auto* box = std::get_if<RoundedBox>(&out)) box->radius += by;
  return out;
}

Bounds bounds(const Shape& shape) {
  return std::visit([](const auto& one) { return bounds_of(one); }, shape);
}

}  // namespace calot
