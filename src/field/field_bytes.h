#pragma once
// A field as bytes that another process of this program makes the same field of, to the last bit: who is there, and all
// that moves (moving_state.h). Bodies are not in the bytes but how they came to be (body_origin.h), of the factor only
// the matrix that it is of: both are made again.

#include "field/change_bodies.h"

namespace calot {

void add_bytes_of(const Field& field, ByteWriter& out);

/// Makes a field of the same scene, that rests as it begins, the one that the bytes are of. Bytes that can be of none are
/// refused, and the field then is of no use any more. `make`: as it was when they came.
void read_field(MemberReader& read, const OrganMaker& make, Field& field);

}  // namespace calot
