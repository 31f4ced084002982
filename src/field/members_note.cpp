#include "field/members_note.h"

#include "field/organ_piece.h"

namespace calot {
namespace {

OrganNote note_of(const Organ& organ) {
  return {organ.origin, organ.record, organ.of_specimen, pinches_of(organ)};
}

TissueNote note_of(const Tissue& tissue) {
  const auto& [definition, body, strands, now, search] = tissue;
  return {definition, strands->bodies(), strands->strands(), body->setup()};
}

}  // namespace

MembersNote note_of(const Field& field) {
  const auto& [joints, tied, roll] = field.membership;  // the roll is history
  MembersNote out;
  for (const Organ& organ : field.organs) out.organs.push_back(note_of(organ));
  for (const Tissue& tissue : field.tissues) out.tissues.push_back(note_of(tissue));
  for (const FieldJoint& joint : joints) out.joints.push_back(joint.joint->links());
  out.tied = tied;
  out.viewed = field.viewed;
  return out;
}

}  // namespace calot
