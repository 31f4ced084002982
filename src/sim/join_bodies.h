#pragma once
// What joins the bodies of a field: the anatomy's joints, and contact of each body with each other one.

#include "sim/field.h"

namespace calot {

/// Makes the field's joins from its organs at rest. Fails (scenario) where a joint cannot be made. Bodies that are in
/// each other at rest without being tied there are not looked for.
Result<bool> join_bodies(const AnatomyDefinition& anatomy, Field& field);

}  // namespace calot
