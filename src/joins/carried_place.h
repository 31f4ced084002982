#pragma once
// A place that goes along with a body, by skin points of it.
//
// A place is carried by fixed weights of skin points, found at rest: they sum to 1 and give the place itself, so they go
// along with any affine motion of those points, and of all such weights they are the smallest, near ones before far ones.

#include <optional>
#include <utility>
#include <vector>

#include "geometry/state_members.h"
#include "geometry/stencil.h"

namespace calot {

/// A place by skin points of a body; the weights sum to 1.
struct CarriedPlace {
  std::vector<int> points;
  std::vector<double> weights;
};
void visit_members(auto&& visit, MembersOf<CarriedPlace> auto& place) {
  auto& [points, weights] = place;
  visit(points, weights);
}

/// Where a place lies, m, while the body's skin points lie at `skin`, m.
Vec3 carried_to(const CarriedPlace& place, const std::vector<Vec3>& skin);

/// Adds a row of the nodes that it depends on, counted from `first_node`; `skin`: the body's.
void append_place(const CarriedPlace& place, const StencilTable& skin, int first_node, StencilTable& rows);

/// A place as the points around it carry it, from near ones if their weights are small, else from as many as it takes:
/// a place far above a flat patch would be thrown about by what is small on the patch. `skin`: all points of the body,
/// m, where the place goes along with them; the search begins `radius` (m) beyond the nearest. None where the sizes of
/// the weights would sum to more than 8, as beside a line that is not quite straight.
std::optional<CarriedPlace> carried_place(const std::vector<Vec3>& skin, const Vec3& place, double radius);

/// Distances (m) and numbers of skin points, the nearest to a place first.
using PointsByDistance = std::vector<std::pair<double, int>>;
PointsByDistance points_by_distance(const std::vector<Vec3>& skin, const Vec3& place);

}  // namespace calot
