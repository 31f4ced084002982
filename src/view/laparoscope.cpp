#include "view/laparoscope.h"

#include <cmath>

#include "sim/laparoscope.h"

namespace calot {

SceneCamera laparoscope_camera(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target) {
  const LaparoscopePose pose = laparoscope_pose(scope, port, target);
  SceneCamera camera;
  camera.position = pose.position;
  camera.direction = pose.direction;
  camera.up = pose.up;
  camera.field_of_view = scope.field_of_view;
  // Its standard follows the distance, as a surgeon's light source does: what is looked at is well lit.
  camera.light_intensity = scope.light * scope.exposure * std::pow(scope.distance / 90e-3, 2);
  return camera;
}

}  // namespace calot
