#pragma once
// Holes that instruments make in the walls of hollow organs; what leaves by them is in leak.h.

#include "field/field.h"

namespace calot {

/// Makes the hole that a tool's jaws, which hold it, cut or crush into an organ; what holds no liquid has nothing to lose.
void perforate(Organ& organ, ToolIndex instrument, const std::string& name);
/// Makes one where current has burnt a wall, at the skin point nearest to `at`; what holds no liquid has nothing to lose.
void perforate(Organ& organ, const Vec3& at, const std::string& instrument);

}  // namespace calot
