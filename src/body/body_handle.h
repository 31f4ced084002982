#pragma once
// Which body, in a field whose bodies come and go.

#include <compare>
#include <concepts>
#include <cstdint>

#include "geometry/state_members.h"

namespace calot {

/// An organ by its place among the field's. A number becomes one only where that is said.
struct OrganIndex {
  int value = 0;
  constexpr OrganIndex() = default;
  constexpr explicit OrganIndex(std::integral auto place) : value(static_cast<int>(place)) {}
  auto operator<=>(const OrganIndex&) const = default;
};
void visit_members(auto&& visit, MembersOf<OrganIndex> auto& index) {
  auto& [value] = index;
  visit(value);
}

/// One body, for as long as it is in the field.
struct BodyHandle {
  int record = -1;  ///< on the roll
  /// No two bodies of a field have the same, whatever states it is set back to.
  std::uint64_t life = 0;
  bool operator==(const BodyHandle&) const = default;
};

/// The two pieces of a body.
struct Division {
  OrganIndex patient, specimen;
  double share = 0;  ///< of its length, from its start, where it was divided
};

}  // namespace calot
