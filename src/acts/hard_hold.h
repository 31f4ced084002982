#pragma once
// How teeth hold what is hard. They do not sink in: friction holds what both pads press on (rubbing.h). Where it neither
// slides nor asks for more than friction holds, the places that the pads touch are held in the pads' frames, by the springs
// of a grip (grip.h): so what is carried rests between the pads instead of being balanced on them anew in each step. Where
// more is asked of it than friction holds (holding_limit(), couple_limit()) it turns between the pads, or slides.

#include "acts/pads.h"
#include "field/field.h"

namespace calot {

/// Whether a tool holds something hard by such springs.
bool holds_hard(const Field& field, ToolIndex instrument);

/// Whether both jaws of a tool touch something hard: blades, which close on all else as they are asked to, cut nothing of it.
bool rests_on_hard(const Field& field, ToolIndex instrument);

/// Whether any tool touches something hard.
bool touches_hard(const Field& field);
/// Whether any may where tools travel that far, m.
bool may_touch_hard(const Field& field, double travel);
/// Whether something hard that a tool touches is strained, and presses a tool by more than its hand's strength: it is wedged.
bool wedges_hard(const Field& field);
/// Whether any tool is pressed as no hand could press, as where tissue is crushed between it and ground, or something hard
/// wedges. Only where a step ends out of balance does that say that it is stuck.
bool crushes(const Field& field);

/// Holds what a tool's pads clasp where they touch it now, unless more is asked of it than friction holds.
void catch_hard(Field& field, ToolIndex instrument, const Clasped& held);

/// Where more is asked of a tool than friction holds: what a couple turns is turned on between the pads until it is asked no
/// more where it lies now (a return to the limit, as in plasticity), and what leaves the pads is let go; what is pulled loses
/// its springs, and slides by friction. Whether anything of that was done.
bool let_slide_on_hard(Field& field, ToolIndex instrument);

}  // namespace calot
