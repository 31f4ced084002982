#include "motion/step_budget.h"

#include <limits>

namespace calot {

namespace {

int begins(const Field& field) { return field.tools_move ? field.budget.begin : field.budget.still; }

}  // namespace

bool is_spent(const Field& field, const SolveStatistics& statistics) {
  return field.step_time > 0 && statistics.newton_iterations >= begins(field);
}

int left_to_balance(const Field& field, const SolveStatistics& statistics) {
  if (field.step_time == 0) return std::numeric_limits<int>::max();
  return begins(field) + field.budget.balance - statistics.newton_iterations;
}

}  // namespace calot
