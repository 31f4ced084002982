#include "motion/step_budget.h"

#include <limits>

namespace calot {

int left_of_budget(const Field& field, const SolveStatistics& statistics) {
  if (field.step_time == 0) return std::numeric_limits<int>::max();
  return field.step_budget - statistics.newton_iterations - statistics.substeps;
}

}  // namespace calot
