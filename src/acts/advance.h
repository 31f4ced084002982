#pragma once
// Motion of the field: instruments go to their targets, organs stay in equilibrium, or, where masses count
// (Field::step_time), move by them.
//
// Each part of the motion starts from the organs' first-order response to the tools (so a pushed or pulled
// wall moves along), is cut where a skin point would come too near a shape or a node would move further than
// a set share of its local edge, and ends in equilibrium; then what is drawn off its pad is let go, and
// folds slip that are pulled or turned harder than they are held. How the motion was cut into steps matters nowhere
// but to what slides or leaves its pad, a little, as friction follows the way in straight pieces; jaws take hold at
// fixed angles, and stop where tissue carries their pinch.
//
// Where masses count each part is a step of implicit Euler (inertia.h) in its share of the step's time, begins from the
// first Newton step from where the organs are, and is cut in time too. What is solved again at the end of a part, as
// folds slip, grips are let go and details change, is solved again for that part: no time passes, and none is lost.

#include <string>
#include <vector>

#include "field/field.h"

namespace calot {

/// Moves every tool to its target. The field is left at the last converged part on failure (simulation).
/// Returns grasp, empty_grasp, release and slip events (time to be set by the caller).
Result<std::vector<WorldEvent>> advance(Field& field, const std::vector<InstrumentPose>& targets,
                                        SolveStatistics& statistics);

}  // namespace calot
