#pragma once
// A triangulated surface or a line of segments near a point as corners, edges and faces, so that a potential of their
// distances neither depends on how it is cut into triangles or segments nor has a kink.

#include <vector>

#include "geometry/types.h"

namespace calot {

/// A corner, edge or face and how often it counts.
struct SurfacePart {
  std::array<int, 3> corner{-1, -1, -1};  ///< points, increasing; the unused are -1
  int corners = 0;
  int times = 0;  ///< may be negative
};

/// The parts of a surface near p: those that its triangles' nearest points lie on, without those that cancel. Every
/// triangle counts once, every inner edge -1 times and every inner corner once, each where its own nearest point
/// lies. A potential b(distance) summed so is b once above a flat, where the sum over triangles alone has it as
/// often as triangles are near, and as smooth as b and the distance from one triangle are (Li et al. 2023,
/// Convergent Incremental Potential Contact, arXiv 2307.15908, the sum over faces less edges plus vertices).
/// `faces`: all triangles nearer to p than `range`, corners increasing; `points`: the surface's, m. Ordered by corners.
std::vector<SurfacePart> surface_parts(const Vec3& p, const std::vector<Triangle>& faces,
                                       const std::vector<Vec3>& points, double range);

/// The same of lines: every segment counts once, every corner but the ends of lines so often less as segments meet at
/// it. `segments`: all that are nearer to p than `range`, corners increasing.
std::vector<SurfacePart> line_parts(const Vec3& p, const std::vector<std::array<int, 2>>& segments,
                                    const std::vector<Vec3>& points, double range);

}  // namespace calot
