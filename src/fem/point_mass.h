#pragma once
// The mass of a wall or a rod, at points of it.

#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

/// Masses at the rows of a stencil table: M, by the nodes' motions. An implicit Euler step of h seconds from x0 with the
/// velocity v has the energy 1 / (2 h^2) (x - xhat)' M (x - xhat), xhat = x0 + h v: energy((x - xhat) / h), with the
/// gradient add_product(x - xhat, 1 / h^2) and the Hessian add_hessian(1 / h^2), which no step changes.
struct PointMass {
  std::vector<double> mass;  ///< kg, of each row of the table

  double total() const;  ///< kg
  /// 1/2 sum of mass |motion|^2, `motion` 3 a node: J of velocities in m/s.
  double energy(const StencilTable& table, const VecX& motion) const;
  /// Adds scale M motion to `out`, 3 a node.
  void add_product(const StencilTable& table, const VecX& motion, double scale, VecX& out) const;
  /// Adds scale M.
  void add_hessian(const StencilTable& table, double scale, BlockMatrix& matrix) const;
  /// Adds the weight, N, at an acceleration of gravity, m/s^2, to a load: minus the gradient of its energy.
  void add_weight(const StencilTable& table, const Vec3& gravity, VecX& load) const;

  /// kg m/s, of nodal velocities in m/s.
  Vec3 momentum(const StencilTable& table, const VecX& velocity) const;
  /// About the origin, kg m^2/s.
  Vec3 angular_momentum(const StencilTable& table, const VecX& x, const VecX& velocity) const;
};

}  // namespace calot
