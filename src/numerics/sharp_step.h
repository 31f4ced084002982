#pragma once
// A Newton step that asks what bends sharply as it is, and only the rest by its tangent (a proximal Newton step: Lee, Sun
// and Saunders 2014, doi 10.1137/130921428). Newton's own step asks contact by its tangent too: of a wall that lies a
// tenth as far from a jaw as it comes to rest it at best doubles the distance, and takes four factorisations to get there.

#include "numerics/constrained_energy.h"
#include "numerics/newton_workspace.h"

namespace calot {

/// A step that a factor gave, with its constraints kept.
struct SharpStart {
  const VecX& x;
  const VecX& step;
  double residual = 0;  ///< N, the largest node's at x: what the step is to balance
};

/// The load, N, 3 a node, whose answer by the last factor is to be added to a step u. Of terms S that are off their
/// tangents in that factor by more than `least`, N, and a matrix H of all that it is of, the step y so found makes
///     1/2 (y - u)' H (y - u) + S(x + y) - S(x) - S'(x) y - 1/2 y' S''y
/// least, S'' being those tangents. Empty where there are none, or so many that an iteration costs less, or where that least is
/// not found soon.
VecX sharp_load(const ConstrainedEnergy& problem, const NewtonWorkspace& workspace, const SharpStart& start,
                double least);

}  // namespace calot
