#pragma once
// Surfaces of rigid things, as closed meshes whose points stand close enough to be touched by.

#include "geometry/tri_mesh.h"

namespace calot {

/// A box of these edges, m, with edges of radius `rounding` and faces that bulge a little; without edges a ball. Points
/// stand about `spacing` apart, but there are at most 24 along an edge.
TriMesh rounded_box(const Vec3& size, double rounding, const Vec3& centre, double spacing);

/// A rod of radius `rod` (m) bent into a ring about z, whose middle is a circle of this radius (m) about the origin. Point 0
/// lies in the hole, towards +x; points stand about `spacing` apart, and no closer than a sixth of the rod's turn.
TriMesh ring_surface(double radius, double rod, double spacing);

/// The same surface with no edge longer than `longest` (m): edges that are get a point in their middle, again and again.
/// Points stay first, in order. Stops where there are more than `most_triangles`.
TriMesh with_short_edges(TriMesh mesh, double longest, std::size_t most_triangles);

}  // namespace calot
