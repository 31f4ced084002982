#pragma once
// Where the lens shows a point, found the other way round from the shader, which goes from pixels to directions.

#include "render/lens.h"

namespace calot::test {

/// Where a point of the world is seen, px from the top left of a width x height picture, distortion included.
/// The point must lie in front of the camera.
inline Vec2 seen_at(const SceneCamera& camera, const Lens& lens, int width, int height, const Vec3& point) {
  const Vec3 p = camera_axes(camera) * (point - camera.position);
  const Vec2 ideal = p.head<2>() / (p.z() * std::tan(0.5 * camera.field_of_view));
  // Invert r (1 - k + k r^2) = |ideal|: monotone for r >= 0, so Newton from the right side converges.
  double r = std::max(ideal.norm(), 1.0);
  for (int i = 0; i < 30; ++i) {
    const double value = r * (1 - lens.barrel + lens.barrel * r * r) - ideal.norm();
    r -= value / (1 - lens.barrel + 3 * lens.barrel * r * r);
  }
  const Vec2 seen = ideal.norm() > 0 ? Vec2(ideal * (r / ideal.norm())) : ideal;
  const double radius = lens.field_radius(height);
  return {0.5 * width + radius * seen.x(), 0.5 * height - radius * seen.y()};
}

}  // namespace calot::test
