#pragma once
// The factor of a Lagrangian's Hessian, bordered by its constraints.

#include <span>

#include "numerics/constrained_energy.h"
#include "numerics/newton_result.h"
#include "numerics/newton_workspace.h"

namespace calot {

/// How the matrices of one solve came to be positive definite, from one iteration to the next.
struct Definiteness {
  /// Matrices in a row that were begun with their concave terms made convex; the one after the second of them is tried as
  /// it is.
  int convex = 0;
  double shift = 0;  ///< of the last matrix' diagonal, share of its parts' mean stiffness; 0: none
};

/// Whether the last factor can serve this problem's chord steps and predictions.
bool serves(const NewtonWorkspace& work, const ConstrainedEnergy& problem);

/// Assembles and factorises at (x, multipliers), work.border's gradients being those at x. Of a matrix that is not positive
/// definite the concave terms are made convex (add_convexity()); where that does not suffice its diagonal is shifted, from
/// about the last shift on, until it is (an instability is passed by descent on the energy). Status, part, shifts and times
/// go to `result`: a mechanism and constraints that depend on each other are reported.
void factorise(const ConstrainedEnergy& problem, std::span<const Part> parts, const VecX& x,
               const VecX& multipliers, Definiteness& definiteness, NewtonWorkspace& work,
               NewtonResult& result);

/// The part that a constraint moves most.
int part_of_constraint(std::span<const Part> parts, const Eigen::MatrixXd& gradients, int constraint);

}  // namespace calot
