#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace calot {

/// Place of a value in an increasing list, -1: none.
inline int index_of(int value, const std::vector<int>& list) {
  const auto found = std::lower_bound(list.begin(), list.end(), value);
  return found != list.end() && *found == value ? static_cast<int>(found - list.begin()) : -1;
}

/// The enumerator at whose place in a list of names, in the order of the enumerators, a name stands; none: nowhere.
template <typename Enum>
std::optional<Enum> enumerator_called(const std::string& name, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? std::nullopt : std::optional(static_cast<Enum>(found - names.begin()));
}

}  // namespace calot
