#pragma once

#include "anatomy/definitions.h"
#include "render/scene.h"

namespace calot {

/// The camera of a laparoscope through `port` that looks at `target` from `distance`. An angled optic looks
/// down (posteriorly) from its shaft by `angle`, in the vertical plane through port and target, so the shaft
/// runs above the line of sight; the horizon is level (screen up is as much +z as it can be, screen right is
/// the patient's left). Where the port is too near for that (within about `distance`), the tip lies on the
/// line through port and target, at `distance`, with the optic's angle left out.
SceneCamera laparoscope_camera(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target);

}  // namespace calot
