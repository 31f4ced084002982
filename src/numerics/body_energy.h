#pragma once
// The energy of a body alone, with at most one liquid, and as the problem of a group of one.

#include <limits>

#include "numerics/constrained_energy.h"

namespace calot {

/// L(x, m) = energy(x) - m * constraint(x), to be made stationary in x with constraint(x) = 0.
class BodyEnergy {
 public:
  virtual ~BodyEnergy() = default;
  virtual bool constrained() const = 0;
  /// J; infinite where x is not admissible.
  virtual double value(const VecX& x) const = 0;
  /// Gradient (N, 3 a node); `largest_internal` receives the largest nodal force of the elastic part (N): the
  /// scale of a residual.
  virtual void gradient(const VecX& x, VecX& gradient, double& largest_internal) const = 0;
  /// Hessian of L into `matrix` (values are overwritten).
  virtual void hessian(const VecX& x, double multiplier, BlockMatrix& matrix) const = 0;
  /// Constraint and its gradient; not called when unconstrained.
  virtual double constraint(const VecX& x, VecX& gradient) const = 0;
  virtual double constraint_value(const VecX& x) const = 0;
  /// gradient() and constraint() at once, for where they share what they are made of.
  virtual double gradient_and_constraint(const VecX& x, VecX& of_energy, double& largest_internal,
                                         VecX& of_constraint) const {
    gradient(x, of_energy, largest_internal);
    return constraint(x, of_constraint);
  }
  /// Scale of the constraint (the kept volume), > 0.
  virtual double constraint_scale() const = 0;
  /// How many of the first nodes of x are places, if not all; the others are displacements added to them.
  virtual int places() const { return std::numeric_limits<int>::max(); }
  /// Size of the body, m: the scale of an increment.
  virtual double length_scale() const = 0;
  /// As ConstrainedEnergy's.
  virtual void prepare(NewtonWorkspace&) const {}
  virtual double safe_share(const VecX& x, const VecX& step) const = 0;
};

/// A body with nodes at x as a group of one. `multiplier`: of the work that value() holds where it is prescribed.
class LoneBody : public ConstrainedEnergy {
 public:
  LoneBody(const BodyEnergy& body, const VecX& x, double multiplier)
      : body_(body), nodes_(static_cast<int>(x.size()) / 3), multiplier_(multiplier) {}

  /// One, or none.
  VecX multipliers() const { return VecX::Constant(constraints(), multiplier_); }

  std::vector<Part> parts() const override;
  int constraints() const override { return body_.constrained() ? 1 : 0; }
  double value(const VecX& x) const override { return body_.value(x); }
  double cancelling() const override;
  void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const override;
  void hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const override;
  void constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const override;
  VecX constraint_values(const VecX& x) const override;
  void gradient_and_constraint(const VecX& x, VecX& of_energy, VecX& largest_internal, VecX& values,
                               Eigen::MatrixXd& of_constraints) const override;
  VecX constraint_scales() const override { return VecX::Constant(1, body_.constraint_scale()); }
  void prepare(NewtonWorkspace& work) const override { body_.prepare(work); }
  double safe_share(const VecX& x, const VecX& step) const override { return body_.safe_share(x, step); }

 private:
  const BodyEnergy& body_;
  int nodes_;
  double multiplier_;
};

}  // namespace calot
