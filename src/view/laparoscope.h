#pragma once

#include "anatomy/definitions.h"
#include "render/scene.h"

namespace calot {

/// Its camera, at laparoscope_pose() (sim/laparoscope.h).
SceneCamera laparoscope_camera(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target);

}  // namespace calot
