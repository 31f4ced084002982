#include "collision/edge_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/parted_motion.h"
#include "collision/simplex_distance.h"

namespace calot {
namespace {

/// Whether the lines through the edges are nearest inside of both; then `out` says where.
bool meet_between_ends(const EdgePair& ends, NearestOfEdges& out) {
  constexpr double most_parallel = 1e-12;  // squared sine of an angle that rounding would decide
  const Vec3 u = ends[1] - ends[0], v = ends[3] - ends[2], w = ends[2] - ends[0], n = u.cross(v);
  const double nn = n.squaredNorm();
  if (!(nn > most_parallel * u.squaredNorm() * v.squaredNorm())) return false;
  const double s = w.cross(v).dot(n) / nn, t = w.cross(u).dot(n) / nn;
  if (!(s > 0 && s < 1 && t > 0 && t < 1)) return false;
  const double across = -w.dot(n) / std::sqrt(nn);
  out.meet = EdgesMeet::between_ends;
  out.distance = std::abs(across);
  out.normal = across == 0 ? Vec3::Zero() : Vec3(std::copysign(1 / std::sqrt(nn), across) * n);
  out.weight = {1 - s, s, t - 1, -t};
  return true;
}

/// The nearest of the four ends to the other edge: nothing else can be where the lines do not meet inside of both.
NearestOfEdges meet_at_an_end(const EdgePair& ends) {
  NearestOfEdges best;
  best.distance = std::numeric_limits<double>::infinity();
  for (int end = 0; end < 4; ++end) {
    const int edge = end < 2 ? 2 : 0, sign = end < 2 ? 1 : -1;
    const NearestPoint there = nearest_point(ends[end], {ends.data() + edge, 2});
    if (there.distance >= best.distance) continue;
    best = {};
    best.distance = there.distance;
    best.weight[end] = sign;
    for (int k = 0; k < 2; ++k) best.weight[edge + k] = -sign * there.weight[k];
    best.meet = there.weight[0] > 0 && there.weight[1] > 0 ? EdgesMeet::at_one_end : EdgesMeet::at_two_ends;
  }
  Vec3 arm = Vec3::Zero();
  for (int k = 0; k < 4; ++k) arm += best.weight[k] * ends[k];
  if (best.distance > 0) best.normal = arm / best.distance;
  return best;
}

}  // namespace

NearestOfEdges nearest_of_edges(const EdgePair& ends) {
  NearestOfEdges out;
  return meet_between_ends(ends, out) ? out : meet_at_an_end(ends);
}

Vec3 between_edges(const EdgePair& ends) {
  const auto share = [](double part, double whole) {
    return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0;
  };
  const Vec3 u = ends[1] - ends[0], v = ends[3] - ends[2], w = ends[0] - ends[2];
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), uw = u.dot(w), vw = v.dot(w);
  const double t = share(uv * share(uv * vw - vv * uw, uu * vv - uv * uv) + vw, vv);
  return w + share(uv * t - uw, uu) * u - t * v;
}

double safe_share(const EdgePair& ends, const EdgePair& motions, double keep) {
  constexpr int max_steps = 4096;
  for (int k = 0; k < 4; ++k)
    if (!ends[k].allFinite() || !motions[k].allFinite()) return 0.0;
  const MovingCorners one{{ends.data(), 2}, {motions.data(), 2}},
      other{{ends.data() + 2, 2}, {motions.data() + 2, 2}};
  return safe_share_of(one, other, keep, max_steps, [&](double share) -> Parting {
    EdgePair now;
    for (int k = 0; k < 4; ++k) now[k] = ends[k] + share * motions[k];
    const NearestOfEdges nearest = nearest_of_edges(now);
    return {nearest.distance, nearest.normal};
  });
}

}  // namespace calot
