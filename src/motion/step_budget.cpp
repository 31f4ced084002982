#include "motion/step_budget.h"

#include <limits>

namespace calot {

bool is_spent(const Field& field, const SolveStatistics& statistics) {
  return field.step_time > 0 && statistics.newton_iterations + statistics.substeps >= field.budget.begin;
}

int left_to_balance(const Field& field, const SolveStatistics& statistics) {
  if (field.step_time == 0) return std::numeric_limits<int>::max();
  return field.budget.begin + field.budget.balance - statistics.newton_iterations - statistics.substeps;
}

}  // namespace calot
