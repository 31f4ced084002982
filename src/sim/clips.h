#pragma once
// How clips are set.
//
// Firing squeezes the clip's legs shut, whatever the angle of the jaws: the applier's mechanism does, in less than a step.
// The legs lie on the jaws up to their tip; a duct or a vessel that passes between them is flat then, pi times its radius
// wide, and the clip holds what of that width is between its legs. It stays where it is on the tube, and what is divided
// takes its clips along. Where it does not reach the middle of any, or in the air, the clip falls (spill.h), and lies
// where it fell.

#include "sim/field.h"

namespace calot {

/// Of each tool in which the action begins (`actions`: one a tool, or none) one clip, while it has some. Adds the events
/// clip and clip_dropped.
void fire_clips(Field& field, const std::vector<InstrumentAction>& actions, std::vector<WorldEvent>& events);

}  // namespace calot
