#pragma once
// How near something is to an organ's surface, wherever that lies between the points of its skin.

#include <optional>
#include <vector>

#include "field/field.h"

namespace calot {

/// Of a tool, what current flows through, as it is made: its jaws, or the electrode that its rod ends in.
std::vector<Shape> working_shapes(const Tool& tool);

/// To the nearest place of an organ's surface, to a thousandth of a triangle's edge.
struct Clearance {
  double distance = 0;        ///< m; 0 where they touch
  Vec3 place = Vec3::Zero();  ///< m, of the surface
};
/// Of the nearest of some shapes; none: it is not nearer than `within` (m), which is quickly said of what is far.
std::optional<Clearance> clearance_within(const std::vector<Shape>& shapes, const Organ& organ,
                                          double within);
Clearance clearance(const std::vector<Shape>& shapes, const Organ& organ);
/// Of what a tool works with (working_shapes), as it is posed now.
Clearance clearance(const Tool& tool, const Organ& organ);

}  // namespace calot
