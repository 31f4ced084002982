#include "field/divide_body.h"

#include <fmt/format.h>

#include <algorithm>

#include "body/rod_body.h"
#include "field/between_jaws.h"
#include "field/change_bodies.h"
#include "field/renumbering.h"
#include "field/roll.h"
#include "geometry/tri_mesh.h"
#include "group/self_contact.h"
#include "joins/skin_join.h"
#include "organs/body_kinds.h"

namespace calot {
namespace {

/// Of the pieces of a rod, by its way: start and end.
using Halves = std::array<int, 2>;

/// Which bodies are held, by a bed or by what they are tied to.
std::vector<char> held_bodies(const Field& field) {
  std::vector<char> held;
  for (const Organ& organ : field.organs) {
    const auto* rod = dynamic_cast<const RodBody*>(organ.body.get());
    held.push_back(rod ? rod->bedded() : !organ.definition.held.empty());
  }
  for (bool more = true; std::exchange(more, false);)
    for (const FieldJoint& joint : field.membership.joints) {
      const auto [one, other] = joint.joint->links().bodies;
      if (held[one] == held[other]) continue;
      held[one] = held[other] = 1;
      more = true;
    }
  return held;
}

/// Skin points of a rod that go to each piece: the one at the cut to both.
struct Cut {
  int point = 0, points = 0;
  const std::vector<Vec3>& rest;  ///< where they are at rest, m
  bool in_first(int row) const { return row <= point; }
  int in_piece(bool first, int row) const { return first ? row : row - point; }
};

/// A tube's burns on a piece of it: those that at rest are as near to one of its drawn points as these are to each
/// other.
std::vector<Burn> burns_of_piece(const Organ& whole, const RodBody& piece) {
  constexpr double near = 1e-3;  // m
  std::vector<Burn> out;
  const std::vector<Vec3>& rest = piece.drawn_rest();
  for (const Burn& burn : whole.burns) {
    const Vec3& at = whole.body->drawn_rest()[burn.point];
    const int nearest = nearest_of(rest, at);
    if ((rest[nearest] - at).norm() < near) out.push_back({nearest, burn.energy});
  }
  return out;
}

/// What of a rod's state is one half's.
Organ piece_of(const Organ& whole, const RodBody& rod, const Cut& cut, bool first, RodBody part) {
  const auto made = std::make_shared<const RodBody>(std::move(part));
  const RodBody& body = *made;
  Organ piece(whole.definition, made);
  if (!first)
    for (InjuryNearStart& near : piece.definition.injury.near_start)
      near.within -= way_from_start(rod, cut.point);
  auto& shape = std::get<TubeShape>(piece.definition.shape);
  shape.points = body.skin_rest();
  shape.nodes = body.nodes();
  shape.radius = body.skin_radii().front();
  shape.end_radius = body.skin_radii().back();
  if (!shape.radii.empty()) {
    shape.end_radius = 0;
    shape.radii.clear();
    for (std::size_t point = 0; point < shape.points.size(); ++point)
      shape.radii.push_back(body.outer_radius(static_cast<double>(point)));
  }
  piece.search.own.active = false;
  piece.state.x = rod.in_part(body, whole.state.x);
  if (const MotionPart& motion = whole.state.motion; motion.begin.x.size() > 0) {
    piece.state.motion = motion;
    piece.state.motion.begin.x = rod.in_part(body, motion.begin.x);
    piece.state.motion.begin.velocity = rod.in_part(body, motion.begin.velocity);
  }
  for (GripPoint grip : whole.grips) {
    // What is held just at the cut is the first piece's.
    if (cut.in_first(grip.skin_point) != first) continue;
    grip.skin_point = cut.in_piece(first, grip.skin_point);
    piece.grips.push_back(grip);
  }
  for (RubbingPoint rubbing : whole.friction.points) {
    const int segment = rubbing.point / (2 * contacts_each);
    if ((segment < cut.point) != first) continue;
    if (!first) rubbing.point -= cut.point * 2 * contacts_each;
    piece.friction.points.push_back(rubbing);
  }
  piece.unfelt = whole.unfelt;
  for (Clip clip : whole.clips) {
    if ((clip.at <= cut.point) != first) continue;
    if (!first) clip.at -= cut.point;
    piece.clips.push_back(clip);
  }
  const int first_point = first ? 0 : cut.point, last = first ? cut.point : cut.points - 1;
  for (Opening opening : whole.openings) {
    if ((opening.point == 0) != first) continue;
    if (!first) opening.point -= cut.point;
    piece.openings.push_back(std::move(opening));
  }
  Opening opened;
  opened.point = cut.point - first_point;
  piece.openings.insert(first ? piece.openings.end() : piece.openings.begin(), opened);
  if (whole.left_in)
    piece.left_in = *whole.left_in * std::abs(rod.share_of_length(last) - rod.share_of_length(first_point));
  piece.burns = burns_of_piece(whole, body);
  piece.landmarks = tube_landmarks(shape, body);
  return piece;
}

/// A joint's place where it is on one half; where that carries it but in part, the half's nearest point.
CarriedPlace on_half(const CarriedPlace& place, const Cut& cut, bool first, int nearest) {
  CarriedPlace out = place;
  for (int& point : out.points) {
    if (cut.in_first(point) != first) return {{cut.in_piece(first, nearest)}, {1.0}};
    point = cut.in_piece(first, point);
  }
  return out;
}

Vec3 place_at(const CarriedPlace& place, const std::vector<Vec3>& skin) {
  Vec3 at = Vec3::Zero();
  for (std::size_t i = 0; i < place.points.size(); ++i) at += place.weights[i] * skin[place.points[i]];
  return at;
}

Vec3 place_now(const Organ& organ, const CarriedPlace& place) {
  return place_at(place, organ.body->skin_positions(organ.state.x));
}

/// Each link of a rod's joint goes with the half that its place is nearest to; where that does not carry it alone, it
/// becomes a strut as long as it is now. One joint for each half that has some; bodies are numbered as they are with the
/// halves.
std::vector<FieldJoint> divide_joint(const FieldJoint& joint, int side, const Cut& cut, const Halves& halves,
                                     const std::vector<Organ>& organs, std::array<int, 2> bodies) {
  std::array<JointLinks, 2> out;
  for (int half = 0; half < 2; ++half) {
    out[half].stiffness = joint.joint->links().stiffness;
    out[half].bodies = bodies;
    out[half].bodies[side] = halves[half];
  }
  for (const JointLinks::Link& link : joint.joint->links().links) {
    const CarriedPlace& of_rod = side == 0 ? link.one : link.other;
    const int nearest = nearest_of(cut.rest, place_at(of_rod, cut.rest));
    const int half = cut.in_first(nearest) ? 0 : 1;
    JointLinks::Link kept = link;
    CarriedPlace& place = side == 0 ? kept.one : kept.other;
    place = on_half(of_rod, cut, half == 0, nearest);
    if (place.points.size() < of_rod.points.size())
      kept.length = (place_now(organs[out[half].bodies[0]], kept.one) -
                     place_now(organs[out[half].bodies[1]], kept.other))
                        .norm();
    out[half].links.push_back(std::move(kept));
  }
  std::vector<FieldJoint> made;
  for (JointLinks& links : out)
    if (!links.links.empty())
      made.push_back({std::make_shared<const Joint>(std::move(links)), joint.of_scene});
  return made;
}

/// The strands of a tissue that end on one half of a rod; none do: none.
std::optional<Tissue> half_of(const Tissue& tissue, int side, const Cut& cut, bool first, int half,
                              std::array<int, 2> bodies) {
  bodies[side] = half;
  std::vector<int> which;
  std::vector<PlacedStrand> strands;
  for (std::size_t i = 0; i < tissue.strands->strands().size(); ++i) {
    PlacedStrand strand = tissue.strands->strands()[i];
    CarriedPlace& place = side == 0 ? strand.one : strand.other;
    const int nearest = nearest_of(cut.rest, place_at(place, cut.rest));
    if (cut.in_first(nearest) != first) continue;
    place = on_half(place, cut, first, nearest);
    which.push_back(static_cast<int>(i));
    strands.push_back(std::move(strand));
  }
  if (which.empty()) return std::nullopt;
  return tissue.part(bodies, std::move(strands), which);
}

/// How far about the cut the pieces may not press on each other, that they do not anywhere.
double within_of_cut(const Organ& one, const Organ& other, const Vec3& place) {
  constexpr double wider = 1.25;
  double within = one.body->thickest() + other.body->thickest() + 2 * self_barrier.range;
  VecX x(one.state.x.size() + other.state.x.size());
  x << one.state.x, other.state.x;
  const std::array<GroupPlace, 2> places{GroupPlace{one.body.get(), 0},
                                         GroupPlace{other.body.get(), one.body->nodes()}};
  for (;; within *= wider) {
    const std::array<JoinedPlace, 1> around{JoinedPlace{place, within}};
    const SkinJoin join(*one.body, *other.body, {0, 1}, around);
    join.begin(places);
    if (join.gap(x) > self_barrier.range) return within;
  }
}

/// Puts the two in the place of the body and takes over what it was tied by.
void replace(Field& field, int organ, std::array<Organ, 2> pieces, bool start_first, const Cut& cut,
             const Vec3& place) {
  const Halves halves = start_first ? Halves{organ, organ + 1} : Halves{organ + 1, organ};
  const std::vector<FieldJoint> joints = field.membership.joints;
  const std::vector<TiedPlace> tied = field.membership.tied;
  const std::optional<ViewedPlace> viewed = field.viewed;
  std::vector<int> now;
  for (int k = 0; k < static_cast<int>(field.organs.size()); ++k) now.push_back(k < organ ? k : k + 1);
  now[organ] = -1;
  const auto at = field.organs.begin() + organ;
  *at = std::move(pieces[start_first ? 0 : 1]);
  field.organs.insert(at + 1, std::move(pieces[start_first ? 1 : 0]));
  const Renumbering renumbering(now);
  field.membership.joints.clear();
  for (const FieldJoint& joint : joints) {
    JointLinks links = joint.joint->links();
    const int side = links.bodies[0] == organ ? 0 : links.bodies[1] == organ ? 1 : -1;
    renumbering.apply(links.bodies);
    std::vector<FieldJoint>& out = field.membership.joints;
    if (side < 0) {
      out.push_back({std::make_shared<const Joint>(std::move(links)), joint.of_scene});
      continue;
    }
    for (FieldJoint& half : divide_joint(joint, side, cut, halves, field.organs, links.bodies))
      out.push_back(std::move(half));
  }
  std::vector<Tissue> tissues;
  for (const Tissue& tissue : field.tissues) {
    std::array<int, 2> bodies = tissue.strands->bodies();
    const int side = bodies[0] == organ ? 0 : bodies[1] == organ ? 1 : -1;
    renumbering.apply(bodies);
    if (side < 0) tissues.push_back(tissue.between(bodies));
    for (int half = 0; side >= 0 && half < 2; ++half)
      if (std::optional<Tissue> part = half_of(tissue, side, cut, half == 0, halves[half], bodies))
        tissues.push_back(std::move(*part));
  }
  field.tissues = std::move(tissues);
  field.membership.tied.clear();
  for (const TiedPlace& one : tied)
    for (int half = 0; half < 2; ++half) {
      TiedPlace of_half = one;
      const bool of_rod = one.bodies[0] == organ || one.bodies[1] == organ;
      if (!of_rod && half == 1) continue;
      for (int& body : of_half.bodies) body = body == organ ? halves[half] : now[body];
      std::sort(of_half.bodies.begin(), of_half.bodies.end());
      field.membership.tied.push_back(of_half);
    }
  const double within = within_of_cut(field.organs[organ], field.organs[organ + 1], place);
  field.membership.tied.push_back({{organ, organ + 1}, {place, within}});
  if (!viewed) return;
  const bool in_first = cut.in_first(viewed->skin_point);
  field.viewed = viewed->organ == organ
                     ? ViewedPlace{halves[in_first ? 0 : 1], cut.in_piece(in_first, viewed->skin_point)}
                     : ViewedPlace{now[viewed->organ], viewed->skin_point};
}

/// Whether the half at the rod's start is the patient's.
bool start_is_patients(const Field& field, int organ, const Cut& cut, const std::array<Organ, 2>& pieces) {
  const PatientEnd named = std::get<TubeShape>(pieces[0].definition.shape).patient_end;
  if (named != PatientEnd::held) return named == PatientEnd::start;
  // As if the start stood where the body stands and the end behind all others.
  Field divided;
  divided.organs = field.organs;
  const int end = static_cast<int>(divided.organs.size());
  divided.organs[organ] = pieces[0];
  divided.organs.push_back(pieces[1]);
  for (const FieldJoint& joint : field.membership.joints) {
    const std::array<int, 2>& bodies = joint.joint->links().bodies;
    const int side = bodies[0] == organ ? 0 : bodies[1] == organ ? 1 : -1;
    std::vector<FieldJoint> halves{joint};
    if (side >= 0) halves = divide_joint(joint, side, cut, {organ, end}, divided.organs, bodies);
    for (FieldJoint& half : halves) divided.membership.joints.push_back(std::move(half));
  }
  const std::vector<char> held = held_bodies(divided);
  return held[organ] && !held[end];
}

std::optional<Failure> check_lengths(const Organ& organ, const RodBody& rod, int point) {
  const double share = rod.share_of_length(point);
  const double shorter = std::min(share, 1 - share) * rod.length();
  const double thick = 2 * rod.skin_radii()[point];
  if (shorter >= thick) return std::nullopt;
  const std::string hint = 2 * thick > rod.length()
                               ? "it is too short to be divided"
                               : fmt::format("divide it at a share of its length between {:.2f} and {:.2f}",
                                             thick / rod.length(), 1 - thick / rod.length());
  return fail(FailureKind::scenario,
              fmt::format("a piece of {} would be {:.3g} mm long, shorter than it is thick ({:.3g} mm)",
                          quoted(organ), 1e3 * shorter, 1e3 * thick),
              hint);
}

/// Control nodes that a division brings at most: a second line has three more than spans, and one span is divided, or
/// two where a piece had but one.
constexpr int most_more_nodes = 6;

}  // namespace

Failure no_tube(const OrganDefinition& organ, const std::string& act, const std::string& done) {
  return fail(FailureKind::scenario,
              fmt::format("'{}' cannot be {}: it is a {}", organ.name, done, shape_name(organ.shape)),
              fmt::format("{} a tube: a duct or a vessel", act));
}

std::array<std::string, 2> piece_names(const std::string& body) {
  return {body + ".patient", body + ".specimen"};
}

Result<Division> divide_body(Field& field, int index, double share, double time) {
  const Organ whole = field.organs[index];
  const auto* rod = dynamic_cast<const RodBody*>(whole.body.get());
  if (rod == nullptr) return no_tube(whole.definition, "divide", "divided");
  const Cut cut{rod->point_to_divide_at(share), static_cast<int>(rod->skin_rest().size()), rod->skin_rest()};
  if (cut.point < 0)
    return fail(FailureKind::scenario, fmt::format("{} is too short to be divided", quoted(whole)));
  if (std::optional<Failure> failure = check_lengths(whole, *rod, cut.point)) return *failure;
  if (std::optional<Failure> failure = check_room(field, most_more_nodes)) return *failure;
  Result<RodBody> start = rod->part(0, cut.point), end = rod->part(cut.point, cut.points - 1);
  if (!start) return start.failure();
  if (!end) return end.failure();
  std::array<Organ, 2> pieces{piece_of(whole, *rod, cut, true, std::move(start).value()),
                              piece_of(whole, *rod, cut, false, std::move(end).value())};
  const bool start_first = start_is_patients(field, index, cut, pieces);
  const std::array<std::string, 2> names = piece_names(whole.definition.name);
  for (int half = 0; half < 2; ++half) {
    const bool patients = (half == 0) == start_first;
    const std::string& name = names[patients ? 0 : 1];
    pieces[half].of_specimen = whole.of_specimen || !patients;
    pieces[half].definition.name = name;
    pieces[half].body =
        std::make_shared<const RodBody>(dynamic_cast<const RodBody&>(*pieces[half].body).called(name));
  }
  note_departure(field, whole, {time, "was divided", {names[0], names[1]}});
  field.enrol(pieces[start_first ? 0 : 1]);
  field.enrol(pieces[start_first ? 1 : 0]);
  const Division out{index, index + 1, rod->share_of_length(cut.point)};
  replace(field, index, std::move(pieces), start_first, cut, rod->skin_rest()[cut.point]);
  finish_change(field);
  return out;
}

bool can_be_divided(const Organ& organ, double share) {
  const auto* rod = dynamic_cast<const RodBody*>(organ.body.get());
  const int point = rod == nullptr ? -1 : rod->point_to_divide_at(share);
  return point >= 0 && !check_lengths(organ, *rod, point);
}

}  // namespace calot
