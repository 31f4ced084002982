#include "numerics/newton_result.h"

#include <algorithm>

namespace calot {

void NewtonResult::add(const NewtonResult& next) {
  const NewtonResult before = *this;
  *this = next;
  iterations += before.iterations;
  if (next.chords == next.iterations) by_last_factor += before.by_last_factor;
  chords += before.chords;
  factorisations += before.factorisations;
  shifts += before.shifts;
  furthest.resize(std::max(furthest.size(), before.furthest.size()));
  for (std::size_t p = 0; p < before.furthest.size(); ++p) furthest[p] += before.furthest[p];
  assembly_s += before.assembly_s;
  factorisation_s += before.factorisation_s;
  solve_s += before.solve_s;
  safety_s += before.safety_s;
  sharp_s += before.sharp_s;
}

std::string to_text(NewtonStatus status) {
  switch (status) {
    case NewtonStatus::converged:
      return "converged";
    case NewtonStatus::not_finite:
      return "a value is not finite";
    case NewtonStatus::mechanism:
      return "nothing holds the body against a rigid motion";
    case NewtonStatus::dependent_constraints:
      return "a volume cannot be kept beside the others";
    case NewtonStatus::stalled:
      return "no step lowers the energy any more";
    case NewtonStatus::iteration_limit:
      return "the iteration limit was reached";
    case NewtonStatus::out_of_memory:
      return "out of memory";
    case NewtonStatus::stopped:
      return "stopped";
  }
  return "unknown";
}

}  // namespace calot
