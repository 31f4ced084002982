#pragma once
// One motion of all tools in parts that are safe, organs in equilibrium at the end of each.
//
// Each part of the motion starts from the organs' first-order response to the tools (so a pushed or pulled
// wall moves along), is cut where a skin point would come too near a shape or a node would move further than
// a set share of its local edge, and ends in equilibrium; then what is drawn off its pad is let go, and
// folds slip that are pulled or turned harder than they are held.
//
// Where masses count the whole motion is one step of implicit Euler (inertia.h): on the way bodies are only brought along,
// and what holds, slips and presses is asked where it ends. Only where that finds no balance each part is a step of its own
// in its share of the time. What is solved again at the end, as folds slip, grips are let go and details change, is solved
// again for that step: no time passes, and none is lost.

#include <vector>

#include "field/field.h"

namespace calot {

/// Which piece of a motion is followed. Where masses count the first one begins the bodies' step, and at the end of the last
/// one they are in balance; between them they have only been brought along.
struct Piece {
  bool first = true, last = true;
};

/// Moves all tools from their poses to `to`, organs in equilibrium and grips within what they hold at the end
/// of each part, in `duration` s where masses count: the whole motion's.
/// Returns whether they came there: where masses count, not if the step's budget was spent before (step_budget.h), nor
/// where what they press leaves them no room yet: then the time has passed with them where they are.
/// `slipped_before`: one a tool, whether what it holds slid at the last step; events have no time yet. Fails (simulation)
/// with the field as it was at the last part that came to rest.
Result<bool> follow(Field& field, const std::vector<InstrumentPose>& to, double duration, Piece piece,
                    const std::vector<char>& slipped_before, std::vector<WorldEvent>& events,
                    SolveStatistics& statistics);

/// Turns a tool's jaws to an angle (rad) where they are, organs in equilibrium at the end: what a step has come to is found
/// again with other jaws. No time passes and nothing slips. Returns and fails as follow() does.
Result<bool> turn_jaw(Field& field, ToolIndex instrument, double jaw, SolveStatistics& statistics);

}  // namespace calot
