#pragma once

#include <vector>

#include "render/scene.h"
#include "sim/instrument.h"

namespace calot {

/// An L-hook electrode as it is drawn: insulated shaft, an insulated neck, and a bare wire that bends to one side.
/// Nothing drawn lies outside instrument_shapes().
std::vector<SceneMesh> hook_meshes(const Vec3& trocar, const InstrumentPose& pose,
                                   const InstrumentGeometry& geometry);

}  // namespace calot
