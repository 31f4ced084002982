#pragma once
// What joins the bodies of a field: joints, and contact of each body with each other one.

#include "field/field.h"
#include "joins/skin_join.h"

namespace calot {

/// Makes the field's joins from its organs at rest. Fails (scenario) where a joint cannot be made, and where bodies are in
/// each other without being tied there: with all such pairs, each at the later body.
Result<bool> join_bodies(const AnatomyDefinition& anatomy, Field& field);

/// Adds a joint of two landmarks that the field has: where its organs are at rest, or are now. There it is not loaded.
/// Fails as joint_links() does.
Result<bool> add_joint(const JointDefinition& joint, bool at_rest, Field& field);

/// That two organs are in each other at x, in the join's numbering: who, how deep, where, and what to do. None: they are
/// not, or one is a rigid thing inside the other, which is hollow.
std::optional<Problem> overlap_problem(const SkinJoin& join, const Organ& one, const Organ& other,
                                       const VecX& x);

/// Where organs that are not tied there are deepest in each other or in ground, m: for a picture of a scene that is refused.
std::vector<Vec3> overlap_places(const Field& field);

/// The field's joins anew, of its joints and of where its bodies are tied.
void renew_joins(Field& field);

/// What of the wall around a joint may lie in a fold, m.
inline constexpr double joint_fold = 3e-3;

}  // namespace calot
