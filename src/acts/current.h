#pragma once
// What an instrument's current does. Its power is shared by weights: 1 of all strands that it touches together, of each
// wall the weight of its distance (burn_weight() in burn.h). Each takes
//
//   power * duration * weight / max(1, sum of all weights)
//
// so that strands alone, or a touched wall alone, take all of it, and of a wall that is only near what it does not take is
// lost around. The strands share theirs evenly, and each is divided once it has taken what its area takes.

#include "motion/tool_loads.h"

namespace calot {

/// The step after which all stand as they do has lasted `duration` s with the tools' actions. `loads`: what organs and
/// strands do to each tool, where current flows in any. Strands that have taken enough are torn from now on, walls open
/// or lose their capsule; of a clip and of what is to be kept clear of there are only events. They have no time yet.
std::vector<WorldEvent> apply_current(Field& field, const std::vector<ToolLoad>& loads, double duration);

}  // namespace calot
