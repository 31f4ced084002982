#pragma once
// Chance that is the same in every picture: how drawn strands differ from each other.

#include <cmath>
#include <cstddef>

namespace calot {

/// A number in [0, 1) of a strand, of a part of it, and of what it is for.
inline double share_of(std::size_t strand, int part, int which) {
  const double x = 12.9898 * static_cast<double>(strand) + 78.233 * part + 37.719 * which;
  const double y = 43758.5453 * std::sin(x);
  return y - std::floor(y);
}

}  // namespace calot
