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

// The curvature of a round shape at distance r from its axis or centre acts across the gradient only.
DistanceSample sample(const Capsule& capsule, const Vec3& x) {
  const SegmentFoot foot = nearest_on_segment(capsule.a, capsule.b, x);
  const Vec3 outward = x - foot.point;
  const double r = outward.norm();
  DistanceSample result;
  result.distance = r - capsule.radius;
  if (r < on_axis) {
    result.gradient = any_perpendicular(capsule.b - capsule.a);
    return result;
  }
  result.gradient = outward / r;
  Mat3 across = Mat3::Identity() - result.gradient * result.gradient.transpose();
  if (foot.on_side) {
    const Vec3 along = (capsule.b - capsule.a).normalized();
    across -= along * along.transpose();
  }
  result.hessian = across / r;
  return result;
}

DistanceSample sample(const Plane& plane, const Vec3& x) {
  return {plane.normal.dot(x - plane.point), plane.normal, Mat3::Zero()};
}

DistanceSample sample_in_inner_box(const RoundedBox& box, const Vec3& local, const Vec3& beyond) {
  int face = 0;
  DistanceSample result;
  result.distance = beyond.maxCoeff(&face) - box.radius;
  result.gradient = box.pose.linear().col(face) * sign_of(local[face]);
  return result;
}

// In the box's frame the inner box's nearest point differs from x only along the axes on which x is beyond
// it: one such axis is a face (flat), two an edge (a cylinder), three a corner (a ball).
DistanceSample sample(const RoundedBox& box, const Vec3& x) {
  const Vec3 local = box.pose.inverse() * x;
  const Vec3 beyond = local.cwiseAbs() - box.half;
  const double r = beyond.cwiseMax(0.0).norm();
  if (r < on_axis) return sample_in_inner_box(box, local, beyond);
  Vec3 normal = Vec3::Zero();
  Mat3 across = Mat3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (beyond[axis] <= 0) continue;
    normal[axis] = beyond[axis] / r * sign_of(local[axis]);
    across(axis, axis) = 1.0;
  }
  const Mat3 rotation = box.pose.linear();
  across -= normal * normal.transpose();
  return {r - box.radius, rotation * normal, rotation * across * rotation.transpose() / r};
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
  const Vec3 beyond = (box.pose.inverse() * x).cwiseAbs() - box.half;
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0) - box.radius;
}

DistanceSample sample_distance(const Shape& shape, const Vec3& x) {
  return std::visit([&](const auto& one) { return sample(one, x); }, shape);
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
