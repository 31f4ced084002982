#pragma once
// Holes in walls: of hollow organs, that instruments make, and of tubes; what leaves by them is in leak.h.

#include "field/field.h"

namespace calot {

/// Makes the hole that a tool's jaws, which hold it, cut or crush into an organ; what holds no liquid has nothing to lose.
void perforate(Organ& organ, ToolIndex instrument, const std::string& name);
/// Makes one where current has burnt a wall, at the skin point nearest to `at`; what holds no liquid has nothing to lose.
void perforate(Organ& organ, const Vec3& at, const std::string& instrument);

/// Makes one of a width (m, > 0) in the wall of a tube at a share of its length, 0 to 1, and says at which: not where it
/// ends or a clip lies. Fails (scenario) where the organ is no tube, or is too short.
Result<double> open_tube(Organ& tube, double share, double width);

}  // namespace calot
