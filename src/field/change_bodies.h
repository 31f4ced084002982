#pragma once
// How bodies join a field, leave it and are divided while it runs.
//
// Each change leaves all other bodies as they are, in their order, and asks nothing of a solver; what pressed, stuck or
// held on a body that goes is gone, and factors are made anew. A failure (scenario) leaves the field as it is.
//
// A rod is divided at one of its skin points into two that are the same curve as before with the same velocities; each
// has the skin points, sections, bed, joints, holds and pulled anchors that it had there. Nothing acts across the cut:
// near it the pieces do not press on each other either, as they begin there at one place.

#include "body/body_handle.h"
#include "field/field.h"
#include "organs/body_kinds.h"

namespace calot {

/// That what is done to tubes alone (such as "divide": it is "divided") cannot be done to an organ.
Failure no_tube(const OrganDefinition& organ, const std::string& act, const std::string& done);

/// What the pieces of a body are called: "cystic_duct.patient" and "cystic_duct.specimen".
std::array<std::string, 2> piece_names(const std::string& body);

/// Divides a tube at about a share of its length at rest (rods have a skin point every mm). The patient's piece is the
/// one that the tube's definition names (TubeShape::patient_end), or else that which is held, itself or by what it is
/// tied to; where both are, or neither, its end. The pieces stand where the body stood, the patient's first. `time`, s:
/// when. Also fails where it is no tube or a piece would be shorter than it is thick.
Result<Division> divide_body(Field& field, int organ, double share, double time);

/// Whether a body is a tube that is long enough for that.
bool can_be_divided(const Organ& organ, double share);

/// The joints of a body go with it, and tools let it go.
Result<bool> remove_body(Field& field, int organ, const std::string& why, double time);

/// Adds an organ, where its definition has it, at rest; as make_organ() where that fails, and where it would be in
/// another body or a tool. Returns its place, behind all others.
Result<int> add_body(Field& field, const OrganDefinition& definition, const OrganSetting& setting);

/// Ties "organ.landmark" to another where they are now: without a load. The names are the field's.
Result<bool> tie_bodies(Field& field, const JointDefinition& joint);
/// Undoes all joints between two bodies. Where they were tied they never press on each other.
Result<bool> untie_bodies(Field& field, int one, int other);

/// After a change of bodies that is not made here: nothing that was made for those there were serves.
void finish_change(Field& field);
/// Renews field.members: call it when the field is complete, and after each change.
void keep_members(Field& field);
/// Sets the field back to other members, their bodies as they were when these began.
void restore_members(Field& field, const std::shared_ptr<const FieldMembers>& members);
/// Whether bodies and joints are the scene's, all of them.
bool is_as_in_scene(const Field& field);

/// Place of a body that is in the field. Fails (scenario) where it never was, or says when and why it went.
Result<int> find_body(const Field& field, const std::string& name);
Result<int> find_body(const Field& field, const BodyHandle& handle);
BodyHandle handle_of(const Field& field, int organ);
/// The last one of that name that went; null: none did.
const BodyRecord* gone_body(const Field& field, const std::string& name);

}  // namespace calot
