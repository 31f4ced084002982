#pragma once
// Newton's method for a stationary point of an energy under constraints, by bordering, with a line search on the
// augmented Lagrangian (Nocedal and Wright, Numerical Optimization, 2nd ed., ch. 17 and 18).
//
// Converged: of each part, largest nodal residual / largest internal nodal force and largest coordinate of the last
// increment / length, and each constraint / its scale, are within their tolerances. So none hides another. What is
// stiff, lightly loaded and far from the origin may stay further off: where a step by the true tangent is shorter than
// what coordinates are rounded to, no state is nearer to balance.

#include <functional>

#include "numerics/body_energy.h"
#include "numerics/newton_result.h"
#include "numerics/newton_workspace.h"

namespace calot {

struct NewtonSettings {
  double tolerance = 1e-6;              ///< residual and increment, dimensionless
  double constraint_tolerance = 1e-10;  ///< relative
  int max_iterations = 80;
  std::function<bool()> stop{};  ///< asked before each iteration: true ends the solve there; may be empty
};

/// Solves from (x, multipliers), which receive the result; on failure they hold the last iterate.
NewtonResult solve_equilibrium(const ConstrainedEnergy& problem, const NewtonSettings& settings,
                               NewtonWorkspace& workspace, VecX& x, VecX& multipliers);
/// Of a body alone; `multiplier` stays where it is not constrained.
NewtonResult solve_equilibrium(const BodyEnergy& body, const NewtonSettings& settings,
                               NewtonWorkspace& workspace, VecX& x, double& multiplier);

}  // namespace calot
