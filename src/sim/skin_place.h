#pragma once
// Places on the skins of bodies, between their points.

#include "sim/joint.h"

namespace calot {

/// The nearest place of a skin.
struct NearestSkin {
  CarriedPlace place;
  double distance = 0;  ///< m, of the skin's triangles: of a rod's its middle line
  double radius = 0;    ///< m, of the surface around it there; 0: the skin is the surface
};
/// Of a body whose skin points lie at `skin`, m.
NearestSkin nearest_on_skin(const Body& body, const std::vector<Vec3>& skin, const Vec3& to);

}  // namespace calot
