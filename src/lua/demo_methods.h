#pragma once
// The functions behind what demos command: motions, acts, exchanges.

#include <vector>

#include "lua/method_targets.h"

namespace calot {

/// Of the classes Demo and DemoInstrument.
const std::vector<Method>& demo_methods();

}  // namespace calot
