#include "field/divide_body.h"

#include <fmt/format.h>

#include <algorithm>

#include "field/change_bodies.h"
#include "field/organ_piece.h"
#include "field/replace_body.h"
#include "field/roll.h"

namespace calot {
namespace {

/// Which bodies are held, by a bed or by what they are tied to.
std::vector<char> held_bodies(const Field& field) {
  std::vector<char> held;
  for (const Organ& organ : field.organs)
    held.push_back(organ.body->bedded().value_or(!organ.definition.held.empty()));
  for (bool more = true; std::exchange(more, false);)
    for (const FieldJoint& joint : field.membership.joints) {
      const auto [one, other] = joint.joint->links().bodies;
      if (held[one] == held[other]) continue;
      held[one] = held[other] = 1;
      more = true;
    }
  return held;
}

/// Whether the piece at the start is the patient's.
bool start_is_patients(const Field& field, OrganIndex whole, const BodyCut& cut,
                       const std::array<Organ, 2>& pieces) {
  const auto* tube = std::get_if<TubeShape>(&pieces[0].definition.shape);
  if (tube != nullptr && tube->patient_end != PatientEnd::held) return tube->patient_end == PatientEnd::start;
  // As if the start stood where the body stands and the end behind all others.
  Field divided;
  divided.organs = field.organs;
  const int organ = whole.value, end = static_cast<int>(divided.organs.size());
  divided.organs[organ] = pieces[0];
  divided.organs.push_back(pieces[1]);
  const std::vector<Vec3>& rest = field.organs[organ].body->skin_rest();
  for (const FieldJoint& joint : field.membership.joints) {
    const std::array<int, 2>& bodies = joint.joint->links().bodies;
    const int side = bodies[0] == organ ? 0 : bodies[1] == organ ? 1 : -1;
    std::vector<FieldJoint> parts{joint};
    if (side >= 0) parts = divide_joint(joint, side, cut, rest, {organ, end}, divided.organs, bodies);
    for (FieldJoint& part : parts) divided.membership.joints.push_back(std::move(part));
  }
  const std::vector<char> held = held_bodies(divided);
  return held[organ] && !held[end];
}

/// Control nodes that a division brings.
int more_nodes(const Body& whole, const BodyCut& cut) {
  return cut.pieces[0].body->coarse_nodes() + cut.pieces[1].body->coarse_nodes() - whole.coarse_nodes();
}

}  // namespace

Failure no_tube(const OrganDefinition& organ, const std::string& act, const std::string& done) {
  return fail(FailureKind::scenario,
              fmt::format("'{}' cannot be {}: its shape is \"{}\"", organ.name, done, shape_name(organ.shape)),
              fmt::format("{} a tube: a duct or a vessel", act));
}

std::array<std::string, 2> piece_names(const std::string& body) {
  return {body + ".patient", body + ".specimen"};
}

Result<Division> divide_body(Field& field, OrganIndex index, double share, double time) {
  const Organ& whole = field.organ(index);
  const Result<std::optional<BodyCut>> divided = whole.body->divide(share);
  if (!divided) return divided.failure();
  if (!divided.value()) return no_tube(whole.definition, "divide", "divided");
  const BodyCut& cut = *divided.value();
  if (std::optional<Failure> failure = check_room(field, more_nodes(*whole.body, cut))) return *failure;
  std::array<Organ, 2> pieces{piece_of(whole, cut, 0), piece_of(whole, cut, 1)};
  const bool start_first = start_is_patients(field, index, cut, pieces);
  const std::array<std::string, 2> names = piece_names(whole.definition.name);
  for (int side = 0; side < 2; ++side) {
    const bool patients = (side == 0) == start_first;
    Organ& piece = pieces[side];
    piece.of_specimen = whole.of_specimen || !patients;
    name_piece(piece, names[patients ? 0 : 1]);
  }
  note_departure(field, whole, {time, "was divided", {names[0], names[1]}, {}});
  field.enrol(pieces[start_first ? 0 : 1]);
  field.enrol(pieces[start_first ? 1 : 0]);
  replace_body(field, index, std::move(pieces), start_first, cut);
  finish_change(field);
  return Division{index, OrganIndex(index.value + 1), cut.share};
}

bool can_be_divided(const Organ& organ, double share) {
  const Result<std::optional<BodyCut>> divided = organ.body->divide(share);
  return divided && divided.value();
}

}  // namespace calot
