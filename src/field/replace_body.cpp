#include "field/replace_body.h"

#include <algorithm>

#include "geometry/tri_mesh.h"
#include "group/self_contact.h"
#include "joins/skin_join.h"

namespace calot {
namespace {

Vec3 place_now(const Organ& organ, const CarriedPlace& place) {
  return carried_to(place, organ.body->skin_positions(organ.state.x));
}

/// A place of a body that is divided on the piece that it is nearest to at rest; where that carries it but in part, the
/// piece's nearest point.
struct PlaceOnPiece {
  int side = 0;
  CarriedPlace place;

  PlaceOnPiece(const CarriedPlace& of_whole, const BodyCut& cut, const std::vector<Vec3>& rest) {
    const int nearest = nearest_of(rest, carried_to(of_whole, rest));
    side = cut.side_of(nearest);
    const std::vector<int>& points = cut.pieces[side].points;
    place = {{points[nearest]}, {1.0}};
    const auto on_it = [&](int point) { return cut.side_of(point) == side; };
    if (!std::all_of(of_whole.points.begin(), of_whole.points.end(), on_it)) return;
    place = of_whole;
    for (int& point : place.points) point = points[point];
  }
};

/// Which of two bodies one is; -1: neither.
int side_in(const std::array<int, 2>& bodies, int body) {
  return bodies[0] == body ? 0 : bodies[1] == body ? 1 : -1;
}

/// Where bodies stand before and after one of them is replaced by two.
struct Replaced {
  int whole = 0;
  PiecePlaces pieces{};

  /// Of another body than the whole.
  int now(int body) const { return body < whole ? body : body + 1; }
  std::array<int, 2> now(std::array<int, 2> bodies) const {
    for (int& body : bodies) body = now(body);
    return bodies;
  }
};

void replace_in_joints(const Replaced& places, const BodyCut& cut, const std::vector<Vec3>& rest,
                       Field& field) {
  std::vector<FieldJoint> out;
  for (const FieldJoint& joint : field.membership.joints) {
    JointLinks links = joint.joint->links();
    const int side = side_in(links.bodies, places.whole);
    links.bodies = places.now(links.bodies);
    if (side < 0) {
      out.push_back({std::make_shared<const Joint>(std::move(links))});
      continue;
    }
    for (FieldJoint& part : divide_joint(joint, side, cut, rest, places.pieces, field.organs, links.bodies))
      out.push_back(std::move(part));
  }
  field.membership.joints = std::move(out);
}

/// The strands of a tissue that end on one piece of a body; none do: none.
std::optional<Tissue> strands_on(const Tissue& tissue, int side, const BodyCut& cut,
                                 const std::vector<Vec3>& rest, int piece, std::array<int, 2> bodies) {
  std::vector<int> which;
  std::vector<PlacedStrand> strands;
  for (std::size_t i = 0; i < tissue.strands->strands().size(); ++i) {
    PlacedStrand strand = tissue.strands->strands()[i];
    CarriedPlace& place = side == 0 ? strand.one : strand.other;
    PlaceOnPiece there(place, cut, rest);
    if (there.side != piece) continue;
    place = std::move(there.place);
    which.push_back(static_cast<int>(i));
    strands.push_back(std::move(strand));
  }
  if (which.empty()) return std::nullopt;
  return tissue.part(bodies, std::move(strands), which);
}

void replace_in_tissues(const Replaced& places, const BodyCut& cut, const std::vector<Vec3>& rest,
                        Field& field) {
  std::vector<Tissue> out;
  for (const Tissue& tissue : field.tissues) {
    const int side = side_in(tissue.strands->bodies(), places.whole);
    std::array<int, 2> bodies = places.now(tissue.strands->bodies());
    if (side < 0) out.push_back(tissue.between(bodies));
    for (int piece = 0; side >= 0 && piece < 2; ++piece) {
      bodies[side] = places.pieces[piece];
      if (std::optional<Tissue> part = strands_on(tissue, side, cut, rest, piece, bodies))
        out.push_back(std::move(*part));
    }
  }
  field.tissues = std::move(out);
}

void replace_in_ties(const Replaced& places, Field& field) {
  std::vector<TiedPlace> out;
  for (const TiedPlace& tied : field.membership.tied) {
    const int side = side_in(tied.bodies, places.whole);
    for (int piece = 0; piece < (side < 0 ? 1 : 2); ++piece) {
      TiedPlace one{places.now(tied.bodies), tied.place};
      if (side >= 0) one.bodies[side] = places.pieces[piece];
      std::sort(one.bodies.begin(), one.bodies.end());
      out.push_back(one);
    }
  }
  field.membership.tied = std::move(out);
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

}  // namespace

std::vector<FieldJoint> divide_joint(const FieldJoint& joint, int side, const BodyCut& cut,
                                     const std::vector<Vec3>& rest, const PiecePlaces& places,
                                     const std::vector<Organ>& organs, std::array<int, 2> bodies) {
  std::array<JointLinks, 2> out;
  for (int piece = 0; piece < 2; ++piece) {
    out[piece].stiffness = joint.joint->links().stiffness;
    out[piece].bodies = bodies;
    out[piece].bodies[side] = places[piece];
  }
  for (const JointLinks::Link& link : joint.joint->links().links) {
    JointLinks::Link kept = link;
    CarriedPlace& place = side == 0 ? kept.one : kept.other;
    const std::size_t points = place.points.size();
    PlaceOnPiece there(place, cut, rest);
    JointLinks& of_piece = out[there.side];
    place = std::move(there.place);
    if (place.points.size() < points)
      kept.length = (place_now(organs[of_piece.bodies[0]], kept.one) -
                     place_now(organs[of_piece.bodies[1]], kept.other))
                        .norm();
    of_piece.links.push_back(std::move(kept));
  }
  std::vector<FieldJoint> made;
  for (JointLinks& links : out)
    if (!links.links.empty()) made.push_back({std::make_shared<const Joint>(std::move(links))});
  return made;
}

void replace_body(Field& field, OrganIndex replaced, std::array<Organ, 2> pieces, bool start_first,
                  const BodyCut& cut) {
  const int organ = replaced.value;
  const BodyPointer whole = field.organ(replaced).body;
  const std::vector<Vec3>& rest = whole->skin_rest();
  const Replaced places{organ, start_first ? PiecePlaces{organ, organ + 1} : PiecePlaces{organ + 1, organ}};
  const auto at = field.organs.begin() + organ;
  *at = std::move(pieces[start_first ? 0 : 1]);
  field.organs.insert(at + 1, std::move(pieces[start_first ? 1 : 0]));
  replace_in_joints(places, cut, rest, field);
  replace_in_tissues(places, cut, rest, field);
  replace_in_ties(places, field);
  const Vec3& place = rest[cut.point];
  const double within = within_of_cut(field.organs[organ], field.organs[organ + 1], place);
  field.membership.tied.push_back({{organ, organ + 1}, {place, within}});
  if (!field.viewed) return;
  OrganPoint& viewed = *field.viewed;
  if (viewed.organ != replaced) {
    viewed.organ = OrganIndex(places.now(viewed.organ.value));
    return;
  }
  const int side = cut.side_of(viewed.skin_point);
  viewed = {OrganIndex(places.pieces[side]), cut.pieces[side].points[viewed.skin_point]};
}

}  // namespace calot
