#pragma once
// The skin of a body whose surface is a Loop surface: how it is laid over the control nodes.

#include "skin/subdivision.h"

namespace calot {

/// The coarsest tessellation of an even number of parts whose points stand no further apart than `spacing` (m) at rest, or
/// the finest that is allowed.
Tessellation close_skin(const LoopSurface& surface, const VecX& rest, double spacing);

/// Into how many parts each edge is split where each face has so many triangles.
int parts_of(int triangles_each);

/// Of each point, a third of the areas of its triangles.
std::vector<double> lumped(const std::vector<double>& areas, const std::vector<Triangle>& triangles,
                           std::size_t points);

/// Points of each face's triangles, each once, increasing.
std::vector<std::vector<int>> points_of_faces(const Tessellation& skin, std::size_t faces);
/// Adds the nodes from `first` on that skin points depend on to `nodes`, which has those before. `seen`: one a node from
/// `first` on, 0 before and after.
void add_nodes(const StencilTable& skin, const std::vector<int>& points, int first, std::vector<char>& seen,
               std::vector<int>& nodes);

}  // namespace calot
