#pragma once
// Where bodies stick to each other, from one equilibrium to the next: as skin does to tools (rubbing.h), with the anchors
// in frames that bodies carry along (skin_rubbing.h). Coefficient: Group::friction.

#include "field/field.h"

namespace calot {

/// The joins, and what rubs beside them if anything does.
std::vector<JoinPointer> joins_with(std::vector<JoinPointer> joins, const std::vector<SkinHold>& rubbing);

/// Replaces `rubbing` by what rubs at the field's present state with its present normal forces; points that did not rub
/// at the last equilibrium have their anchors where they were `before`, one an organ. Limits change by `share` (1: wholly)
/// of what their normal forces ask for. Returns the change asked for, as friction_tolerance (rubbing.h) judges it. The
/// joins must have been told of the bodies as they are.
double renew_body_friction(const Field& field, const std::vector<VecX>& before, double share,
                           std::vector<SkinHold>& rubbing);

/// Keeps a new equilibrium's holds, anchors slid along where they slipped.
void keep_body_friction(Field& field, std::vector<SkinHold> rubbing);

}  // namespace calot
