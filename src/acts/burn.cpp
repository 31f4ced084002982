#include "acts/burn.h"

#include <algorithm>
#include <limits>

#include "base/units.h"
#include "body/skin_bounds.h"
#include "collision/simplex_distance.h"
#include "group/contact_search.h"
#include "liquid/perforate.h"

namespace calot {
namespace {

/// Whether a body's surface may be nearer than `reach` (m) to one of some shapes, by boxes around both.
bool may_reach(const Body& body, const VecX& x, const std::vector<Shape>& shapes, double reach) {
  Eigen::AlignedBox3d box = skin_box(body, x);
  const Vec3 wider = Vec3::Constant(reach + body.thickest());
  box.min() -= wider;
  box.max() += wider;
  return std::any_of(shapes.begin(), shapes.end(), [&](const Shape& shape) {
    const Bounds around = bounds(shape);
    return box.intersects(Eigen::AlignedBox3d(around.lower, around.upper));
  });
}

/// Of the points that an organ is felt at, which lie 0.2 mm apart on a gallbladder, the nearest to some shapes.
struct NearestSurface {
  double distance =
      std::numeric_limits<double>::infinity();  ///< m; infinite: none is nearer than was asked for
  Vec3 at = Vec3::Zero();                       ///< m
};
NearestSurface nearest_surface(const Organ& organ, const std::vector<Shape>& shapes, double reach) {
  const Body& body = *organ.body;
  const VecX& x = organ.state.x;
  NearestSurface nearest;
  if (!may_reach(body, x, shapes, reach)) return nearest;
  ContactLoads near;
  near.shapes = shapes;
  near.barrier.range = reach;
  for_touching(body, x, near, gather_pairs(body, x, near, -contact_margin), 0,
               [&](int point, int, const Vec3& at, const DistanceSlope& slope) {
                 if (slope.distance < nearest.distance)
                   nearest = {slope.distance, at - body.radius_at_contact(point) * slope.gradient};
               });
  return nearest;
}

/// Where a place of an organ's surface (m) is at rest, m: the same place of what is drawn, whatever its triangles.
Vec3 place_at_rest(const Organ& organ, const Vec3& at) {
  const std::vector<Vec3> drawn = organ.body->drawn_positions(organ.state.x);
  const std::vector<Vec3>& rest = organ.body->drawn_rest();
  const int corner = nearest_of(drawn, at);
  NearestPoint nearest{{1, 0, 0}, (drawn[corner] - at).norm()};
  Triangle on{corner, corner, corner};
  for (const Triangle& t : organ.body->drawn_triangles()) {
    if (std::find(t.begin(), t.end(), corner) == t.end()) continue;
    const NearestPoint found = nearest_point(at, std::array{drawn[t[0]], drawn[t[1]], drawn[t[2]]});
    if (found.distance >= nearest.distance) continue;
    nearest = found;
    on = t;
  }
  return nearest.weight[0] * rest[on[0]] + nearest.weight[1] * rest[on[1]] + nearest.weight[2] * rest[on[2]];
}

/// The burnt place that `at` (m, at rest) counts to: of those that are near enough the nearest, else a new one.
std::size_t burnt_place(std::vector<Burn>& burns, const Vec3& at) {
  std::size_t nearest = burns.size();
  double distance = burn_radius;
  for (std::size_t k = 0; k < burns.size(); ++k)
    if (const double far = (burns[k].at - at).norm(); far < distance) {
      nearest = k;
      distance = far;
    }
  if (nearest == burns.size()) burns.push_back({at});
  return nearest;
}

/// All that hang together with one of them, itself too: two places do where their rims meet.
std::vector<std::size_t> in_one_piece(const std::vector<Burn>& burns, std::size_t with) {
  std::vector<std::size_t> piece{with};
  std::vector<char> known(burns.size(), 0);
  known[with] = 1;
  for (std::size_t i = 0; i < piece.size(); ++i)
    for (std::size_t k = 0; k < burns.size(); ++k) {
      if (known[k] != 0 || (burns[k].at - burns[piece[i]].at).norm() > 2 * burn_radius) continue;
      known[k] = 1;
      piece.push_back(k);
    }
  return piece;
}

}  // namespace

double burn_weight(double distance, double reach) {
  if (distance <= contact_gap) return 1;
  return distance < reach ? (reach - distance) / (reach - contact_gap) : 0.0;
}

std::vector<ReachedWall> reached_walls(Field& field, const std::vector<Shape>& shapes) {
  std::vector<ReachedWall> out;
  for (Organ& organ : field.organs) {
    const double reach = std::max(contact_gap, organ.definition.wall.burn_reach);
    const NearestSurface nearest = nearest_surface(organ, shapes, reach);
    if (const double weight = burn_weight(nearest.distance, reach); weight > 0)
      out.push_back({&organ, weight, nearest.at});
  }
  return out;
}

void burn(const ReachedWall& wall, const std::string& instrument, double energy,
          std::vector<WorldEvent>& events) {
  constexpr double raw_from = 1e-6;  // m^2, in one piece (d)
  Organ& organ = *wall.organ;
  const OrganDefinition& of = organ.definition;
  const std::size_t k = burnt_place(organ.burns, place_at_rest(organ, wall.at));
  const double before = organ.burns[k].energy;
  organ.burns[k].energy += energy;
  const auto raise = [&](EventKind kind, double value, const std::string& text) {
    events.push_back({kind, 0, instrument, of.name, value, wall.at, EventCause::current, text});
  };
  if (const double limit = of.wall.burn_energy; before < limit && organ.burns[k].energy >= limit) {
    if (is_hollow(of.shape)) {
      perforate(organ, wall.at, instrument);
      raise(EventKind::perforation, 0, {});
    }
    if (!of.injury.partly.empty()) raise(EventKind::injury, 0, of.injury.partly);
  }
  if (!has_capsule(of.shape)) return;
  double sum = 0;  // J
  for (const std::size_t one : in_one_piece(organ.burns, k)) {
    if (organ.burns[one].told) return;
    sum += organ.burns[one].energy;
  }
  const double raw = sum / of.wall.raw_energy;
  if (raw < raw_from) return;
  organ.burns[k].told = true;
  raise(EventKind::raw_surface, raw / (units::mm * units::mm), {});
}

}  // namespace calot
