#pragma once

#include <utility>

#include "geometry/tri_mesh.h"

namespace calot {

/// Pairs of triangles (lower index first, in order) that come within `tolerance` (m) of each other anywhere
/// but at the corners and edges they share; two triangles on one edge count when folded flat onto each other.
/// Points must be finite, indices in range, triangles not degenerate.
std::vector<std::pair<int, int>> touching_pairs(const TriMesh& mesh, double tolerance);

}  // namespace calot
