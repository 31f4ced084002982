#pragma once
// Places on the skins of bodies, between their points.

#include <limits>

#include "body/body.h"
#include "joins/carried_place.h"

namespace calot {

/// The nearest place of a skin.
struct NearestSkin {
  CarriedPlace place;
  double distance = 0;  ///< m, of the skin's triangles: of a rod's its middle line
  double radius = 0;    ///< m, of the surface around it there; 0: the skin is the surface
};

/// Finds them on a body whose skin points lie at `skin`, m; the body must outlive it.
class SkinFinder {
 public:
  SkinFinder(const Body& body, std::vector<Vec3> skin);
  /// Of what lies nearer than `within`, m; no points where nothing does.
  NearestSkin nearest(const Vec3& to, double within = std::numeric_limits<double>::infinity()) const;
  Vec3 at(const CarriedPlace& place) const;  ///< m

 private:
  const Body& body_;
  std::vector<Vec3> skin_;
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< of the patches
  std::vector<double> reaches_;             ///< m, of the triangles from their first corners
};

}  // namespace calot
