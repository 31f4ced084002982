#include "view/vessels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "base/rng.h"
#include "geometry/tri_mesh.h"

namespace calot {
namespace {

constexpr double twig_radius = 0.085e-3, trunk_radius = 0.75e-3;  // m
constexpr int served = 420;                                       // points that the tree reaches

struct Edge {
  int to;
  double cost;
};

std::vector<std::vector<Edge>> stretched_edges(const std::vector<Vec3>& rest,
                                               const std::vector<Triangle>& triangles, Rng& rng) {
  std::vector<std::vector<Edge>> edges(rest.size());
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (a > b) continue;  // a closed surface has each edge twice, once each way
      const double cost = (rest[a] - rest[b]).norm() * (1 + 2.5 * rng.uniform());
      edges[a].push_back({b, cost});
      edges[b].push_back({a, cost});
    }
  return edges;
}

/// Two points near the low end, apart from each other across the axis: an artery's two branches.
std::vector<int> usual_roots(const std::vector<Vec3>& rest) {
  double low = std::numeric_limits<double>::max(), high = -low;
  for (const Vec3& p : rest) low = std::min(low, p.z()), high = std::max(high, p.z());
  std::pair<int, int> best{0, 0};
  const double limit = low + 0.12 * (high - low);
  for (int i = 0; i < static_cast<int>(rest.size()); ++i) {
    if (rest[i].z() > limit) continue;
    if (rest[i].y() > rest[best.first].y() || rest[best.first].z() > limit) best.first = i;
    if (rest[i].y() < rest[best.second].y() || rest[best.second].z() > limit) best.second = i;
  }
  return {best.first, best.second};
}

/// A trunk's line in small steps, each moved onto the tangent plane of the surface's point that is nearest to it.
struct LaidTrunk {
  std::vector<Vec3> places;
  std::vector<int> nearest;  ///< of the surface's points, for each
};

LaidTrunk lay(const VesselTrunk& trunk, const std::vector<Vec3>& rest, const std::vector<Vec3>& normals) {
  constexpr double step = 0.5e-3;  // m, about a voxel
  LaidTrunk out;
  const std::vector<Vec3>& line = trunk.line;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vec3 way = line[k + 1] - line[k];
    const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / step)));
    for (int i = k == 0 ? 0 : 1; i <= steps; ++i) {
      const Vec3 at = line[k] + static_cast<double>(i) / steps * way;
      const int nearest = nearest_of(rest, at);
      out.nearest.push_back(nearest);
      out.places.push_back(at - normals[nearest] * normals[nearest].dot(at - rest[nearest]));
    }
  }
  // Corners of its line, and steps from one tangent plane to the next, are rounded off.
  for (int pass = 0; pass < 6; ++pass) {
    const std::vector<Vec3> before = out.places;
    for (std::size_t i = 1; i + 1 < before.size(); ++i)
      out.places[i] = 0.25 * before[i - 1] + 0.5 * before[i] + 0.25 * before[i + 1];
  }
  return out;
}

std::vector<Vec3> point_normals(const std::vector<Vec3>& rest, const std::vector<Triangle>& triangles) {
  std::vector<Vec3> out(rest.size(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 area = (rest[t[1]] - rest[t[0]]).cross(rest[t[2]] - rest[t[0]]);
    for (const int corner : t) out[corner] += area;
  }
  for (Vec3& normal : out) normal.normalize();
  return out;
}

/// Each point's next point on its way to a root; -1 at roots and where no way leads.
std::vector<int> ways(const std::vector<std::vector<Edge>>& edges, const std::vector<int>& from) {
  std::vector<double> distance(edges.size(), std::numeric_limits<double>::max());
  std::vector<int> next(edges.size(), -1);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const int root : from) queue.push({distance[root] = 0, root});
  while (!queue.empty()) {
    const auto [reached, point] = queue.top();
    queue.pop();
    if (reached > distance[point]) continue;
    for (const Edge& edge : edges[point]) {
      const double there = reached + edge.cost;
      if (there >= distance[edge.to]) continue;
      distance[edge.to] = there;
      next[edge.to] = point;
      queue.push({there, edge.to});
    }
  }
  return next;
}

/// How many served points lie upstream of each point.
std::vector<int> flows(const std::vector<int>& next, Rng& rng) {
  std::vector<int> flow(next.size(), 0);
  for (int i = 0; i < served; ++i)
    for (int p = static_cast<int>(rng.next() % next.size()); p >= 0; p = next[p]) ++flow[p];
  return flow;
}

/// Straightens the staircase of mesh edges: each point towards the middle of its neighbours along the tree.
std::vector<Vec3> smoothed(std::vector<Vec3> points, const std::vector<int>& next,
                           const std::vector<int>& flow) {
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<Vec3> sum(points.size(), Vec3::Zero());
    std::vector<double> weight(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (flow[i] > 0 && next[i] >= 0) {
        sum[next[i]] += flow[i] * points[i], weight[next[i]] += flow[i];
        sum[i] += flow[i] * points[next[i]], weight[i] += flow[i];
      }
    for (std::size_t i = 0; i < points.size(); ++i)
      if (weight[i] > 0) points[i] = 0.5 * points[i] + 0.5 * sum[i] / weight[i];
  }
  return points;
}

void stamp(VesselMap& map, const Vec3& a, const Vec3& b, double radius) {
  const double h = map.voxel, reach = radius + h;
  const Vec3 low = (a.cwiseMin(b) - map.lower) / h, high = (a.cwiseMax(b) - map.lower) / h;
  Eigen::Vector3i first, last;
  for (int c = 0; c < 3; ++c) {
    first[c] = std::max(0, static_cast<int>(std::floor(low[c] - reach / h)));
    last[c] = std::min(map.size[c] - 1, static_cast<int>(std::floor(high[c] + reach / h)));
  }
  const Vec3 line = b - a;
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x) {
        const Vec3 p = map.lower + h * (Vec3(x, y, z) + Vec3::Constant(0.5)) - a;
        const double along = std::clamp(p.dot(line) / std::max(line.squaredNorm(), 1e-18), 0.0, 1.0);
        // Thinner than a voxel a vessel fades rather than widens.
        const double edge = std::clamp((reach - (p - along * line).norm()) / h, 0.0, 1.0);
        const double share = edge * std::min(1.0, 0.25 + 0.75 * radius / (0.6 * h));
        unsigned char& voxel = map.share[(static_cast<std::size_t>(z) * map.size[1] + y) * map.size[0] + x];
        voxel = std::max(voxel, static_cast<unsigned char>(std::lround(255 * share)));
      }
}

}  // namespace

std::shared_ptr<const VesselMap> grow_vessels(const std::vector<Vec3>& rest,
                                              const std::vector<Triangle>& triangles,
                                              const std::vector<VesselTrunk>& trunks) {
  if (rest.empty()) return nullptr;
  Rng rng(0x7e55e1);
  const std::vector<Vec3> normals = point_normals(rest, triangles);
  std::vector<LaidTrunk> laid;
  std::vector<int> roots;
  for (const VesselTrunk& trunk : trunks) {
    laid.push_back(lay(trunk, rest, normals));
    roots.insert(roots.end(), laid.back().nearest.begin(), laid.back().nearest.end());
  }
  if (roots.empty()) roots = usual_roots(rest);
  const std::vector<int> next = ways(stretched_edges(rest, triangles, rng), roots);
  const std::vector<int> flow = flows(next, rng);
  const std::vector<Vec3> points = smoothed(rest, next, flow);

  auto map = std::make_shared<VesselMap>();
  Vec3 low = rest.front(), high = rest.front();
  for (const Vec3& p : rest) low = low.cwiseMin(p), high = high.cwiseMax(p);
  // At most 224 voxels a side, whatever the organ's size.
  map->voxel = std::max(map->voxel, (high - low).maxCoeff() / 222);
  map->lower = low - Vec3::Constant(map->voxel);
  for (int c = 0; c < 3; ++c) map->size[c] = static_cast<int>(std::ceil((high - low)[c] / map->voxel)) + 2;
  map->share.assign(static_cast<std::size_t>(map->size[0]) * map->size[1] * map->size[2], 0);
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (flow[i] > 0 && next[i] >= 0)
      stamp(*map, points[i], points[next[i]], std::min(trunk_radius, twig_radius * std::cbrt(flow[i])));
  for (std::size_t k = 0; k < laid.size(); ++k) {
    const std::vector<Vec3>& places = laid[k].places;
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
      stamp(*map, places[i], places[i + 1],
            trunks[k].radius * (1 - 0.5 * static_cast<double>(i) / static_cast<double>(places.size())));
  }
  return map;
}

}  // namespace calot
