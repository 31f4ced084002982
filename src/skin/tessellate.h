#pragma once
// The connectivity of an even, crack-free split of triangles; inner to this room.

#include "geometry/stencil.h"

namespace calot {

/// Each triangle split into parts^2, edges into `parts`. Points: the nodes 0 .. nodes - 1 first, then those
/// on edges and inside triangles in the order in which the triangles meet them. Stencils are left empty.
/// Every node must belong to a triangle.
Tessellation split_faces(int nodes, const std::vector<Triangle>& triangles, int parts);

}  // namespace calot
