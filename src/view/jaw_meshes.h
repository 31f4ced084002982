#pragma once
// Instruments whose jaws are solid steel, as they are drawn. Nothing drawn lies outside instrument_shapes().

#include "view/instrument_parts.h"

namespace calot {

/// Slim jaws that taper and bow to one side, ribbed where they meet.
InstrumentModel dissector_model(const InstrumentGeometry& geometry);
/// Two blades that meet in an edge.
InstrumentModel scissors_model(const InstrumentGeometry& geometry);
/// Two straight jaws with a groove that a clip's leg lies in.
InstrumentModel applier_model(const InstrumentGeometry& geometry);

}  // namespace calot
