#pragma once
// A triangle mesh and the checks at its door.

#include <array>
#include <string>
#include <vector>

#include "base/status.h"
#include "geometry/types.h"

namespace calot {

struct TriMesh {
  std::vector<Vec3> points;         ///< m
  std::vector<Triangle> triangles;  ///< indices into points, counter-clockwise seen from outside
};

struct MeshRequirements {
  bool closed = true;  ///< each edge in two triangles, outward orientation; false allows a boundary
  /// Edges at one point: the cost of a subdivision surface grows with the third power of the most.
  int most_edges_at_a_point = 40;
  int counted_from = 0;        ///< by messages, points and triangles: 1 for an OBJ file
  bool unused_points = false;  ///< there may be points that no triangle uses
};

/// Every reason why the mesh cannot be a control mesh, each with the triangles or points concerned: not
/// finite, index out of range, unused point, degenerate triangle, non-manifold edge or vertex, inconsistent
/// winding, open boundary, inside out, self-touching; or too many edges at a point, alone. Empty when the mesh is good.
std::vector<Problem> check(const TriMesh& mesh, const MeshRequirements& requirements = {});

/// Points that no triangle uses, increasing, and the mesh without them. Indices must be in range.
std::vector<int> unused_points(const TriMesh& mesh);
TriMesh without_unused_points(const TriMesh& mesh);

/// Signed volume of a closed mesh, m^3; positive when triangles face outward.
double enclosed_volume(const TriMesh& mesh);

/// m^2, of each triangle.
std::vector<double> areas_of(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles);

/// Length of the shortest edge at each point, m; infinite at a point of no triangle.
std::vector<double> shortest_edges(const TriMesh& mesh);

/// Index of the point that lies nearest to a place, the first of equals; there must be one.
int nearest_of(const std::vector<Vec3>& points, const Vec3& place);

/// One split of every triangle into four with new points at edge midpoints (points stay first, in order).
TriMesh split_edges(const TriMesh& mesh);

}  // namespace calot
