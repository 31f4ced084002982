#include "collision/skin_edges.h"

#include <algorithm>
#include <cmath>

namespace calot {
namespace {

EdgePair of_ends(const std::array<int, 4>& ends, const std::vector<Vec3>& one,
                 const std::vector<Vec3>& other) {
  return {one[ends[0]], one[ends[1]], other[ends[2]], other[ends[3]]};
}

/// Whether a plane across the `way` between the edges keeps them apart all along: few could meet at all.
bool stay_apart(const EdgePair& at, const EdgePair& motions, const Vec3& way, double keep) {
  const double target = keep * way.squaredNorm();
  for (int i : {0, 1})
    for (int k : {2, 3}) {
      const double room = way.dot(at[i] - at[k]), approach = way.dot(motions[k] - motions[i]);
      if (!(std::min(room, room - approach) > target)) return false;
    }
  return true;
}

}  // namespace

SurfaceEdges::SurfaceEdges(const std::vector<Vec3>& rest, const std::vector<Triangle>& triangles,
                           std::span<const char> counts)
    : sides(triangles.size()) {
  const auto sorted = [&](std::size_t k) {
    Triangle t = triangles[k];
    std::sort(t.begin(), t.end());
    return t;
  };
  struct Side {
    std::array<int, 2> ends;
    std::size_t triangle, index;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> all;
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    if (!counts.empty() && !counts[k]) continue;
    const Triangle t = sorted(k);
    all.insert(all.end(), {{{t[0], t[1]}, k, 0}, {{t[0], t[2]}, k, 1}, {{t[1], t[2]}, k, 2}});
  }
  std::sort(all.begin(), all.end());
  for (const auto& [both, of, index] : all) {
    if (ends.empty() || ends.back() != both) {
      ends.push_back(both);
      lengths.push_back((rest[both[1]] - rest[both[0]]).norm());
      areas.push_back(0);
      triangle.push_back(static_cast<int>(of));
    }
    longest = std::max(longest, lengths.back());
    const Triangle t = sorted(of);
    areas.back() += (rest[t[1]] - rest[t[0]]).cross(rest[t[2]] - rest[t[0]]).norm() / 6;
    sides[of][index] = static_cast<int>(ends.size()) - 1;
  }
}

std::vector<Vec3> SurfaceEdges::middles(const std::vector<Vec3>& points) const {
  std::vector<Vec3> out;
  for (const auto& [a, b] : ends) out.push_back(0.5 * (points[a] + points[b]));
  return out;
}

std::array<int, 4> ends_of(const SurfaceEdges& one, const SurfaceEdges& other, const EdgesNear& pair) {
  const auto &a = one.ends[pair.edge], &b = other.ends[pair.other];
  return {a[0], a[1], b[0], b[1]};
}

EdgePair places_of(const PlacedEdges& one, const PlacedEdges& other, const EdgesNear& pair) {
  return of_ends(ends_of(*one.edges, *other.edges, pair), *one.points, *other.points);
}

std::optional<EdgeTouch> edge_touch(const PlacedEdges& one, const PlacedEdges& other, const EdgesNear& pair,
                                    const Barrier& barrier) {
  const EdgePair at = places_of(one, other, pair);
  constexpr double beyond = 1.01;  // of what rounding could decide
  if (between_edges(at).norm() >= beyond * barrier.range) return std::nullopt;
  const double bound = EdgeCrossing::parallel_bound(one.edges->lengths[pair.edge],
                                                    other.edges->lengths[pair.other], barrier.range);
  const EdgeCrossing::Sample sample = EdgeCrossing{barrier, bound}.sample(at);
  if (sample.energy == 0) return std::nullopt;
  return EdgeTouch{ends_of(*one.edges, *other.edges, pair), sample,
                   std::sqrt(one.edges->areas[pair.edge] * other.edges->areas[pair.other])};
}

double safe_share(const PlacedEdges& one, const PlacedEdges& other, const EdgesNear& pair, double keep,
                  double share, double most) {
  const EdgePair at = places_of(one, other, pair);
  EdgePair motions = of_ends(ends_of(*one.edges, *other.edges, pair), *one.motions, *other.motions);
  for (Vec3& m : motions) m *= share;
  const Vec3 way = between_edges(at);
  const double distance = way.norm(), kept = distance > most ? keep * most / distance : keep;
  if (stay_apart(at, motions, way, kept)) return share;
  return share * safe_share(at, motions, kept);
}

}  // namespace calot
