#include "numerics/line_search.h"

#include <cmath>

namespace calot {
namespace {

/// A point of the search: its energy, its constraints' values and multipliers.
struct Point {
  double energy;
  VecX constraints;
  VecX multipliers;
};

/// phi = energy + sum of (e / 2 * m^2 + penalty / 2 * r^2 - multiplier * r), r = constraint + e m. A compliant constraint
/// is so one that is kept between x and a spring of energy s^2 / (2 e), whose length s = -e m follows the step too: phi
/// is not steep where e is small.
struct Merit {
  const VecX& multipliers;
  const VecX& compliances;
  VecX penalties;

  double at(const Point& point) const {
    double sum = point.energy;
    for (Eigen::Index k = 0; k < penalties.size(); ++k) {
      const double e = compliances[k], m = point.multipliers[k], left = point.constraints[k] + e * m;
      sum = sum - multipliers[k] * left + 0.5 * penalties[k] * left * left + 0.5 * e * m * m;
    }
    return sum;
  }
  /// `left`: r where the step begins.
  double slope(double curvature, const VecX& left) const {
    double sum = -curvature;
    for (Eigen::Index k = 0; k < penalties.size(); ++k) sum -= penalties[k] * left[k] * left[k];
    return sum;
  }
};

/// Along the step and the springs.
double whole_curvature(const SearchStart& start, const VecX& compliances) {
  double sum = start.curvature;
  for (Eigen::Index k = 0; k < compliances.size(); ++k)
    sum += compliances[k] * start.dmultipliers[k] * start.dmultipliers[k];
  return sum;
}

/// Large enough that the bordered step descends whatever the curvature along it.
VecX penalties(const SearchStart& start, double curvature, const VecX& scales) {
  VecX out(scales.size());
  double squared = 0;
  for (Eigen::Index k = 0; k < out.size(); ++k) squared += start.left[k] * start.left[k];
  for (Eigen::Index k = 0; k < out.size(); ++k) {
    out[k] = (std::abs(start.multipliers[k]) + 1.0) / scales[k];
    if (squared > 0) out[k] = std::max(out[k], 2.0 * std::max(0.0, -curvature) / squared);
  }
  return out;
}

}  // namespace

double line_search(const ConstrainedEnergy& problem, const SearchStart& start, double share) {
  const bool constrained = problem.constraints() > 0;
  const VecX scales = constrained ? problem.constraint_scales() : VecX();
  const VecX compliances = constrained ? problem.compliances() : VecX();
  const double curvature = whole_curvature(start, compliances);
  const Merit merit{start.multipliers, compliances, penalties(start, curvature, scales)};
  const auto at = [&](const VecX& x, double energy, double of_step) {
    return Point{energy, constrained ? problem.constraint_values(x) : VecX(),
                 start.multipliers - (1 - of_step) * start.dmultipliers};
  };
  const double slope = merit.slope(curvature, start.left);
  const Point begin = at(start.x, problem.value(start.x), 0);
  const double before = merit.at(begin);
  // Differences below the rounding of the sum cannot be judged.
  double terms = std::abs(begin.energy) + problem.cancelling();
  for (Eigen::Index k = 0; k < scales.size(); ++k)
    terms += std::abs(start.multipliers[k]) * scales[k] +
             0.5 * compliances[k] * start.multipliers[k] * start.multipliers[k];
  const double rounding = 1e-13 * terms;
  for (int trial = 0; trial < 40 && share > 0; ++trial) {
    const VecX next = start.x + share * start.step;
    const double e = problem.value(next);
    if (std::isfinite(e) && merit.at(at(next, e, share)) <= before + 1e-4 * share * slope + rounding)
      return share;
    share *= 0.5;
  }
  return 0;
}

}  // namespace calot
