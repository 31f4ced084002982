#pragma once
// What joins the bodies of a field: joints, and contact of each body with each other one.

#include "sim/field.h"

namespace calot {

/// Makes the field's joins from its organs at rest. Fails (scenario) where a joint cannot be made. Bodies that are in
/// each other at rest without being tied there are not looked for.
Result<bool> join_bodies(const AnatomyDefinition& anatomy, Field& field);

/// Adds a joint of two landmarks that the field has: where its organs are at rest, or are now. There it is not loaded.
/// Fails as joint_links() does.
Result<bool> add_joint(const JointDefinition& joint, bool at_rest, Field& field);

/// The field's joins anew, of its joints and of where its bodies are tied.
void renew_joins(Field& field);

/// What of the wall around a joint may lie in a fold, m.
inline constexpr double joint_fold = 3e-3;

}  // namespace calot
