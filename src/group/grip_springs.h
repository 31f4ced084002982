#pragma once
// What holds skin points to the pads of jaws, during one solve.

#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

/// A spring a point. One with a pad presses against that with its stiffness, but is not drawn off it, as nothing adheres
/// to a pad; along the pad it holds either way.
struct GripSprings {
  std::vector<int> row;           ///< of the stencil table
  std::vector<Vec3> target;       ///< m
  std::vector<double> stiffness;  ///< N/m
  std::vector<Vec3> pad = {};     ///< unit, into the pad, one a spring; or none: tied in every direction

  struct Sample {
    double energy = 0;             ///< J
    Vec3 gradient = Vec3::Zero();  ///< N, of the point on what holds it
    Mat3 hessian = Mat3::Zero();   ///< N/m, positive semidefinite
  };
  /// Of a spring whose point is at `at`; C2, as the stiffness across a pad comes over the first 20 um of the way into it.
  Sample sample(std::size_t spring, const Vec3& at) const;

  double value(const StencilTable& table, const VecX& x) const;  ///< J
  void add_gradient(const StencilTable& table, const VecX& x, VecX& gradient) const;
  void add_hessian(const StencilTable& table, const VecX& x, BlockMatrix& matrix) const;
};

}  // namespace calot
