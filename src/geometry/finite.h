#pragma once
// Whether numbers are finite, asked of many at once.

#include <span>
#include <vector>

#include "geometry/types.h"

namespace calot {

/// True of none.
inline bool all_finite(std::span<const double> values) {
  // What is not finite makes a NaN of zero, and of every sum.
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), static_cast<Eigen::Index>(values.size()));
  return (0.0 * all).sum() == 0.0;
}
inline bool all_finite(const std::vector<Vec3>& values) {
  return values.empty() || all_finite(std::span(values.front().data(), 3 * values.size()));
}

}  // namespace calot
