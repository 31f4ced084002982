#pragma once
// The factor of a Lagrangian's Hessian, bordered by its constraints.

#include <span>

#include "numerics/constrained_energy.h"
#include "numerics/newton_result.h"
#include "numerics/newton_workspace.h"

namespace calot {

/// Whether the last factor can serve this problem's chord steps and predictions.
bool serves(const NewtonWorkspace& work, const ConstrainedEnergy& problem);

/// Assembles and factorises at (x, multipliers), work.border's gradients being those at x; raises a diagonal shift until
/// the matrix is positive definite (an instability is passed by descent on the energy). Status, part, shifts and times
/// go to `result`: a mechanism and constraints that depend on each other are reported.
void factorise(const ConstrainedEnergy& problem, std::span<const Part> parts, const VecX& x,
               const VecX& multipliers, NewtonWorkspace& work, NewtonResult& result);

/// The part that a constraint moves most.
int part_of_constraint(std::span<const Part> parts, const Eigen::MatrixXd& gradients, int constraint);

}  // namespace calot
