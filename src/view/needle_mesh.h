#pragma once

#include "view/instrument_parts.h"

namespace calot {

/// An aspiration needle as it is drawn: insulated shaft, a steel neck, and the slim needle that it carries.
InstrumentModel needle_model(const InstrumentGeometry& geometry);

/// Its sharp end, which it puts forth while it is in an organ: from the tip on, as long as that, m.
SceneMesh needle_end_mesh(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry,
                          double length);

}  // namespace calot
