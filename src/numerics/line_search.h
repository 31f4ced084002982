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

/// Begins with `share` of the step; returns the share taken, 0 when no decrease was found. `stiffer`: the step is by a
/// matrix that is stiffer than the energy. By such a matrix steps out of a saddle grow by a few per cent each: a whole one
/// is doubled as long as that takes off more, and cut to what is safe, so that the share may be above 1.
double line_search(const ConstrainedEnergy& problem, const SearchStart& start, double share,
                   bool stiffer = false);

}  // namespace calot
