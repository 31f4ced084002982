#include "numerics/secant_steps.h"

namespace calot {

void SecantSteps::add(VecX step, VecX dmultipliers) {
  const double squared = step.squaredNorm();
  steps_.push_back({std::move(step), std::move(dmultipliers), squared});
}

void SecantSteps::correct(VecX& step, VecX& dmultipliers) const {
  constexpr double least = 0.25;  // a step is not believed to be longer than four of the old factor's
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const double along = steps_[k].x.dot(step) / steps_[k].squared;
    if (k + 1 < steps_.size()) {
      step += along * steps_[k + 1].x;
      dmultipliers += along * steps_[k + 1].multipliers;
    } else {
      const double stretch = 1.0 / std::max(1.0 - along, least);
      step *= stretch;
      dmultipliers *= stretch;
    }
  }
}

}  // namespace calot
