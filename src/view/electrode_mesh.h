#pragma once

#include "view/instrument_parts.h"

namespace calot {

/// A bipolar electrode with channel as it is drawn: insulated rod, slim steel neck, and a rounded end of two steel
/// poles with an insulating strip between them, in whose middle the channel for rinsing and suction opens. Nothing
/// drawn lies outside instrument_shapes().
InstrumentModel electrode_model(const InstrumentGeometry& geometry);

}  // namespace calot
