#include "render/lens.h"

#include <algorithm>
#include <cmath>

namespace calot {
namespace {

/// A perspective onto [-1, 1] squared with the given tangents of the half angles.
Eigen::Matrix4d perspective(const Mat3& axes, double tan_x, double tan_y, double near, double far) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m.row(0).head<3>() = axes.row(0) / tan_x;
  m.row(1).head<3>() = axes.row(1) / tan_y;
  m.row(2).head<3>() = axes.row(2) * (far + near) / (far - near);
  m(2, 3) = -2 * far * near / (far - near);
  m.row(3).head<3>() = axes.row(2);
  return m;
}

}  // namespace

Vec2 Lens::inner_extent(int width, int height) const {
  const double radius = field_radius(height);
  return {std::min(1.0, 0.5 * width / radius), std::min(1.0, 0.5 * height / radius)};
}

Mat3 camera_axes(const SceneCamera& camera) {
  const Vec3 forward = camera.direction.normalized();
  const Vec3 right = forward.cross(camera.up).normalized();
  Mat3 axes;
  axes.row(0) = right, axes.row(1) = right.cross(forward), axes.row(2) = forward;
  return axes;
}

Eigen::Matrix4d inner_projection(const SceneCamera& camera, const Lens& lens, int width, int height) {
  const Vec2 tangent = std::tan(0.5 * camera.field_of_view) * lens.inner_extent(width, height);
  return perspective(camera_axes(camera), tangent.x(), tangent.y(), near_plane, far_plane);
}

Eigen::Matrix4d shadow_projection(const SceneCamera& camera) {
  const Mat3 axes = camera_axes(camera);
  const double tangent =
      1.15 * std::tan(0.5 * camera.field_of_view);  // the light sees a little more than the lens
  Eigen::Matrix4d m = perspective(axes, tangent, tangent, 10e-3, 0.4);
  m.col(3) -= m.leftCols<3>() * (axes.transpose() * camera.light_offset);
  return m;
}

}  // namespace calot
