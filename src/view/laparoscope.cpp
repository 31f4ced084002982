#include "view/laparoscope.h"

#include <cmath>

namespace calot {

SceneCamera laparoscope_camera(const LaparoscopeDefinition& scope, const LaparoscopeState& state) {
  SceneCamera camera;
  camera.position = state.view.position;
  camera.direction = state.view.direction;
  camera.up = state.view.up;
  camera.field_of_view = scope.field_of_view;
  // Its standard follows the distance, as a surgeon's light source does: what is looked at is well lit.
  camera.compensation = scope.light * scope.exposure;
  camera.light_intensity = camera.compensation * std::pow(state.distance / 90e-3, 2);
  return camera;
}

}  // namespace calot
