#include "motion/step_budget.h"

#include <algorithm>
#include <limits>

namespace calot {

StepBudget budget_of(int nodes) {
  constexpr int usual_nodes = 340, most = 40;
  StepBudget out;
  out.begin = std::clamp(out.begin * usual_nodes / std::max(nodes, 1), out.begin, most);
  return out;
}

int left_to_begin(const Field& field, const SolveStatistics& statistics) {
  if (field.step_time == 0) return std::numeric_limits<int>::max();
  return field.budget.begin - statistics.newton_iterations;
}

int left_to_balance(const Field& field, const SolveStatistics& statistics) {
  if (field.step_time == 0) return std::numeric_limits<int>::max();
  return left_to_begin(field, statistics) + field.budget.balance;
}

bool is_spent(const Field& field, const SolveStatistics& statistics) {
  return left_to_begin(field, statistics) <= 0;
}

}  // namespace calot
