#include "field/bring_members.h"

#include <algorithm>

#include "body/rod_body.h"
#include "field/join_bodies.h"
#include "field/organ_piece.h"

namespace calot {
namespace {

/// An organ before anything befell it.
std::optional<Organ> organ_at_first(const BodyOrigin& origin, const std::vector<Organ>& of_scene,
                                    const OrganMaker& make) {
  if (!origin.added) {
    const auto index = static_cast<std::size_t>(origin.of_scene);
    return index < of_scene.size() ? std::optional(of_scene[index]) : std::nullopt;
  }
  Result<RestedOrgan> made = make(*origin.added);
  if (!made) return std::nullopt;
  made->organ.origin.added = origin.added;
  return std::move(made->organ);
}

/// Whether it could be.
bool hold_flat(const std::vector<TubePinch>& pinches, Organ& organ) {
  const RodBody* tube = organ.body->as_tube();
  if (tube == nullptr) return pinches.empty();
  if (!std::all_of(pinches.begin(), pinches.end(), [&](const TubePinch& p) { return tube->has(p.at); }))
    return false;
  organ.body = std::make_shared<const RodBody>(tube->pinched(pinches));
  return true;
}

bool cut_off(const BodyOrigin::Cut& cut, Organ& organ) {
  if (cut.side < 0 || cut.side > 1 || !hold_flat(cut.pinches, organ)) return false;
  const Result<std::optional<BodyCut>> divided = organ.body->divide(cut.share);
  if (!divided || !divided.value()) return false;
  organ = piece_of(organ, *divided.value(), cut.side);
  name_piece(organ, cut.name);
  return true;
}

std::optional<Organ> organ_of(const OrganNote& note, const std::vector<Organ>& of_scene,
                              const OrganMaker& make) {
  std::optional<Organ> out = organ_at_first(note.origin, of_scene, make);
  if (!out) return out;
  for (const std::string& held : note.origin.released)
    if (!release_held(*out, held)) return std::nullopt;
  for (const BodyOrigin::Cut& cut : note.origin.cuts)
    if (!cut_off(cut, *out)) return std::nullopt;
  if (!hold_flat(note.pinches, *out)) return std::nullopt;
  out->record = note.record;
  out->of_specimen = note.of_specimen;
  return out;
}

Tissue tissue_of(const TissueNote& note) {
  Tissue out{note.definition,
             std::make_shared<const TissueBody>(note.nodes),
             std::make_shared<StrandJoin>(note.bodies, note.strands),
             {}};
  out.search.own.active = false;
  return out;
}

/// Whether all that names bodies and their records names some that there are.
bool names_who_is_there(const MembersNote& note, std::size_t records) {
  const int organs = static_cast<int>(note.organs.size());
  const auto there = [&](const auto& two) {
    const std::array<int, 2>& bodies = two.bodies;
    return std::min(bodies[0], bodies[1]) >= 0 && std::max(bodies[0], bodies[1]) < organs;
  };
  return std::all_of(note.tissues.begin(), note.tissues.end(), there) &&
         std::all_of(note.joints.begin(), note.joints.end(), there) &&
         std::all_of(note.tied.begin(), note.tied.end(), there) &&
         std::all_of(
             note.organs.begin(), note.organs.end(),
             [&](const OrganNote& organ) { return static_cast<std::size_t>(organ.record) < records; }) &&
         (!note.viewed || (note.viewed->organ.value >= 0 && note.viewed->organ.value < organs));
}

}  // namespace

bool bring_members(const MembersNote& note, const std::vector<BodyRecord>& roll, const OrganMaker& make,
                   Field& field) {
  if (note.organs.empty() || !names_who_is_there(note, roll.size())) return false;
  std::vector<Organ> organs;
  for (const OrganNote& each : note.organs) {
    std::optional<Organ> organ = organ_of(each, field.organs, make);
    if (!organ) return false;
    organs.push_back(std::move(*organ));
  }
  field.organs = std::move(organs);
  field.tissues.clear();
  for (const TissueNote& each : note.tissues) field.tissues.push_back(tissue_of(each));
  auto& [joints, tied, records] = field.membership;
  joints.clear();
  for (const JointLinks& links : note.joints) joints.push_back({std::make_shared<const Joint>(links)});
  tied = note.tied;
  records = roll;
  for (BodyRecord& record : records) record.life = ++field.lives;
  field.viewed = note.viewed;
  renew_joins(field);
  field.group.forget_bodies();
  return true;
}

}  // namespace calot
