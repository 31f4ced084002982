#pragma once
// Which body, in a field whose bodies come and go.

#include <cstdint>

namespace calot {

/// One body, for as long as it is in the field.
struct BodyHandle {
  int record = -1;  ///< on the roll
  /// No two bodies of a field have the same, whatever states it is set back to.
  std::uint64_t life = 0;
  bool operator==(const BodyHandle&) const = default;
};

/// The two pieces of a body, by their places in the field.
struct Division {
  int patient = 0, specimen = 0;
  double share = 0;  ///< of its length, from its start, where it was divided
};

}  // namespace calot
