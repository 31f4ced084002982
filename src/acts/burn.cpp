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

/// What of a surface is nearest to a shape.
struct NearestSurface {
  double distance = std::numeric_limits<double>::infinity();  ///< m; infinite: nothing is near enough
  Vec3 at = Vec3::Zero();                                     ///< m
};

/// On a triangle (columns, m) that carries a surface of such radii (m) around its corners. The distance is convex along it:
/// steps from corner to corner that only go down end where it is least.
NearestSurface nearest_on_triangle(const Shape& shape, const Mat3& corners, const Vec3& radii) {
  constexpr double finest = 1e-3;  // of an edge
  const auto distance = [&](const Vec3& weights) {
    return signed_distance(shape, corners * weights) - radii.dot(weights);
  };
  Vec3 weights = Vec3::Constant(1.0 / 3);
  double least = distance(weights);
  for (double step = 1.0 / 3; step > finest;) {
    bool lower = false;
    for (int way = 0; way < 6; ++way) {
      Vec3 next = weights;
      const int from = way / 2, to = (from + 1 + way % 2) % 3;
      const double moved = std::min(step, weights[from]);
      next[from] -= moved;
      next[to] += moved;
      if (const double there = distance(next); there < least) {
        weights = next;
        least = there;
        lower = true;
      }
    }
    if (!lower) step *= 0.5;
  }
  const Vec3 at = corners * weights;
  return {least, at - radii.dot(weights) * distance_slope(shape, at).gradient};
}

/// Of an organ's surface what is nearest to some shapes and nearer than `reach` (m).
NearestSurface nearest_surface(const Organ& organ, const std::vector<Shape>& shapes, double reach) {
  const Body& body = *organ.body;
  const VecX& x = organ.state.x;
  NearestSurface nearest;
  if (!may_reach(body, x, shapes, reach)) return nearest;
  ContactLoads near;
  near.shapes = shapes;
  near.barrier.range = reach;
  const std::vector<double>& radii = body.skin_radii();
  ContactPlaces places(body.skin(), x, radii);
  for (const ContactPair& pair : gather_pairs(body, x, near, -contact_margin)) {
    if (pair.distance >= nearest.distance) continue;
    const Triangle& t = body.skin().triangles[pair.triangle];
    const Vec3 around = radii.empty() ? Vec3::Zero().eval() : Vec3(radii[t[0]], radii[t[1]], radii[t[2]]);
    const NearestSurface found =
        nearest_on_triangle(shapes[pair.shape], places.corners(pair.triangle), around);
    if (found.distance < nearest.distance) nearest = found;
  }
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
