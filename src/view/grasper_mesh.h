#pragma once

#include <vector>

#include "render/scene.h"
#include "sim/instrument.h"

namespace calot {

/// An atraumatic grasper as it is drawn: insulated shaft, steel end with a clevis and its pin, two
/// fenestrated jaws with teeth on their pads. Nothing drawn lies outside instrument_shapes(): what is seen is
/// what touches.
std::vector<SceneMesh> grasper_meshes(const Vec3& trocar, const InstrumentPose& pose,
                                      const InstrumentGeometry& geometry);

}  // namespace calot
