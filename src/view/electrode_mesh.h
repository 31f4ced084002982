#pragma once

#include <vector>

#include "render/scene.h"
#include "sim/instrument.h"

namespace calot {

/// A bipolar electrode with channel as it is drawn: insulated rod, slim steel neck, and a rounded end of two steel
/// poles with an insulating strip between them, in whose middle the channel for rinsing and suction opens. Nothing
/// drawn lies outside instrument_shapes().
std::vector<SceneMesh> electrode_meshes(const Vec3& trocar, const InstrumentPose& pose,
                                        const InstrumentGeometry& geometry);

}  // namespace calot
