#pragma once

#include "render/scene.h"
#include "tools/step_report.h"

namespace calot {

/// What is seen through a laparoscope that is there (tools/laparoscope.h).
SceneCamera laparoscope_camera(const LaparoscopeDefinition& scope, const LaparoscopeState& state);

}  // namespace calot
