#include "numerics/line_search.h"

#include <cmath>

namespace calot {
namespace {

/// phi = energy + sum of (penalty / 2 * constraint^2 - multiplier * constraint).
struct Merit {
  const VecX& multipliers;
  VecX penalties;

  double at(double energy, const VecX& constraints) const {
    double sum = energy;
    for (Eigen::Index k = 0; k < penalties.size(); ++k)
      sum = sum - multipliers[k] * constraints[k] + 0.5 * penalties[k] * constraints[k] * constraints[k];
    return sum;
  }
  double slope(double curvature, const VecX& constraints) const {
    double sum = -curvature;
    for (Eigen::Index k = 0; k < penalties.size(); ++k) sum -= penalties[k] * constraints[k] * constraints[k];
    return sum;
  }
};

/// Large enough that the bordered step descends whatever the curvature along it.
VecX penalties(const SearchStart& start, const VecX& scales) {
  VecX out(scales.size());
  double squared = 0;
  for (Eigen::Index k = 0; k < out.size(); ++k) squared += start.constraints[k] * start.constraints[k];
  for (Eigen::Index k = 0; k < out.size(); ++k) {
    out[k] = (std::abs(start.multipliers[k]) + 1.0) / scales[k];
    if (squared > 0) out[k] = std::max(out[k], 2.0 * std::max(0.0, -start.curvature) / squared);
  }
  return out;
}

}  // namespace

double line_search(const ConstrainedEnergy& problem, const SearchStart& start, double share) {
  const bool constrained = problem.constraints() > 0;
  const VecX scales = constrained ? problem.constraint_scales() : VecX();
  const Merit merit{start.multipliers, penalties(start, scales)};
  const double slope = merit.slope(start.curvature, start.constraints);
  const double energy = problem.value(start.x);
  const double before = merit.at(energy, start.constraints);
  // Differences below the rounding of the sum cannot be judged.
  double terms = std::abs(energy) + problem.cancelling();
  for (Eigen::Index k = 0; k < scales.size(); ++k) terms += std::abs(start.multipliers[k]) * scales[k];
  const double rounding = 1e-13 * terms;
  for (int trial = 0; trial < 40 && share > 0; ++trial) {
    const VecX next = start.x + share * start.step;
    const double e = problem.value(next);
    if (std::isfinite(e)) {
      const double now = merit.at(e, constrained ? problem.constraint_values(next) : VecX());
      if (now <= before + 1e-4 * share * slope + rounding) return share;
    }
    share *= 0.5;
  }
  return 0;
}

}  // namespace calot
