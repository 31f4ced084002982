#include "numerics/line_search.h"

#include <cmath>
#include <limits>

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

/// The merit along one step.
class Search {
 public:
  Search(const ConstrainedEnergy& problem, const SearchStart& start)
      : problem_(problem),
        start_(start),
        scales_(constrained() ? problem.constraint_scales() : VecX()),
        compliances_(constrained() ? problem.compliances() : VecX()),
        curvature_(whole_curvature(start, compliances_)),
        merit_{start.multipliers, compliances_, penalties(start, curvature_, scales_)},
        slope_(merit_.slope(curvature_, start.left)) {
    const double energy = problem.value(start.x);
    before_ = merit_.at(point(start.x, energy, 0));
    // Differences below the rounding of the sum cannot be judged.
    double terms = std::abs(energy) + problem.cancelling();
    for (Eigen::Index k = 0; k < scales_.size(); ++k)
      terms += std::abs(start.multipliers[k]) * scales_[k] +
               0.5 * compliances_[k] * start.multipliers[k] * start.multipliers[k];
    rounding_ = 1e-13 * terms;
  }

  /// At a share of the step; infinite where that is not admissible.
  double at(double share) const {
    const VecX next = problem_.relaxed(start_.x + share * start_.step);
    const double energy = problem_.value(next);
    return std::isfinite(energy) ? merit_.at(point(next, energy, share))
                                 : std::numeric_limits<double>::infinity();
  }
  /// Whether a share, at which it is this, takes off enough of it.
  bool falls_enough(double merit, double share) const {
    return merit <= before_ + 1e-4 * share * slope_ + rounding_;
  }
  double rounding() const { return rounding_; }

 private:
  bool constrained() const { return problem_.constraints() > 0; }
  Point point(const VecX& x, double energy, double share) const {
    return {energy, constrained() ? problem_.constraint_values(x) : VecX(),
            start_.multipliers - (1 - share) * start_.dmultipliers};
  }

  const ConstrainedEnergy& problem_;
  const SearchStart& start_;
  VecX scales_, compliances_;
  double curvature_;
  Merit merit_;
  double slope_, before_ = 0, rounding_ = 0;
};

/// Of a whole step, at whose end the merit is `whole`: the share to take instead, 1 or more.
double lengthened(const ConstrainedEnergy& problem, const SearchStart& start, const Search& search,
                  double whole) {
  constexpr int most_doublings = 10;
  double share = 1, least = whole;
  for (int k = 0; k < most_doublings; ++k) {
    const double further = search.at(2 * share);
    if (!(further < least - search.rounding())) break;
    share *= 2;
    least = further;
  }
  if (share == 1) return 1;
  const double safe = problem.safe_share(start.x, share * start.step);
  if (safe == 1) return share;
  return safe * share > 1 && search.at(safe * share) < whole ? safe * share : 1;
}

}  // namespace

double line_search(const ConstrainedEnergy& problem, const SearchStart& start, double share, bool stiffer) {
  const Search search(problem, start);
  for (int trial = 0; trial < 40 && share > 0; ++trial) {
    const double merit = search.at(share);
    if (search.falls_enough(merit, share))
      return stiffer && share == 1 ? lengthened(problem, start, search, merit) : share;
    share *= 0.5;
  }
  return 0;
}

}  // namespace calot
