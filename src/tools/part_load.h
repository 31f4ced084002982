#pragma once
// What tissue does to the parts of an instrument, and what its jaws are doing.

#include <array>
#include <string>
#include <vector>

#include "geometry/state_members.h"

namespace calot {

/// The jaws (without jaws: what the shaft ends in) begin at the hinge; the tip is their foremost part.
enum class ToolPart { tip, jaws, shaft };
inline constexpr double tip_length = 5e-3;  ///< m, along the shaft

/// "tip", "jaws", "shaft": in the order of the parts.
const std::vector<std::string>& tool_part_names();

struct PartLoad {
  Vec3 force = Vec3::Zero();  ///< N, of the tissue on this part
  int touches = 0;            ///< skin points in contact or held
  Vec3 at = Vec3::Zero();     ///< m, the one of them with the largest force
  double largest = 0;         ///< N, that force
  std::string organ;          ///< the organ that it is of; empty without touches
};
void visit_members(auto&& visit, MembersOf<PartLoad> auto& load) {
  auto& [force, touches, at, largest, organ] = load;
  visit(force, touches, at, largest, organ);
}

/// One for each part; the jaws' has the tip's in it, so that jaws and shaft make the whole.
using PartLoads = std::array<PartLoad, 3>;

enum class GripState {
  holding,
  open,     ///< not closed, or not yet
  empty,    ///< closed, and nothing is between or beside the jaws
  beside,   ///< closed, with tissue touched that is not between the pads
  slipped,  ///< what was held slid off; until the jaws open or hold again
};
constexpr GripState last_of(GripState) { return GripState::slipped; }

/// "holding", "open", "empty", "beside", "slipped": in the order of the states.
const std::vector<std::string>& grip_state_names();

}  // namespace calot
