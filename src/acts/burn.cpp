#include "acts/burn.h"

#include <algorithm>

#include "acts/clearance.h"
#include "base/units.h"
#include "collision/simplex_distance.h"
#include "group/contact_search.h"
#include "liquid/perforate.h"

namespace calot {
namespace {

/// A shape in pieces along it, each once to twice as long as a burnt place's radius, but where it is shorter itself.
std::vector<Shape> pieces_of(const Shape& shape) {
  std::vector<Shape> out;
  const auto count_of = [](double length) { return std::max(1, static_cast<int>(length / burn_radius)); };
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    const Vec3 way = capsule->b - capsule->a;
    const int count = count_of(way.norm());
    for (int k = 0; k < count; ++k)
      out.push_back(
          Capsule{capsule->a + k * way / count, capsule->a + (k + 1) * way / count, capsule->radius});
  } else if (const auto* box = std::get_if<RoundedBox>(&shape)) {
    Eigen::Index along = 0;
    const double half = box->half.maxCoeff(&along);
    const int count = count_of(2 * half);
    RoundedBox piece = *box;
    piece.half[along] = half / count;
    for (int k = 0; k < count; ++k) {
      Vec3 middle = Vec3::Zero();
      middle[along] = half * ((2.0 * k + 1) / count - 1);
      piece.pose = box->pose * Eigen::Translation3d(middle);
      out.push_back(piece);
    }
  } else {
    out.push_back(shape);
  }
  return out;
}

/// Where places of an organ's surface are at rest: the same places of what is drawn, whatever its triangles.
class PlacesAtRest {
 public:
  explicit PlacesAtRest(const Organ& organ)
      : body_(*organ.body), drawn_(organ.body->drawn_positions(organ.state.x)) {}
  /// m, of a place now, m.
  Vec3 of(const Vec3& at) const {
    const std::vector<Vec3>& rest = body_.drawn_rest();
    const int corner = nearest_of(drawn_, at);
    NearestPoint nearest{{1, 0, 0}, (drawn_[corner] - at).norm()};
    Triangle on{corner, corner, corner};
    for (const Triangle& t : body_.drawn_triangles()) {
      if (std::find(t.begin(), t.end(), corner) == t.end()) continue;
      const NearestPoint found = nearest_point(at, std::array{drawn_[t[0]], drawn_[t[1]], drawn_[t[2]]});
      if (found.distance >= nearest.distance) continue;
      nearest = found;
      on = t;
    }
    return nearest.weight[0] * rest[on[0]] + nearest.weight[1] * rest[on[1]] +
           nearest.weight[2] * rest[on[2]];
  }

 private:
  const Body& body_;
  std::vector<Vec3> drawn_;  ///< m
};

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

/// A place of a wall has taken so much, J, and had before: raised when that first is its burn_energy.
void judge_wall(Organ& organ, double before, double now, const Vec3& at, const std::string& instrument,
                std::vector<WorldEvent>& events) {
  const OrganDefinition& of = organ.definition;
  if (before >= of.wall.burn_energy || now < of.wall.burn_energy) return;
  if (is_hollow(of.shape)) {
    perforate(organ, at, instrument);
    events.push_back({EventKind::perforation, 0, instrument, of.name, 0, at, EventCause::current});
  }
  if (!of.injury.partly.empty())
    events.push_back(
        {EventKind::injury, 0, instrument, of.name, 0, at, EventCause::current, of.injury.partly});
}

/// A place of a capsule has taken more: raised when what is raw about it in one piece first is as large as that.
void judge_capsule(Organ& organ, std::size_t place, const Vec3& at, const std::string& instrument,
                   std::vector<WorldEvent>& events) {
  constexpr double raw_from = 1e-6;  // m^2 (d)
  double sum = 0;                    // J
  for (const std::size_t one : in_one_piece(organ.burns, place)) {
    if (organ.burns[one].told) return;
    sum += organ.burns[one].energy;
  }
  const double raw = sum / organ.definition.wall.raw_energy;
  if (raw < raw_from) return;
  organ.burns[place].told = true;
  events.push_back({EventKind::raw_surface, 0, instrument, organ.definition.name,
                    raw / (units::mm * units::mm), at, EventCause::current});
}

}  // namespace

double burn_weight(double distance, double reach) {
  if (distance <= contact_gap) return 1;
  return distance < reach ? (reach - distance) / (reach - contact_gap) : 0.0;
}

double ReachedWall::weight() const {
  double largest = 0;
  for (const HeatedPlace& place : places) largest = std::max(largest, place.weight);
  return largest;
}

std::vector<ReachedWall> reached_walls(Field& field, const std::vector<Shape>& shapes) {
  std::vector<Shape> pieces;
  for (const Shape& shape : shapes)
    for (const Shape& piece : pieces_of(shape)) pieces.push_back(piece);
  std::vector<ReachedWall> out;
  for (Organ& organ : field.organs) {
    const double reach = std::max(contact_gap, organ.definition.wall.burn_reach);
    if (!clearance_within(shapes, organ, reach)) continue;
    ReachedWall wall{&organ, {}};
    for (const Shape& piece : pieces)
      if (const std::optional<Clearance> near = clearance_within({piece}, organ, reach))
        wall.places.push_back({near->place, burn_weight(near->distance, reach)});
    if (!wall.places.empty()) out.push_back(std::move(wall));
  }
  return out;
}

void burn(const ReachedWall& wall, const std::string& instrument, double energy,
          std::vector<WorldEvent>& events) {
  Organ& organ = *wall.organ;
  const PlacesAtRest at_rest(organ);
  double sum = 0;
  for (const HeatedPlace& place : wall.places) sum += place.weight;
  for (const HeatedPlace& place : wall.places) {
    const std::size_t k = burnt_place(organ.burns, at_rest.of(place.at));
    const double before = organ.burns[k].energy;
    organ.burns[k].energy += energy * place.weight / sum;
    judge_wall(organ, before, organ.burns[k].energy, place.at, instrument, events);
    if (has_capsule(organ.definition.shape)) judge_capsule(organ, k, place.at, instrument, events);
  }
}

}  // namespace calot
