#pragma once
// How closing jaws take hold of skin points (grip.h).

#include "field/field.h"

namespace calot {

/// Skin points that touch a pad of a closing tool are held by it from here on; not of a wall after it has lost what it held.
void take_hold(Field& field, ToolIndex instrument);

/// Puts an organ's grips in the order in which they are counted: by tool, jaw and skin point.
void sort_grips(Organ& organ);

/// Where a tool holds clips, it holds their tubes by the points beside each clip, wherever that has been drawn to:
/// others are let go, new ones held where they are. Returns whether it holds any.
bool hold_by_clips(Field& field, ToolIndex instrument);

/// Before jaws that hold some skin close further, to `jaw` (rad): each pad keeps what it holds within its half of the
/// gap, out of the other's way.
void make_room(Field& field, ToolIndex instrument, double jaw);

}  // namespace calot
