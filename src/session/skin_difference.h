#pragma once
// How differently two organs of the same shape have moved: the error of the paper's section 6, where one of them has
// a finer mesh.

#include <optional>
#include <vector>

#include "world/world.h"

namespace calot {

/// Skin points of an organ in its own frame, all lists of the same length.
struct MovedSkin {
  std::vector<Vec3> rest, motion;  ///< m: unstressed, and displacement since the organ was filled
  std::vector<double> areas;       ///< m^2 at rest, that each point stands for
  std::vector<Triangle> triangles;
};

/// Distances between the two displacements of each of the reference's points, in % of its largest displacement.
struct SkinDifference {
  double mean_pct = 0;  ///< over the rest area
  double largest_pct = 0;
};

/// Points correspond by the nearest place at rest. None where the reference has not moved.
std::optional<SkinDifference> skin_difference(const MovedSkin& skin, const MovedSkin& reference);

/// The same for organs of a world that are compared with others, since the moment of its making.
class SkinDifferences {
 public:
  explicit SkinDifferences(const World& world);
  /// None for an organ of the scene that is compared with none, or where that one has not moved or either has gone. Some
  /// 0.1 s.
  std::optional<SkinDifference> of(const World& world, int organ) const;

 private:
  std::vector<std::vector<Vec3>> first_;  ///< m, each organ's skin points then
};

}  // namespace calot
