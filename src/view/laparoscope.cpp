#include "view/laparoscope.h"

#include <cmath>

namespace calot {

SceneCamera laparoscope_camera(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target) {
  const Vec3 line = (target - port).normalized();
  const double reach = (target - port).norm();
  // Horizontal axis of the vertical plane; straight up or down any will do.
  Vec3 across = line.cross(Vec3::UnitZ());
  across = across.norm() > 1e-6 ? across.normalized() : Vec3::UnitX();

  // Triangle port - tip - target: the view leaves the tip at `angle` below the shaft, so the law of cosines
  // gives the inserted length and the law of sines how far the view dips below the line from port to target.
  const double sine = std::sin(scope.angle) * scope.distance / reach;
  double dip = 0;
  if (std::abs(sine) < 1) {
    const double inserted = reach * std::sqrt(1 - sine * sine) - scope.distance * std::cos(scope.angle);
    if (inserted > 0) dip = scope.angle - std::asin(sine);
  }
  SceneCamera camera;
  camera.direction = Eigen::AngleAxisd(-dip, across) * line;
  camera.position = target - scope.distance * camera.direction;
  camera.up = across.cross(camera.direction);
  camera.field_of_view = scope.field_of_view;
  // Exposure follows the distance, as a surgeon's light source does: what is looked at is well lit.
  camera.light_intensity = std::pow(scope.distance / 90e-3, 2);
  return camera;
}

}  // namespace calot
