#pragma once
// What jaws hold: skin points that keep their places along the pads until they slip, are drawn off or let go. How they take
// hold is in take_hold.h.

#include "field/field.h"

namespace calot {

/// Stiffness of a held skin point, N/m: a hundred times the wall's, so that 5 N on the tens of points of a fold move it
/// by some um. Well below a contact point's: a fold's wall, which cannot bend between its nodes, sets its grips against
/// each other and against the jaws, and stiffer ones would push it into them.
inline constexpr double grip_stiffness = 4e4;

/// How far before a pad its teeth take hold, m (d).
inline constexpr double pad_reach = 0.5e-3;

/// Jaw angles (rad) at which closing jaws may take hold.
inline constexpr double grip_grid = 0.0174532925199432957;  // 1 deg
/// The same of jaws that hold where bodies are only brought along on the way: a pad's end moves by 0.5 mm from one to the
/// next, which is how far its teeth reach.
inline constexpr double grip_grid_on_the_way = 3 * grip_grid;

/// True when both jaws hold skin and the pads are as near as the folded wall allows.
bool fold_fills_jaws(const Field& field, ToolIndex instrument);

/// Area of the walls (m^2, at rest) that a tool's jaws hold between them: of the pad that holds less. A tube counts as
/// wide as it is flat; what a clip keeps the pads off does not count.
double held_area(const Field& field, ToolIndex instrument);

/// Skin points of the organ that tool `instrument` grips.
int grip_count(const Organ& organ, ToolIndex instrument);

/// Name of the first organ of which a tool holds something; empty: none.
std::string held_organ(const Field& field, ToolIndex instrument);

/// True while skin of the organ, or of one of the field's, is held by both pads, but for what is to leave them.
bool both_pads_hold(const Organ& organ, ToolIndex instrument);
bool both_pads_hold(const Field& field, ToolIndex instrument);

/// What holds an organ's points to the tools at `poses`.
GripSprings grip_springs(const Organ& organ, const std::vector<Tool>& tools,
                         const std::vector<InstrumentPose>& poses);

}  // namespace calot
