#pragma once

#include <vector>

#include "render/scene.h"
#include "sim/instrument.h"

namespace calot {

/// Semm's endocoagulation forceps as they are drawn: two short, broad plates of steel, flat where they grip and
/// cook, their backs under an insulating cover. Nothing drawn lies outside instrument_shapes().
std::vector<SceneMesh> semm_meshes(const Vec3& trocar, const InstrumentPose& pose,
                                   const InstrumentGeometry& geometry);

}  // namespace calot
