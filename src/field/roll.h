#pragma once
// The roll of all bodies that are or were in a field: who is there, and how others went.

#include "body/body_handle.h"
#include "field/field.h"

namespace calot {

/// A body that is in the field. Fails (scenario) where it never was, or says when and why it went.
Result<OrganIndex> find_body(const Field& field, const std::string& name);
Result<OrganIndex> find_body(const Field& field, const BodyHandle& handle);
BodyHandle handle_of(const Field& field, OrganIndex organ);
/// The last one of that name that went; null: none did.
const BodyRecord* gone_body(const Field& field, const std::string& name);
/// That it is gone, when and why (scenario).
Failure gone(const BodyRecord& record);

/// Notes that an organ goes and how, with the places and normals that its landmarks have now.
void note_departure(Field& field, const Organ& organ, Departure departure);

}  // namespace calot
