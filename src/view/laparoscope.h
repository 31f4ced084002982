#pragma once

#include "render/scene.h"
#include "sim/step_report.h"

namespace calot {

/// What is seen through a laparoscope that is there (sim/laparoscope.h).
SceneCamera laparoscope_camera(const LaparoscopeDefinition& scope, const LaparoscopeState& state);

}  // namespace calot
