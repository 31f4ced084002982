#pragma once

#include <algorithm>
#include <vector>

namespace calot {

/// Place of a value in an increasing list, -1: none.
inline int index_of(int value, const std::vector<int>& list) {
  const auto found = std::lower_bound(list.begin(), list.end(), value);
  return found != list.end() && *found == value ? static_cast<int>(found - list.begin()) : -1;
}

}  // namespace calot
