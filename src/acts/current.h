#pragma once
// What an instrument's current does to the strands that it touches: they share its power evenly, and each is divided once
// it has taken what its area takes. Where they touch none, a wall takes it all, and is opened once that is its
// burn_energy; what it took is forgotten where the current stops or the instrument leaves it, and a
// mark stays.

#include "motion/tool_loads.h"

namespace calot {

/// The step after which all stand as they do has lasted `duration` s with the tools' actions. `loads`: what organs and
/// strands do to each tool, where current flows in any. Strands that have taken enough are torn from now on. Of what
/// current should not be let into (a wall, a clip, what is to be kept clear of) there are only events. They have no time
/// yet.
std::vector<WorldEvent> apply_current(Field& field, const std::vector<ToolLoad>& loads, double duration);

/// How near something is to an organ's skin.
struct Clearance {
  double distance = 0;  ///< m; 0 where they touch
  Vec3 place;           ///< m, of the skin, nearest to it
};
/// Of the nearest of some shapes.
Clearance clearance(const std::vector<Shape>& shapes, const Organ& organ);
/// Of what a tool works with: its jaws, or what its rod ends in (`conducts`), as it is posed now.
Clearance clearance(const Tool& tool, const Organ& organ);

}  // namespace calot
