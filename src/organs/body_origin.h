#pragma once
// How a body of a field came to be, so that another process can make it again.

#include "anatomy/definitions.h"
#include "body/tube_pinch.h"

namespace calot {

struct BodyOrigin {
  /// A division: the piece of what was there that it became.
  struct Cut {
    double share = 0;                ///< of the divided one's length at rest, from its start
    int side = 0;                    ///< 0: the piece at its start
    std::string name;                ///< the piece's
    std::vector<TubePinch> pinches;  ///< where the divided one was held flat
  };
  int of_scene = -1;                     ///< that organ of the scene; below 0:
  std::optional<OrganDefinition> added;  ///< what came later, as it was added
  std::vector<std::string> released;     ///< regions that it is held by no more
  std::vector<Cut> cuts;                 ///< what befell it since, in that order
};
void visit_members(auto&& visit, MembersOf<BodyOrigin::Cut> auto& cut) {
  auto& [share, side, name, pinches] = cut;
  visit(share, side, name, pinches);
}
/// Who visits it needs a definition's members, too (anatomy/definition_members.h).
void visit_members(auto&& visit, MembersOf<BodyOrigin> auto& origin) {
  auto& [of_scene, added, released, cuts] = origin;
  visit(of_scene, added, released, cuts);
}

}  // namespace calot
