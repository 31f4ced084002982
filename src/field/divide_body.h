#pragma once
// How a body of a field is divided, where its kind can be (Body::divide): tubes.
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

/// Divides a body at about a share of its length at rest. The patient's piece is the one that a tube's definition names
/// (TubeShape::patient_end), or else that which is held, itself or by what it is tied to; where both are, or neither,
/// its end. The pieces stand where the body stood, the patient's first. `time`, s: when. Fails (scenario) where it
/// cannot be divided (Body::divide), and where the field would have too many organs or nodes.
Result<Division> divide_body(Field& field, OrganIndex organ, double share, double time);

/// Whether the body can be.
bool can_be_divided(const Organ& organ, double share);

}  // namespace calot
