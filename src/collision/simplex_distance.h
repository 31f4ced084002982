#pragma once
// Distance of a point from a point, a segment or a triangle that moves as well: what two walls need that meet each
// other.

#include <array>
#include <span>

#include "geometry/types.h"

namespace calot {

/// Nearest point of a simplex of one to three corners: its weights sum to 1, and those of corners that it does not
/// lie between are 0. A triangle without an area counts as its edges.
struct NearestPoint {
  std::array<double, 3> weight{};
  double distance = 0;  ///< m
};
NearestPoint nearest_point(const Vec3& p, std::span<const Vec3> corners);

/// Distance of p from the flat (point, line or plane) through one to three corners, which must span it. Where the
/// nearest point of a simplex lies between all its corners this is the distance from the simplex; elsewhere that
/// from the flat of the corners it does lie between. So distances from simplices are made of it, C1 where they are
/// not 0, as the distance from a convex set is.
struct FlatSample {
  double distance = 0;            ///< m, not negative
  Vec3 normal = Vec3::Zero();     ///< unit, from the nearest point to p; zero on the flat
  std::array<double, 4> weight{}; /**< 1 for p and minus the weights of the corners: weight[k] * normal is the
                                       distance's gradient by p and by the corners (the weights minimise it, so
                                       their own change does not matter) */
};
FlatSample sample_flat(const Vec3& p, std::span<const Vec3> corners);
/// Hessian of that distance by p and the corners in this order, 1/m; the rows of corners that are not there are 0.
/// `sample` is of the same places, its distance > 0.
Eigen::Matrix<double, 12, 12> flat_hessian(std::span<const Vec3> corners, const FlatSample& sample);

/// The largest share (0 to 1, to 1e-9 of the motion) of the straight motions of p and of the corners such that for
/// every share s up to it distance(s) >= keep * distance(0), 0 < keep < 1: conservative advancement, as
/// safe_share() of a shape. Touching at the start, or a value that is not finite, gives 0. With a thickness, m, the sum
/// of the radii of a ball about p and of one swept over the simplex, the gap keeps its share: the distance less that.
double safe_share(const Vec3& p, const Vec3& motion, std::span<const Vec3> corners,
                  std::span<const Vec3> corner_motions, double keep, double thickness = 0);

}  // namespace calot
