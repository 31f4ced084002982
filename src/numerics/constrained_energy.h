#pragma once
// What Newton's method makes stationary: the energy of one body or of a group of them, with volumes that are kept.

#include <memory>

#include "base/workers.h"
#include "numerics/block_matrix.h"
#include "numerics/parts.h"
#include "numerics/sharp_terms.h"

namespace calot {

struct NewtonWorkspace;

/// L(x, m) = energy(x) - sum of (m_k * constraint_k(x) + e_k / 2 * m_k^2), to be made stationary in x and m: each
/// constraint_k(x) + e_k m_k = 0. A compliance e_k = 0 keeps its constraint; e_k > 0 lets it give way, as a spring does:
/// m_k = -constraint_k / e_k, and x is where energy + sum of constraint_k^2 / (2 e_k) is stationary, without that
/// energy's full matrix, however small e_k is.
class ConstrainedEnergy {
 public:
  virtual ~ConstrainedEnergy() = default;
  /// The bodies: each node is in one of them.
  virtual std::vector<Part> parts() const = 0;
  /// How many, >= 0; where there are none, none of the functions of them is called.
  virtual int constraints() const = 0;
  /// J; infinite where x is not admissible.
  virtual double value(const VecX& x) const = 0;
  /// Size of what cancels in value() and is not in a constraint, J: it is rounded like this.
  virtual double cancelling() const { return 0; }
  /// Gradient (N, 3 a node); `largest_internal` receives, for each part, the largest nodal force of its elastic
  /// energies (N): the scale of its residual.
  virtual void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const = 0;
  /// Hessian of L into `matrix` (values are overwritten).
  virtual void hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const = 0;
  /// Adds to a matrix that holds hessian() at x what makes its concave terms convex, where the terms say what that is: then
  /// a matrix that was indefinite by them alone is no more. Whether anything was added.
  virtual bool add_convexity(const VecX& /*x*/, BlockMatrix& /*matrix*/) const { return false; }
  /// Constraints and their gradients, a column each.
  virtual void constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const = 0;
  virtual VecX constraint_values(const VecX& x) const = 0;
  /// gradient() and constraint() at once, for where they share what they are made of.
  virtual void gradient_and_constraint(const VecX& x, VecX& of_energy, VecX& largest_internal, VecX& values,
                                       Eigen::MatrixXd& of_constraints) const {
    gradient(x, of_energy, largest_internal);
    constraint(x, values, of_constraints);
  }
  /// Scales of the constraints (the kept volumes), > 0.
  virtual VecX constraint_scales() const = 0;
  /// e_k, >= 0, in units of a constraint over its multiplier's.
  virtual VecX compliances() const { return VecX::Zero(constraints()); }
  /// Called before a tangent is asked for, and before the first step of a solve that does not begin in balance: makes
  /// room in the matrix for what the solve may couple.
  virtual void prepare(NewtonWorkspace&) const {}
  /// A step from x to where it leads along the ways that bodies really go, the same to first order: what turns as a whole is
  /// strained by a straight step.
  virtual VecX curved(const VecX& /*x*/, VecX step) const { return step; }
  /// Largest share (0 to 1] of the step that is safe to take (nothing crosses).
  virtual double safe_share(const VecX& x, const VecX& step) const = 0;
  /// Of a step that serves whole or not at all: that share where it is 1, else a share below 1 that is no less, which may
  /// cost less.
  virtual double share_if_whole(const VecX& x, const VecX& step) const { return safe_share(x, step); }
  /// x, but those nodes that can be brought into balance one by one, while all others stay, are: energy does not rise, and nothing is crossed.
  /// Each place that a solve goes on from, or tries, is such a one.
  virtual VecX relaxed(VecX x) const { return x; }
  /// What those of its terms that bend sharply add to hessian() at x; `convex`: to that with add_convexity(), too.
  virtual std::vector<SharpTangent> sharp_tangents(const VecX& /*x*/, bool /*convex*/) const { return {}; }
  /// Those of them whose forces at x + step are off what these tangents say by more than `least`, N. Null: none. The energy
  /// must outlive them.
  virtual std::unique_ptr<const SharpTerms> sharp_terms(const VecX& /*x*/, const VecX& /*step*/,
                                                        double /*least*/,
                                                        std::span<const SharpTangent> /*tangents*/) const {
    return nullptr;
  }
  /// Who share the work of a solve; none: the caller's thread does it.
  virtual Workers* workers() const { return nullptr; }
};

}  // namespace calot
