#pragma once

#include <vector>

#include "render/scene.h"
#include "sim/instrument.h"

namespace calot {

/// An aspiration needle as it is drawn: insulated shaft, a steel neck, and the slim needle that it carries.
std::vector<SceneMesh> needle_meshes(const Vec3& trocar, const InstrumentPose& pose,
                                     const InstrumentGeometry& geometry);

}  // namespace calot
