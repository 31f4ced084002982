#pragma once
// The skin as other bodies meet it (skin_join.h): the same surface, by fewer of its points where these lie closer than that
// takes.

#include "geometry/stencil.h"

namespace calot {

class Body;

/// Skin points that other bodies meet stand no further apart than this, m, if each of its triangles lets them: a surface
/// 15 mm round lies 0.09 mm beside such triangles, a gallbladder's neck 0.2 mm, of the 0.5 mm in which skins press on each
/// other. At 2 mm a pull in the operating field took a quarter more time, and ended within 0.02 mm^2 of the same triangle.
inline constexpr double met_spacing = 3.2e-3;

struct MetSkin {
  std::vector<Triangle> triangles;  ///< skin points; those of a patch of Body::face_nodes() follow each other
  int each = 0;                     ///< triangles of a patch
  std::vector<double> areas;  ///< m^2 at rest that each skin point stands for; 0 of those that are left out
};
MetSkin met_skin(const Body& body);

/// Triangles of faces that are split evenly into parts^2 each, as split_faces (skin/tessellate.h) orders them, joined to
/// triangles of `step` times the size on some of their points; `step` divides `parts`.
std::vector<Triangle> joined_triangles(const std::vector<Triangle>& split, int parts, int step);

}  // namespace calot
