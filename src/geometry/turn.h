#pragma once
// Rotations between two places of the same points.

#include "geometry/types.h"

namespace calot {

/// The rotation about this axis by its length, rad.
Mat3 turned_about(const Vec3& turn);

using Points3 = Eigen::Ref<const Eigen::Matrix3Xd>;  ///< a point a column

/// The rotation R for which R `from` comes nearest to `to` but for a shift, by the sum of squared distances (Kabsch
/// 1976). As many columns in both, at least one; where they leave it open, one of the best.
Mat3 best_turn(const Points3& from, const Points3& to);

/// The vector w, rad, for which turns w x (at - middle) come nearest to `motions` but for a shift, by the sum of squared
/// distances. As many columns in both, at least one; where they leave it open, next to 0 about that axis.
Vec3 best_spin(const Points3& at, const Points3& motions);

/// Root of the mean squared distance of the points from their middle.
double spread_of(const Points3& points);

}  // namespace calot
