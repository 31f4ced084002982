#include "field/field_hash.h"

#include "base/hash.h"
#include "field/change_bodies.h"

namespace calot {
namespace {

/// Or a matrix, column by column.
template <class Numbers>
void add_vector(Hash& hash, const Numbers& v) {
  hash.add(v.size());
  hash.add(std::span<const double>(v.data(), static_cast<std::size_t>(v.size())));
}

void add_point(Hash& hash, const Vec3& p) { hash.add(std::span<const double>(p.data(), 3)); }

void add_motion(Hash& hash, const MotionPart& motion) {
  add_vector(hash, motion.begin.x);
  add_vector(hash, motion.begin.velocity);
  add_point(hash, motion.begin.centroid);
  hash.add(motion.duration);
}

void add_body_state(Hash& hash, const Organ& organ) {
  const BodyState& state = organ.state;
  add_vector(hash, state.x);
  hash.add(state.datum_pressure);
  hash.add(state.volume);
  for (int detail : organ.body->details()) hash.add(detail);
  for (const DetailShare& detail : state.shares) {
    hash.add(detail.share);
    hash.add(detail.leaving);
  }
  add_vector(hash, state.fading_load);
  if (state.motion.duration > 0) add_motion(hash, state.motion);
  for (const Extension& extension : organ.extensions) {
    hash.add(extension.shape);
    hash.add(extension.centre);
  }
  hash.add(organ.refused_details.has_value());
  if (organ.refused_details)
    for (int detail : *organ.refused_details) hash.add(detail);
}

void add_tissue(Hash& hash, const Tissue& tissue) {
  add_vector(hash, tissue.now.state.x);
  if (tissue.now.state.motion.duration > 0) add_motion(hash, tissue.now.state.motion);
  for (double opened : tissue.now.opened) hash.add(opened);
  for (std::size_t i = 0; i < tissue.now.heated.size(); ++i) {
    if (tissue.now.heated[i] == 0) continue;
    hash.add(i);
    hash.add(tissue.now.heated[i]);
  }
  hash.add(tissue.now.tearing);
}

void add_acts(Hash& hash, const Organ& organ) {
  for (const Clip& clip : organ.clips) {
    hash.add(static_cast<int>(clip.size));
    for (double v : {clip.at, clip.opening, clip.reach}) hash.add(v);
    add_point(hash, clip.legs);
    add_point(hash, clip.pressed);
  }
  for (ToolIndex instrument : organ.unfelt) hash.add(instrument.value);
  for (const Opening& opening : organ.openings) {
    hash.add(opening.point);
    for (double v : {opening.area, opening.rate, opening.lost, opening.drop}) hash.add(v);
    hash.add(opening.leaks);
  }
  if (organ.left_in) hash.add(*organ.left_in);
  for (const Burn& burn : organ.burns) {
    hash.add(burn.point);
    hash.add(burn.energy);
  }
}

void add_spill(Hash& hash, const Spill& spill) {
  for (const LostState& lost : spill.lost) {
    hash.add(lost.name);
    hash.add(lost.bile);
    hash.add(lost.blood);
    if (lost.aspirated > 0) hash.add(lost.aspirated);
  }
  for (const Drop& drop : spill.drops) {
    hash.add(static_cast<int>(drop.liquid));
    add_point(hash, drop.at);
    add_point(hash, drop.velocity);
    hash.add(drop.volume);
  }
  for (const Film& film : spill.films) {
    hash.add(film.on);
    for (const WetPoint& wet : film.wet) {
      hash.add(wet.point);
      for (double volume : wet.volume) hash.add(volume);
    }
  }
  for (const FallenClip& clip : spill.clips) {
    hash.add(static_cast<int>(clip.size));
    hash.add(clip.on);
    hash.add(clip.point);
    add_point(hash, clip.legs);
  }
}

void add_stick_slip(Hash& hash, const StickSlip& hold) {
  hash.add(hold.limit);
  hash.add(hold.stiffness);
  add_point(hash, hold.anchor);
  add_point(hash, hold.normal);
}

void add_holds(Hash& hash, const Organ& organ) {
  for (const GripPoint& grip : organ.grips) {
    hash.add(grip.instrument.value);
    hash.add(grip.jaw);
    hash.add(grip.skin_point);
    add_point(hash, grip.local);
    hash.add(grip.stiffness);
  }
  for (const RubbingPoint& rubbing : organ.friction.points) {
    hash.add(rubbing.shape);
    hash.add(rubbing.point);
    add_stick_slip(hash, rubbing.hold);
  }
}

/// The factor that is kept serves the next steps, so their bits depend on it: what it makes of the constraints'
/// gradients, all together, stands for all of its entries, which would take a tenth of a step.
void add_factor(Hash& hash, const NewtonWorkspace& work) {
  hash.add(work.factored);
  hash.add(work.shifted);
  if (!work.factored) return;
  add_vector(hash, VecX(work.border.gradients.rowwise().sum()));
  add_vector(hash, VecX(work.border.answers.rowwise().sum()));
  add_vector(hash, work.border.complement);
}

void add_missed(Hash& hash, const MissedMotion& missed) {
  add_vector(hash, missed.dx);
  add_vector(hash, missed.dpressures);
  hash.add(missed.travel);
  hash.add(missed.by_last_factor);
}

void add_rubbing(Hash& hash, const std::vector<SkinHold>& rubbing) {
  for (const SkinHold& held : rubbing) {
    hash.add(held.pair.point.body);
    hash.add(held.pair.point.row);
    hash.add(held.pair.on);
    for (const BodyPoint& point : held.place.points) {
      hash.add(point.body);
      hash.add(point.row);
    }
    hash.add(held.across);
    add_stick_slip(hash, held.hold);
  }
}

void add_pose(Hash& hash, const InstrumentPose& pose) {
  for (double v : {pose.pitch, pose.yaw, pose.insertion, pose.roll, pose.jaw}) hash.add(v);
}

void add_tool(Hash& hash, const Tool& tool) {
  const int grip = (tool.slipping ? 1 : 0) | (tool.lost ? 2 : 0) | (tool.beside ? 4 : 0) |
                   static_cast<int>(tool.action) << 3 | (tool.has_cut ? 64 : 0) | (tool.waits ? 128 : 0);
  hash.add(tool.jaw_stopped);
  hash.add(static_cast<unsigned char>(grip));
  if (has_action(tool.definition.type, InstrumentAction::fire)) hash.add(tool.clips);
  hash.add(tool.touched);
  hash.add(tool.over_limit);
  if (tool.pressing) hash.add(tool.pressing);
  if (tool.dry > 0) hash.add(tool.dry);
  if (tool.on_clip || tool.beside_kept)
    hash.add(static_cast<unsigned char>((tool.on_clip ? 1 : 0) | (tool.beside_kept ? 2 : 0)));
  if (tool.burnt > 0) {
    hash.add(tool.burnt);
    hash.add(tool.burnt_record);
  }
  if (has_action(tool.definition.type, InstrumentAction::aspirate)) {
    const NeedleState& needle = tool.needle;
    hash.add(needle.record);
    hash.add(needle.point);
    for (double v : {needle.drawn, needle.drawn_ever}) hash.add(v);
    hash.add(needle.empty);
  }
  add_pose(hash, tool.pose);
  if (tool.tissue_stiffness > 0) hash.add(tool.tissue_stiffness);
  if (tool.stiffness_across > 0) hash.add(tool.stiffness_across);
  if (tool.roll_stiffness > 0) hash.add(tool.roll_stiffness);
  if (!tool.meeting.with.empty()) {
    hash.add(tool.meeting.with);
    add_vector(hash, tool.meeting.force);
  }
}

void add_place(Hash& hash, const CarriedPlace& place) {
  for (int point : place.points) hash.add(point);
  for (double weight : place.weights) hash.add(weight);
}

/// Who is there, where that is not who the scene has.
void add_members(Hash& hash, const Field& field) {
  if (is_as_in_scene(field)) return;
  for (const Organ& organ : field.organs) {
    hash.add(organ.definition.name);
    add_vector(hash, organ.body->rest());
  }
  for (const FieldJoint& joint : field.membership.joints) {
    const JointLinks& links = joint.joint->links();
    for (int body : links.bodies) hash.add(body);
    hash.add(links.stiffness);
    for (const JointLinks::Link& link : links.links) {
      add_place(hash, link.one);
      add_place(hash, link.other);
      hash.add(link.length);
    }
  }
  for (const TiedPlace& tied : field.membership.tied) {
    for (int body : tied.bodies) hash.add(body);
    add_point(hash, tied.place.place);
    hash.add(tied.place.within);
  }
}

}  // namespace

std::uint64_t hash_of(const Field& field) {
  Hash hash;
  add_members(hash, field);
  for (const Organ& organ : field.organs) {
    add_body_state(hash, organ);
    add_holds(hash, organ);
    add_acts(hash, organ);
  }
  for (const Tissue& tissue : field.tissues) add_tissue(hash, tissue);
  add_missed(hash, field.group.missed);
  add_rubbing(hash, field.group.rubbing);
  add_factor(hash, field.group.work);
  for (const Tool& tool : field.tools) add_tool(hash, tool);
  add_spill(hash, field.spill);
  return hash.value();
}

}  // namespace calot
