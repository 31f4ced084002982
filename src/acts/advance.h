#pragma once
// Motion of the field: instruments go to their targets, organs stay in equilibrium, or, where masses count
// (Field::step_time), move by them.
//
// The way there is cut at the angles at which closing jaws may take hold, and each stretch of it into parts (follow.h).
// How the motion was cut into steps matters nowhere but to what slides or leaves its pad, a little, as friction follows
// the way in straight pieces; jaws take hold at fixed angles, and stop where tissue carries their pinch.

#include <string>
#include <vector>

#include "field/field.h"

namespace calot {

/// Moves every tool to its target. The field is left at the last converged part on failure (simulation).
/// Returns grasp, empty_grasp, release and slip events (time to be set by the caller).
Result<std::vector<WorldEvent>> advance(Field& field, const std::vector<InstrumentPose>& targets,
                                        SolveStatistics& statistics);

/// The same within a step; but one that would wedge something hard, that cannot be followed, or that ends short of its way or
/// out of balance with tissue crushed as no hand could (hard_hold.h), is taken back: its tools stay where they are, and the
/// time passes. Fails where that cannot be followed either.
Result<std::vector<WorldEvent>> advance_unwedged(Field& field, const std::vector<InstrumentPose>& targets,
                                                 SolveStatistics& statistics);

}  // namespace calot
