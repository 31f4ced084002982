#pragma once
// All of a field that a step changes, listed once: hashes and bytes come from here (FieldState keeps the same).

#include "field/field.h"

namespace calot {

void visit_members(auto&& visit, MembersOf<MissedMotion> auto& missed) {
  auto& [dx, dpressures, travel, by_last_factor] = missed;
  visit(dx, dpressures, travel, by_last_factor);
}
void visit_members(auto&& visit, MembersOf<Group> auto& group) {
  // Joins follow from who is there, friction from the scene.
  auto& [work, patterns, joins, missed, friction, rubbing] = group;
  visit(work, patterns, missed, rubbing);
}

/// The active details of each organ, which its state has coordinates of.
std::vector<std::vector<int>> details_of(const Field& field);

/// What moves of the bodies and tools that there are, with these details (members_note.h says who they are).
void visit_moving(auto&& visit, MembersOf<Field> auto& field) {
  // What else there is follows from scene and steps, is of a world's process, or is remembered.
  auto& [organs, tissues, group, tools, ground, barrier, tolerance, rough, step_time, time, budget, spill,
         wounds, heart_rate, up, middle, viewed, scheme, assembly, stop, membership, members, lives] = field;
  for (auto& organ : organs) visit_members(visit, motion_of(organ));
  for (auto& tissue : tissues) visit(tissue.now);
  visit(group);
  for (auto& tool : tools) visit_members(visit, state_of(tool));
  visit(spill, wounds);
}

}  // namespace calot
