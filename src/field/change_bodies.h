#pragma once
// How bodies join a field and leave it while it runs; how they are divided is in divide_body.h.
//
// Each change leaves all other bodies as they are, in their order, and asks nothing of a solver; what pressed, stuck or
// held on a body that goes is gone, and factors are made anew. A failure (scenario) leaves the field as it is.

#include <functional>

#include "field/field.h"
#include "organs/body_kinds.h"

namespace calot {

/// That the field would have more organs, or with `more_nodes` more control nodes, than it may (scenario); none: there is
/// room for another body.
std::optional<Failure> check_room(const Field& field, int more_nodes);

/// The joints of a body go with it, and tools let it go: jaws that rested on nothing else are free to close.
Result<bool> remove_body(Field& field, OrganIndex organ, const std::string& why, double time);

/// Makes an organ that comes later of its definition, at rest where that has it.
using OrganMaker = std::function<Result<RestedOrgan>(const OrganDefinition& definition)>;
/// Adds an organ, where its definition has it, at rest; fails as `make` does, and where it would be in
/// another body or a tool. It stands behind all others.
Result<OrganIndex> add_body(Field& field, const OrganDefinition& definition, const OrganMaker& make);

/// Lets an organ go where one of its held regions, by its name, holds it. Fails (scenario) where it has none of that name.
Result<bool> release_body(Field& field, OrganIndex organ, const std::string& held);

/// Lays strands between two organs where they are now. Fails (scenario) as make_tissue() does, and where a tissue or an organ
/// has that name or the field would have too many strands.
Result<bool> add_tissue(Field& field, const TissueDefinition& definition);
/// Takes a tissue away with all of its strands at a time, s. Fails (scenario) where there is none of that name.
Result<bool> remove_tissue(Field& field, const std::string& name, double time);

/// Ties "organ.landmark" to another where they are now: without a load. The names are the field's.
Result<bool> tie_bodies(Field& field, const JointDefinition& joint);
/// Undoes all joints between two bodies. Where they were tied they never press on each other.
Result<bool> untie_bodies(Field& field, OrganIndex one, OrganIndex other);

/// After a change of bodies that is not made here: nothing that was made for those there were serves.
void finish_change(Field& field);
/// Renews field.members: call it when the field is complete, and after each change.
void keep_members(Field& field);
/// Sets the field back to other members, their bodies as they were when these began.
void restore_members(Field& field, const std::shared_ptr<const FieldMembers>& members);

}  // namespace calot
