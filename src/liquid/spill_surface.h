#pragma once
// The points at which films are counted.

#include "collision/shapes.h"
#include "field/spilled.h"

namespace calot {

/// Of a skin, with the areas of its points, m^2.
WetMesh wet_mesh(const std::vector<Triangle>& triangles, std::vector<double> areas);

/// Of what stays: points 1.3 mm apart or, on large shapes, as many as there may be. `about`: the middle of what is met of
/// a plane, m.
WetMesh wet_ground(const Shape& shape, const Vec3& about);

}  // namespace calot
