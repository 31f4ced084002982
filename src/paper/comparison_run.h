#pragma once
// Timed motions of the comparison's bodies.

#include <string>
#include <vector>

#include "paper/comparison.h"

namespace calot {

double median(std::vector<double> values);

const char* name_of(FactorKind kind);
/// Those that make sense for a body of this size.
std::vector<FactorKind> solvers_of(const ComparedBody& body, bool extended);

/// Seconds of one factorisation and solve of each of the body's systems by whatever is fastest; 0 where none
/// succeeds.
double fastest_factor_and_solve(const ComparedBody& body, bool extended);

struct ComparedRun {
  std::string status = "converged";  ///< else what failed
  std::vector<double> times_s;       ///< of each step
  int iterations = 0;
  std::vector<Vec3> displacements;  ///< at the end of the way out; empty where it was not reached
};

/// Out and back by equal steps, given.cycles times. After given.patience s it is cut short, `to_the_end` not before it
/// has been out once; given.stop ends it at once, as not converged.
ComparedRun run_out_and_back(ComparedBody& body, const ComparedLoad& load, FactorKind solver, int steps_out,
                             const ComparisonCase& given, bool to_the_end);

}  // namespace calot
