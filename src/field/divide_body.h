#pragma once
// How a tube of a field is divided.
//
// A rod is divided at one of its skin points into two that are the same curve as before with the same velocities; each
// has the skin points, sections, bed, joints, holds and pulled anchors that it had there. Nothing acts across the cut:
// near it the pieces do not press on each other either, as they begin there at one place.

#include <array>
#include <string>

#include "field/field.h"

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

}  // namespace calot
