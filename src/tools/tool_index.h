#pragma once
// Which tool of a field.

#include <compare>
#include <concepts>

#include "geometry/state_members.h"

namespace calot {

/// A tool by its place among the field's. A number becomes one only where that is said.
struct ToolIndex {
  int value = 0;
  constexpr ToolIndex() = default;
  constexpr explicit ToolIndex(std::integral auto place) : value(static_cast<int>(place)) {}
  auto operator<=>(const ToolIndex&) const = default;
};

void visit_members(auto&& visit, MembersOf<ToolIndex> auto& index) {
  auto& [value] = index;
  visit(value);
}

}  // namespace calot
