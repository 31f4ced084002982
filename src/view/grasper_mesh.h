#pragma once

#include "view/instrument_parts.h"

namespace calot {

/// An atraumatic grasper as it is drawn: insulated shaft, steel end with a clevis and its pin, two
/// fenestrated jaws with teeth on their pads. Nothing drawn lies outside instrument_shapes(): what is seen is
/// what touches.
InstrumentModel grasper_model(const InstrumentGeometry& geometry);

}  // namespace calot
