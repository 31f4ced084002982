#pragma once
// Where a body's skin is and how far it moves, at a cost of its nodes alone: most bodies of a group are too far apart to
// meet, and their skins need not be looked at.

#include <span>

#include "body/body.h"

namespace calot {

/// How a skin's points move, m: by what is in the box (of the motion itself), and by `further` beside.
struct SkinMoves {
  Eigen::AlignedBox3d box;
  double further = 0;
};

/// Of one body.
struct SkinBounds {
  Eigen::AlignedBox3d box;  ///< m, around all skin points at x
  SkinMoves motion;         ///< of a step from there; empty: none
};

/// Around all skin points, m. `x`: coordinates of the body's nodes.
Eigen::AlignedBox3d skin_box(const Body& body, const VecX& x);
/// Of the points that hang on these nodes; without them, of all. `dx`: motion of the body's nodes, m.
SkinMoves skin_motion(const Body& body, const VecX& dx);
SkinMoves skin_motion(const Body& body, const VecX& dx, std::span<const int> nodes);
/// Bound on how much any points of the two come nearer, m.
double approach_of(const SkinMoves& one, const SkinMoves& other);

}  // namespace calot
