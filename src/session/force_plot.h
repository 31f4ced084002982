#pragma once
// A picture of what instruments met: the force on each tip over the way that it went.

#include <string>

#include "session/trace.h"

namespace calot {

/// SVG: one curve an instrument, force on its tip (N) over its tip's path (mm). Empty where none was ever touched.
std::string force_plot(const SceneDefinition& scene, const Traces& traces);

}  // namespace calot
