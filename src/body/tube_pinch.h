#pragma once
// A place at which something holds a tube flat.

#include "geometry/state_members.h"

namespace calot {

struct TubePinch {
  double at = 0;                 ///< skin points from its start
  double opening = 0;            ///< share of the lumen's height that is left
  Vec3 pressed = Vec3::UnitY();  ///< in the frame there, see RodBody::frame_at()
};
void visit_members(auto&& visit, MembersOf<TubePinch> auto& pinch) {
  auto& [at, opening, pressed] = pinch;
  visit(at, opening, pressed);
}

}  // namespace calot
