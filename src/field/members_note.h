#pragma once
// Who is in a field as plain data: for hashes and bytes.

#include "anatomy/definition_members.h"
#include "field/field.h"

namespace calot {

struct OrganNote {
  BodyOrigin origin;
  int record = -1;
  bool of_specimen = false;
  std::vector<TubePinch> pinches;  ///< where a tube is held flat
};
void visit_members(auto&& visit, MembersOf<OrganNote> auto& note) {
  auto& [origin, record, of_specimen, pinches] = note;
  visit(origin, record, of_specimen, pinches);
}

struct TissueNote {
  TissueDefinition definition;
  std::array<int, 2> bodies{};
  std::vector<PlacedStrand> strands;
  TissueBody::Setup nodes;
};
void visit_members(auto&& visit, MembersOf<TissueNote> auto& note) {
  auto& [definition, bodies, strands, nodes] = note;
  visit(definition, bodies, strands, nodes);
}

struct MembersNote {
  std::vector<OrganNote> organs;
  std::vector<TissueNote> tissues;
  std::vector<JointLinks> joints;
  std::vector<TiedPlace> tied;
  std::optional<OrganPoint> viewed;
};
void visit_members(auto&& visit, MembersOf<MembersNote> auto& note) {
  auto& [organs, tissues, joints, tied, viewed] = note;
  visit(organs, tissues, joints, tied, viewed);
}

MembersNote note_of(const Field& field);

}  // namespace calot
