#pragma once

#include "geometry/tri_mesh.h"

namespace calot {

/// How often a closed surface of outward triangles goes around p: 1 inside, 0 outside, to rounding; between these near
/// an opening. Not to be asked of a point on the surface.
double winding_number(const Vec3& p, const std::vector<Vec3>& points, const std::vector<Triangle>& triangles);

}  // namespace calot
