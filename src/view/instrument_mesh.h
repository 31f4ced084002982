#pragma once

#include <vector>

#include "view/instrument_parts.h"

namespace calot {

/// An instrument of any type as it is drawn. Nothing drawn lies outside its instrument_shapes(): what is seen is
/// what touches.
InstrumentModel instrument_model(InstrumentType type);

/// Where it stands: what is steel of it, and what is insulated.
std::vector<SceneMesh> posed(const InstrumentModel& model, const Vec3& trocar, const InstrumentPose& pose);

}  // namespace calot
