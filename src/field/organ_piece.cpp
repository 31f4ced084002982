#include "field/organ_piece.h"

#include "body/rod_body.h"
#include "geometry/tri_mesh.h"

namespace calot {
namespace {

OrganDefinition definition_of(const OrganDefinition& whole, const BodyPiece& piece) {
  OrganDefinition out = whole;
  for (InjuryNearStart& near : out.injury.near_start) near.within -= piece.begins;
  out.shape = piece.body->shape_of_piece(whole.shape);
  return out;
}

BodyState state_on(const BodyState& whole, const BodyPiece& piece) {
  BodyState out;
  out.x = piece.nodes(whole.x);
  if (whole.motion.begin.x.size() == 0) return out;
  out.motion = whole.motion;
  out.motion.begin.x = piece.nodes(whole.motion.begin.x);
  out.motion.begin.velocity = piece.nodes(whole.motion.begin.velocity);
  return out;
}

/// Those at points of one side, by the piece's numbers; `point` is the member that says which.
template <class Item>
std::vector<Item> on_side(const std::vector<Item>& whole, int Item::*point, const BodyCut& cut, int side) {
  std::vector<Item> out;
  for (Item item : whole) {
    if (cut.side_of(item.*point) != side) continue;
    item.*point = cut.pieces[side].points[item.*point];
    out.push_back(std::move(item));
  }
  return out;
}

FrictionLoad friction_of(const Organ& whole, const BodyPiece& piece) {
  FrictionLoad out;
  for (RubbingPoint rubbing : whole.friction.points) {
    const int triangle = piece.triangles[rubbing.point / contacts_each];
    if (triangle < 0) continue;
    rubbing.point = triangle * contacts_each + rubbing.point % contacts_each;
    out.points.push_back(rubbing);
  }
  return out;
}

/// Clips are on tubes, along which skin points follow each other.
std::vector<Clip> clips_of(const Organ& whole, const BodyCut& cut, int side) {
  std::vector<Clip> out;
  for (Clip clip : whole.clips) {
    if ((clip.at <= cut.point) != (side == 0)) continue;
    if (side == 1) clip.at -= cut.point;
    out.push_back(clip);
  }
  return out;
}

std::vector<Opening> openings_of(const Organ& whole, const BodyCut& cut, int side) {
  std::vector<Opening> out = on_side(whole.openings, &Opening::point, cut, side);
  if (!cut.open) return out;
  Opening cut_open;
  cut_open.point = cut.pieces[side].points[cut.point];
  out.insert(side == 0 ? out.end() : out.begin(), cut_open);
  return out;
}

/// Those that reach one of the piece's drawn points.
std::vector<Burn> burns_of(const Organ& whole, const Body& piece) {
  std::vector<Burn> out;
  const std::vector<Vec3>& rest = piece.drawn_rest();
  for (const Burn& burn : whole.burns)
    if ((rest[nearest_of(rest, burn.at)] - burn.at).norm() < burn_radius) out.push_back(burn);
  return out;
}

}  // namespace

std::vector<TubePinch> pinches_of(const Organ& organ) {
  const RodBody* tube = organ.body->as_tube();
  return tube == nullptr ? std::vector<TubePinch>() : tube->pinches();
}

Organ piece_of(const Organ& whole, const BodyCut& cut, int side) {
  const BodyPiece& piece = cut.pieces[side];
  Organ out(definition_of(whole.definition, piece), piece.body);
  out.state = state_on(whole.state, piece);
  out.search.own.active = whole.search.own.active;
  out.landmarks = piece.body->landmarks();
  out.origin = whole.origin;
  out.origin.cuts.push_back({cut.share, side, {}, pinches_of(whole)});
  out.grips = on_side(whole.grips, &GripPoint::skin_point, cut, side);
  out.leaving = on_side(whole.leaving, &LeavingPoint::skin_point, cut, side);
  out.friction = friction_of(whole, piece);
  out.unfelt = whole.unfelt;
  out.clips = clips_of(whole, cut, side);
  out.openings = openings_of(whole, cut, side);
  if (whole.left_in) out.left_in = *whole.left_in * piece.share;
  out.burns = burns_of(whole, *piece.body);
  return out;
}

void name_piece(Organ& piece, const std::string& name) {
  piece.definition.name = piece.origin.cuts.back().name = name;
  if (BodyPointer called = piece.body->called(name)) piece.body = std::move(called);
}

}  // namespace calot
