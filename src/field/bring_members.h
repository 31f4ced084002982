#pragma once
// How the bodies of a field are made again, of how they came to be.

#include "field/change_bodies.h"
#include "field/members_note.h"

namespace calot {

/// Has a field of the same scene, that rests as it begins, these members. What moves of them, and their details, are to
/// be set next. False, with the field of no use any more, where the note cannot be of such a field.
bool bring_members(const MembersNote& note, const std::vector<BodyRecord>& roll, const OrganMaker& make,
                   Field& field);

}  // namespace calot
