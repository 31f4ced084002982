#pragma once

#include "view/instrument_parts.h"

namespace calot {

/// Semm's endocoagulation forceps as they are drawn: two short, broad plates of steel, flat where they grip and
/// cook, their backs under an insulating cover. Nothing drawn lies outside instrument_shapes().
InstrumentModel semm_model(const InstrumentGeometry& geometry);

}  // namespace calot
