#include "geometry/solid_moments.h"

#include <numbers>

namespace calot {
namespace {

using std::numbers::pi;

/// Second moments of a body of revolution about an axis: `along` it, and `across` it.
Mat3 about_axis(const Vec3& axis, double along, double across) {
  const Vec3 unit = axis.normalized();
  return across * Mat3::Identity() + (along - across) * unit * unit.transpose();
}

}  // namespace

SolidMoments box_moments(const Vec3& half) {
  const double volume = 8 * half.prod();
  return {volume, Vec3::Zero(), volume / 3 * half.cwiseAbs2().asDiagonal().toDenseMatrix()};
}

SolidMoments ball_moments(const Vec3& centre, double radius) {
  const double volume = 4 * pi / 3 * radius * radius * radius;
  return {volume, centre, volume * radius * radius / 5 * Mat3::Identity()};
}

SolidMoments cylinder_moments(const Vec3& a, const Vec3& b, double radius) {
  const double squared = (b - a).squaredNorm(), volume = pi * radius * radius * std::sqrt(squared);
  return {volume, 0.5 * (a + b), about_axis(b - a, volume * squared / 12, volume * radius * radius / 4)};
}

SolidMoments capsule_moments(const Vec3& a, const Vec3& b, double radius) {
  const SolidMoments ball = ball_moments(0.5 * (a + b), radius);
  const double length = (b - a).norm();
  if (length == 0) return ball;
  const SolidMoments body = cylinder_moments(a, b, radius);
  // Both halves of the ball, each shifted outward by half the length: their centroids are 3/8 of a radius off the cut.
  const double shifts = ball.volume * (0.25 * length * length + 0.375 * length * radius);
  return {body.volume + ball.volume, body.centroid, body.second + ball.second + about_axis(b - a, shifts, 0)};
}

SolidMoments mesh_moments(const TriMesh& mesh) {
  // Tetrahedra from a point of the mesh: near, so that little cancels.
  SolidMoments out;
  if (mesh.points.empty()) return out;
  const Vec3 from = mesh.points.front();
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.points[t[0]] - from, b = mesh.points[t[1]] - from, c = mesh.points[t[2]] - from;
    const double volume = a.dot(b.cross(c)) / 6;
    const Vec3 sum = a + b + c;
    out.volume += volume;
    first += volume / 4 * sum;
    second +=
        volume / 20 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (out.volume == 0) return out;
  const Vec3 shift = first / out.volume;
  out.centroid = from + shift;
  out.second = second - out.volume * shift * shift.transpose();
  return out;
}

SolidMoments moved(const SolidMoments& solid, const Pose& motion) {
  return {solid.volume, motion * solid.centroid,
          motion.linear() * solid.second * motion.linear().transpose()};
}

SolidMoments joined(const SolidMoments& a, const SolidMoments& b) {
  SolidMoments out;
  out.volume = a.volume + b.volume;
  if (out.volume == 0) return out;
  const Vec3 apart = b.centroid - a.centroid;
  out.centroid = a.centroid + b.volume / out.volume * apart;
  out.second = a.second + b.second + a.volume * b.volume / out.volume * apart * apart.transpose();
  return out;
}

}  // namespace calot
