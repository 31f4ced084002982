#pragma once
// What is tied to a body of the field goes with its pieces when it is divided.

#include <array>

#include "body/body_cut.h"
#include "field/field.h"

namespace calot {

/// Places of the pieces of a body in the field: the start's and the end's.
using PiecePlaces = std::array<int, 2>;

/// What becomes of a joint of a body that is divided, its `side`: each link goes with the piece that its place is
/// nearest to; where that does not carry it alone, it becomes a strut as long as it is now. One joint for each piece
/// that has some. `rest`: the whole's skin points at rest, m; `bodies`: the joint's, by their places among `organs`,
/// where the pieces stand at `places`.
std::vector<FieldJoint> divide_joint(const FieldJoint& joint, int side, const BodyCut& cut,
                                     const std::vector<Vec3>& rest, const PiecePlaces& places,
                                     const std::vector<Organ>& organs, std::array<int, 2> bodies);

/// Puts the pieces of a body in its place, the start's first where `start_first`, with what it was tied by: joints,
/// tissue and where it was looked at. Near the cut they do not press on each other.
void replace_body(Field& field, OrganIndex organ, std::array<Organ, 2> pieces, bool start_first,
                  const BodyCut& cut);

}  // namespace calot
