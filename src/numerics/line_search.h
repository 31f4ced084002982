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
/// Of a whole step that line_search() has taken, by a matrix that is stiffer than the energy: the share to take instead, 1
/// or more. By such a matrix steps out of a saddle grow by a few per cent each: they are doubled as long as that takes off
/// more, and cut to what is safe.
double lengthen(const ConstrainedEnergy& problem, const SearchStart& start);

}  // namespace calot
