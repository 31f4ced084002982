#pragma once

#include "view/instrument_parts.h"

namespace calot {

/// An L-hook electrode as it is drawn: insulated shaft, an insulated neck, and a bare wire that bends to one side.
/// Nothing drawn lies outside instrument_shapes().
InstrumentModel hook_model(const InstrumentGeometry& geometry);

}  // namespace calot
