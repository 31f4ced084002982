#include "organs/strand_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "body/rod_body.h"

namespace calot {
namespace {

/// A place that a strand may begin at.
struct Candidate {
  CarriedPlace place;
  Vec3 at, normal;    ///< m; of the skin, unit, zero on a rod's line
  double radius = 0;  ///< m, of the surface around it
  double area = 0;    ///< m^2
};

/// A skin as places on its triangles, so close that each strand has several.
std::vector<Candidate> candidates_of(const Organ& organ, int strands) {
  constexpr std::size_t fewest_each = 4;
  const Body& body = *organ.body;
  const std::vector<Triangle>& triangles = body.skin().triangles;
  const std::vector<Vec3> skin = body.skin_positions(organ.state.x),
                          normals = body.skin_normals(organ.state.x);
  std::vector<int> around(skin.size(), 0);  // triangles at each point
  for (const Triangle& t : triangles)
    for (int corner : t) ++around[corner];
  const bool line = body.is_line();
  std::vector<Vec3> rule{Vec3::Constant(1.0 / 3)};
  // A region may be a small part of the skin: as if it were a twentieth.
  if (triangles.size() < 20 * fewest_each * static_cast<std::size_t>(strands))
    rule.assign(contact_rule.begin(), contact_rule.end());
  std::vector<Candidate> out;
  for (const Triangle& t : triangles)
    for (const Vec3& weights : rule) {
      Candidate& one = out.emplace_back();
      one.at = one.normal = Vec3::Zero();
      for (int c = 0; c < 3; ++c) {
        one.place.points.push_back(t[c]);
        one.place.weights.push_back(weights[c]);
        one.at += weights[c] * skin[t[c]];
        if (line)
          one.radius += weights[c] * body.skin_radii()[t[c]];
        else
          one.normal += weights[c] * normals[t[c]];
        one.area += body.skin_areas()[t[c]] / around[t[c]] / static_cast<double>(rule.size());
      }
    }
  return out;
}

/// Candidates that face the other organ near by, each with the nearest place there.
struct Facing {
  Candidate from;
  NearestSkin to;
  Vec3 at;  ///< m, of that
  double gap() const { return to.distance - from.radius - to.radius; }
};

std::vector<Facing> facing(const TissueDefinition& definition, const std::vector<Candidate>& candidates,
                           double thickest, const SkinFinder& other) {
  constexpr double rounding = 1e-12;  // m
  std::vector<Facing> out;
  std::optional<Vec3> last;
  for (const Candidate& from : candidates) {
    double within = definition.within + from.radius + thickest;
    // Candidates that follow each other lie close: what is nearest to one bounds how far the search for the next goes.
    if (last) within = std::min(within, (*last - from.at).norm() + rounding);
    NearestSkin to = other.nearest(from.at, within);
    if (to.place.points.empty()) continue;
    const Vec3 at = other.at(to.place);
    last = at;
    const Facing found{from, std::move(to), at};
    const bool on_far_side = (at - from.at).dot(from.normal) < 0;
    if (!on_far_side && found.gap() >= 0 && found.gap() <= definition.within) out.push_back(found);
  }
  return out;
}

Failure nothing_to_hold(const TissueDefinition& definition, const std::vector<Candidate>& candidates,
                        const SkinFinder& other) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Candidate& from : candidates) {
    const NearestSkin to = other.nearest(from.at, nearest + from.radius);
    if (!to.place.points.empty()) nearest = std::min(nearest, to.distance - from.radius - to.radius);
  }
  return fail(
      FailureKind::scenario,
      fmt::format("'{}' has nothing to hold: '{}' and '{}' are {:.3g} mm apart where they are nearest",
                  definition.name, definition.from, definition.to, 1e3 * nearest),
      "move them together, or raise within", {"", 0, ".within"});
}

/// The nearest place, then always that which is farthest from all that were taken.
std::vector<int> spread_out(const std::vector<Facing>& places, int count) {
  std::vector<double> squared(places.size(), std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  for (std::size_t i = 1; i < places.size(); ++i)
    if (places[i].gap() < places[next].gap()) next = i;
  std::vector<int> taken;
  while (static_cast<int>(taken.size()) < count && squared[next] > 0) {
    taken.push_back(static_cast<int>(next));
    for (std::size_t i = 0; i < places.size(); ++i)
      squared[i] = std::min(squared[i], (places[i].from.at - places[taken.back()].from.at).squaredNorm());
    next = static_cast<std::size_t>(std::max_element(squared.begin(), squared.end()) - squared.begin());
  }
  return taken;
}

}  // namespace

double share_along(const Organ& organ, const CarriedPlace& place) {
  if (const RodBody* rod = organ.body->as_tube()) {
    double share = 0;
    for (std::size_t i = 0; i < place.points.size(); ++i)
      share += place.weights[i] * rod->share_of_length(place.points[i]);
    return share;
  }
  const Vec3 axis = organ.definition.fundus - organ.definition.neck;
  const Vec3 rest = carried_to(place, organ.body->skin_rest());
  return (rest - organ.definition.neck).dot(axis) / axis.squaredNorm();
}

Result<std::vector<StrandPlace>> strand_places(const TissueDefinition& definition, const Organ& one,
                                               const Organ& other) {
  std::vector<Candidate> candidates = candidates_of(one, definition.strands);
  std::erase_if(candidates, [&](const Candidate& candidate) {
    const double share = share_along(one, candidate.place);
    return share < definition.start || share > definition.stop;
  });
  const SkinFinder there(*other.body, other.body->skin_positions(other.state.x));
  const std::vector<Facing> places = facing(definition, candidates, other.body->thickest(), there);
  if (places.empty()) return nothing_to_hold(definition, candidates, there);
  std::vector<StrandPlace> out;
  const std::vector<int> taken = spread_out(places, definition.strands);
  for (int index : taken) {
    const Facing& place = places[index];
    out.push_back(
        {place.from.place, place.to.place, place.from.at, place.at, place.gap(), place.to.distance, 0});
  }
  for (const Facing& place : places) {
    const auto nearest =
        std::min_element(out.begin(), out.end(), [&](const StrandPlace& a, const StrandPlace& b) {
          return (a.from - place.from.at).squaredNorm() < (b.from - place.from.at).squaredNorm();
        });
    nearest->area += place.from.area;
  }
  return out;
}

}  // namespace calot
