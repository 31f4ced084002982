#pragma once

#include <vector>

#include "render/scene.h"
#include "sim/instrument.h"

namespace calot {

/// An instrument of any type as it is drawn. Nothing drawn lies outside its instrument_shapes(): what is seen is
/// what touches.
std::vector<SceneMesh> instrument_meshes(InstrumentType type, const Vec3& trocar, const InstrumentPose& pose);

}  // namespace calot
