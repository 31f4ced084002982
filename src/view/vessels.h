#pragma once

#include <memory>

#include "render/scene.h"

namespace calot {

/// A tree of blood vessels over a closed surface, from where the vessels enter (the lowest points by z, on
/// either side of the liver's, +x) to everywhere: shortest paths over randomly stretched edges to random
/// points, as wide as the cube root of the number of points they serve (Murray 1926). Deterministic.
std::shared_ptr<const VesselMap> grow_vessels(const std::vector<Vec3>& rest,
                                              const std::vector<Triangle>& triangles);

}  // namespace calot
