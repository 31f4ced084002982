#pragma once
// The convex hull of points on the unit sphere: their Delaunay triangulation there.

#include <span>

#include "base/status.h"
#include "geometry/types.h"

namespace calot {

/// Triangles counter-clockwise seen from outside; by insertion, quadratic in the number of points. Fails when
/// a point is not on the hull (points that coincide, or all on one side).
Result<std::vector<Triangle>> sphere_hull(std::span<const Vec3> points);

}  // namespace calot
