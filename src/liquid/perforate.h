#pragma once
// Holes that instruments make in the walls of hollow organs; what leaves by them is in leak.h.

#include "field/field.h"

namespace calot {

/// Makes the holes that a tool's jaws, which hold them, cut or crush into hollow organs.
void perforate(Field& field, ToolIndex instrument);
/// Makes one where current has burnt a wall, at the skin point nearest to `at`; what holds no liquid has nothing to lose.
void perforate(Organ& organ, const Vec3& at, const std::string& instrument);

}  // namespace calot
