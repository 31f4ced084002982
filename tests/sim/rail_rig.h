#pragma once
// Stiff tubes that stay where they are, for what is between them.

#include <string>

#include "anatomy/definitions.h"

namespace calot::test {

inline constexpr double rail_height = -100e-3;  // m

/// Along x from -110 to -50 mm, at `y` (m), held at both ends.
inline OrganDefinition rail(const std::string& name, double y) {
  OrganDefinition organ;
  organ.name = name;
  organ.shape =
      TubeShape{.points = {Vec3(-110e-3, y, rail_height), Vec3(-50e-3, y, rail_height)}, .radius = 2e-3};
  organ.wall.thickness = 2e-3;
  organ.wall.shear_modulus = 10e6;
  organ.wall.density = 1050;
  organ.nodes = 8;
  organ.held = {{"start", "start", 5e-3, 1e7}, {"end", "end", 5e-3, 1e7}};
  return organ;
}

}  // namespace calot::test
