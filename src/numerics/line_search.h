#pragma once
// Backtracking on the augmented Lagrangian (Nocedal and Wright, Numerical Optimization, 2nd ed., ch. 17 and 18).

#include "numerics/constrained_energy.h"

namespace calot {

/// What a step begins with.
struct SearchStart {
  const VecX& x;
  const VecX& step;
  const VecX& multipliers;   ///< after the step
  const VecX& dmultipliers;  ///< how they change in it
  const VecX& left;  ///< of the constraints at x, with compliances times the multipliers before the step
  double curvature;  ///< step' K step
};

/// Begins with `share` of the step; returns the share taken, 0 when no decrease was found.
double line_search(const ConstrainedEnergy& problem, const SearchStart& start, double share);

}  // namespace calot
