#pragma once
// Damping of an elastic energy E by retardation, after Kelvin and Voigt: its forces are those at x + tau dx/dt.

#include "numerics/block_matrix.h"

namespace calot {

/// For an implicit Euler step of h seconds from `begin`: 1 / (1 + b) E(x + b (x - begin)), b = tau / h. Its gradient is
/// that of E, and its Hessian 1 + b times that of E, at x + b (x - begin).
///
/// A small vibration of w rad/s has the loss tangent w tau. Rest is where it was, a translation is not damped; a turn of
/// a body by the angle a in a step strains it as if it had grown by 1/2 b (1 + b) a^2.
class Retardation {
 public:
  /// tau >= 0 and h > 0 in s; `begin` must outlive it.
  Retardation(double tau, double h, const VecX& begin) : ahead_(tau / h), begin_(begin) {}

  /// x + b (x - begin): where to ask the energy and its derivatives.
  VecX lead(const VecX& x) const { return ahead_ == 0 ? x : VecX(x + ahead_ * (x - begin_)); }
  double value_factor() const { return 1 / (1 + ahead_); }
  double hessian_factor() const { return 1 + ahead_; }

  /// The same of an energy with value(x), add_gradient(x, gradient) and add_hessian(x, matrix).
  template <class Energy>
  double value(const Energy& energy, const VecX& x) const {
    return value_factor() * energy.value(lead(x));
  }
  template <class Energy>
  void add_gradient(const Energy& energy, const VecX& x, VecX& gradient) const {
    energy.add_gradient(lead(x), gradient);
  }
  /// Overwrites the matrix: what else it holds is to be added after.
  template <class Energy>
  void hessian(const Energy& energy, const VecX& x, BlockMatrix& matrix) const {
    matrix.set_zero();
    energy.add_hessian(lead(x), matrix);
    matrix.scale(hessian_factor());
  }

 private:
  double ahead_;  ///< b
  const VecX& begin_;
};

}  // namespace calot
