#pragma once
// What instruments do to the bowel, the liver and the vessels that lie around the organs and stay.

#include "field/field.h"
#include "tools/events.h"

namespace calot {

/// Ground that a tool's jaws, or what its shaft ends in, hurt in this step: by blades that close on it, by current, by a
/// thrust beyond its limit. Each is a wound and an event `injury` (without a time), of each ground once until the tool is
/// off it. `balanced`: forces are those of a balance, and thrusts are judged.
std::vector<WorldEvent> hurt_ground(Field& field, bool balanced);
/// The same by a clip that was fired and closed on no tube.
void hurt_by_clip(Field& field, ToolIndex instrument, std::vector<WorldEvent>& events);

}  // namespace calot
