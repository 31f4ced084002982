#pragma once

#include <memory>

#include "render/scene.h"

namespace calot {

/// A branch that a tree grows from: its line (m, in the surface's frame, near it) and its radius at the beginning, m.
struct VesselTrunk {
  std::vector<Vec3> line;
  double radius = 0;
};

/// A tree of blood vessels over a closed surface, from its trunks, or without any from where vessels usually enter (the
/// lowest points by z, on either side of the liver's, +x), to everywhere: shortest paths over randomly stretched edges to
/// random points, as wide as the cube root of the number of points they serve (Murray 1926). Trunks lie on the surface
/// where it is nearest to their lines, and taper to half of their radius. Deterministic.
std::shared_ptr<const VesselMap> grow_vessels(const std::vector<Vec3>& rest,
                                              const std::vector<Triangle>& triangles,
                                              const std::vector<VesselTrunk>& trunks = {});

}  // namespace calot
