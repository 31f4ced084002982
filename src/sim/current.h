#pragma once
// What an instrument's current does to the strands that it touches: they share its power evenly, and each is divided once
// it has taken what its area takes. What the walls of organs take is not reckoned.

#include "sim/field.h"

namespace calot {

/// The step after which all stand as they do has lasted `duration` s with the tools' actions. Strands that have taken
/// enough are torn from now on. The events have no time yet.
std::vector<WorldEvent> apply_current(Field& field, double duration);

}  // namespace calot
