#include "acts/burn.h"

#include <algorithm>

#include "acts/clearance.h"
#include "base/units.h"
#include "collision/simplex_distance.h"
#include "group/contact_search.h"
#include "liquid/perforate.h"

namespace calot {
namespace {

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

/// All that hang together with one of them, itself too. What counts to a place lies up to burn_radius from its middle: of
/// two that meet the middles may be this far apart.
std::vector<std::size_t> in_one_piece(const std::vector<Burn>& burns, std::size_t with) {
  constexpr double meet = 3 * burn_radius;
  std::vector<std::size_t> piece{with};
  std::vector<char> known(burns.size(), 0);
  known[with] = 1;
  for (std::size_t i = 0; i < piece.size(); ++i)
    for (std::size_t k = 0; k < burns.size(); ++k) {
      if (known[k] != 0 || (burns[k].at - burns[piece[i]].at).norm() > meet) continue;
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
    if (const std::optional<Clearance> near = clearance_within(shapes, organ, reach))
      out.push_back({&organ, burn_weight(near->distance, reach), near->place});
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
