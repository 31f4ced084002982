#pragma once
// Edges of surfaces that meet each other: what points against triangles leave out, of one skin or of two.

#include <optional>
#include <span>
#include <vector>

#include "collision/edge_crossing.h"
#include "collision/skin_contact.h"

namespace calot {

/// The edges of a surface of triangles at rest: what does not change of them.
struct SurfaceEdges {
  std::vector<std::array<int, 2>> ends;   ///< points, increasing; ordered
  std::vector<double> lengths, areas;     ///< m; m^2, a third of the triangles at it
  std::vector<std::array<int, 3>> sides;  ///< of each triangle: its edges; of those left out nothing
  std::vector<int> triangle;              ///< the first at each edge
  double longest = 0;                     ///< m

  /// `rest`: points, m; `counts`: 0 of triangles that are left out; empty: none is.
  SurfaceEdges(const std::vector<Vec3>& rest, const std::vector<Triangle>& triangles,
               std::span<const char> counts = {});
  std::vector<Vec3> middles(const std::vector<Vec3>& points) const;
};

/// Where they are and, if given, how they are to move.
struct PlacedEdges {
  const SurfaceEdges* edges = nullptr;
  const std::vector<Vec3>* points = nullptr;   ///< m
  const std::vector<Vec3>* motions = nullptr;  ///< m
};

/// Two edges, of one surface or of two.
struct EdgesNear {
  int edge = 0, other = 0;
  double distance = 0;  ///< m, when it was gathered; 0 of those on a way
};

/// Their ends: points.
std::array<int, 4> ends_of(const SurfaceEdges& one, const SurfaceEdges& other, const EdgesNear& pair);
/// And where these are, m.
EdgePair places_of(const PlacedEdges& one, const PlacedEdges& other, const EdgesNear& pair);

/// All pairs looked for, among the edges in the trees (by their middles at rest); ordered.
std::vector<EdgesNear> near_edges(const PlacedEdges& one, const ItemTree& of_one, const PlacedEdges& other,
                                  const ItemTree& of_other, const SkinReach& looked_for,
                                  Workers* workers = nullptr);

/// An edge of one skin that goes through a triangle of another: a simplex of that.
struct PiercedTriangle {
  int edge = 0, simplex = 0;
  Vec3 place = Vec3::Zero();  ///< m, where
};
/// All of them among the edges in the tree; ordered by edge.
std::vector<PiercedTriangle> pierced_triangles(const PlacedEdges& one, const ItemTree& of_one,
                                               const PlacedSkin& other);

/// Two edges that press on each other.
struct EdgeTouch {
  std::array<int, 4> ends{};  ///< points, as in EdgePair
  EdgeCrossing::Sample sample;
  double area = 0;  ///< m^2 that it counts for
};
/// None: they do not.
std::optional<EdgeTouch> edge_touch(const PlacedEdges& one, const PlacedEdges& other, const EdgesNear& pair,
                                    const Barrier& barrier);

/// What is left of a share of the motions when the pair keeps the share `keep` (0 to 1) of its distance, or of `most` (m)
/// if that is less, all the way.
double safe_share(const PlacedEdges& one, const PlacedEdges& other, const EdgesNear& pair, double keep,
                  double share, double most = std::numeric_limits<double>::infinity());

}  // namespace calot
