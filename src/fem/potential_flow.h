#pragma once
// The flow of an ideal liquid (incompressible, without friction) in a closed surface that moves.

#include "base/status.h"
#include "geometry/stencil.h"

namespace calot {

/// The liquid answers the surface's normal velocity q by a potential flow, whose kinetic energy is 1/2 density
/// b' A^-1 b with b_k = integral of h_k q and A_kl = integral of h_k dh_l/dn over the surface, for harmonic polynomials
/// h_k of degree 1 to 3 (Trefftz's method). It moves as a rigid body with a surface that translates, and does not turn
/// with a sphere that turns; motions finer than degree 3 feel too little of it.
struct PotentialFlow {
  static constexpr int linear = 3;      ///< harmonics of degree 1: x, y, z
  static constexpr int harmonics = 15;  ///< with those of degree 2 (5) and 3 (7)

  Eigen::MatrixXd flow;     ///< column k: h_k integrated with each node's normal motion, 3 rows a node
  Eigen::MatrixXd kinetic;  ///< A; symmetric but for what the triangles are off the surface

  /// Of the surface that `triangles`, closed and outward, make of the rows of `points` at x (3 a node, m). `length`, m,
  /// half the surface's: keeps the degrees comparable.
  static PotentialFlow inside(const StencilTable& points, const std::vector<Triangle>& triangles,
                              const VecX& x, double length);
  /// A, symmetric.
  Eigen::MatrixXd energy() const { return 0.5 * (kinetic + kinetic.transpose()); }
};

/// What is left of the flow beside a liquid that moves with its centroid: its energy is 1/2 density |modes' motion|^2,
/// for nodal velocities `motion`, and none where these are a translation.
struct FlowModes {
  static constexpr int count = PotentialFlow::harmonics - PotentialFlow::linear;

  Eigen::MatrixXd columns;  ///< one a mode, 3 rows a node, m^(3/2)

  /// As PotentialFlow's. Fails (simulation) where the triangles are too coarse to tell.
  static Result<FlowModes> inside(const StencilTable& points, const std::vector<Triangle>& triangles,
                                  const VecX& x, double length);
};

}  // namespace calot
