#include "geometry/self_touch.h"

#include <algorithm>
#include <numeric>

namespace calot {

namespace {

struct Segment {
  Vec3 a, b;
};
using Corners = std::array<Vec3, 3>;

double squared_distance(const Vec3& p, const Segment& s) {
  const Vec3 along = s.b - s.a;
  const double t = std::clamp((p - s.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (s.a + t * along - p).squaredNorm();
}

/// Between two segments: the common perpendicular where it meets both, else from an end.
double squared_distance(const Segment& p, const Segment& q) {
  const Vec3 u = p.b - p.a, v = q.b - q.a, w = q.a - p.a;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const double det = uu * vv - uv * uv;
  if (det > 0) {
    const double s = (u.dot(w) * vv - v.dot(w) * uv) / det, t = (u.dot(w) * uv - v.dot(w) * uu) / det;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) return (w + t * v - s * u).squaredNorm();
  }
  return std::min({squared_distance(p.a, q), squared_distance(p.b, q), squared_distance(q.a, p),
                   squared_distance(q.b, p)});
}

/// Whether p, moved along the triangle's normal, falls inside it.
bool above(const Vec3& p, const Corners& t, const Vec3& normal) {
  for (int k = 0; k < 3; ++k)
    if ((t[(k + 1) % 3] - t[k]).cross(p - t[k]).dot(normal) < 0) return false;
  return true;
}

bool touches(const Segment& s, const Corners& t, double tolerance) {
  const double squared = tolerance * tolerance;
  for (int k = 0; k < 3; ++k)
    if (squared_distance(s, {t[k], t[(k + 1) % 3]}) <= squared) return true;
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  const double a = normal.dot(s.a - t[0]), b = normal.dot(s.b - t[0]);
  if (std::abs(a) <= tolerance && above(s.a, t, normal)) return true;
  if (std::abs(b) <= tolerance && above(s.b, t, normal)) return true;
  return (a < 0) != (b < 0) && above(s.a + a / (a - b) * (s.b - s.a), t, normal);
}

class Pair {
 public:
  Pair(const TriMesh& mesh, int a, int b) : mesh_(mesh), a_(mesh.triangles[a]), b_(mesh.triangles[b]) {}

  bool touch(double tolerance) const {
    std::vector<int> shared;
    for (int node : a_)
      if (std::find(b_.begin(), b_.end(), node) != b_.end()) shared.push_back(node);
    if (shared.empty()) return any_edge(a_, b_, tolerance) || any_edge(b_, a_, tolerance);
    // Beyond a shared corner two triangles can only meet on the edge opposite to it in one of them.
    if (shared.size() == 1) {
      return touches(opposite(a_, shared[0]), corners(b_), tolerance) ||
             touches(opposite(b_, shared[0]), corners(a_), tolerance);
    }
    return shared.size() == 3 || folded(shared[0], shared[1], tolerance);
  }

 private:
  Corners corners(const Triangle& t) const {
    return {mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]};
  }
  Segment opposite(const Triangle& t, int node) const {
    const int k = static_cast<int>(std::find(t.begin(), t.end(), node) - t.begin());
    return {mesh_.points[t[(k + 1) % 3]], mesh_.points[t[(k + 2) % 3]]};
  }
  bool any_edge(const Triangle& edges, const Triangle& face, double tolerance) const {
    return std::any_of(edges.begin(), edges.end(),
                       [&](int node) { return touches(opposite(edges, node), corners(face), tolerance); });
  }
  /// Whether the two apexes lie on the same side of the shared edge, in one plane.
  bool folded(int p, int q, double tolerance) const {
    const auto apex = [&](const Triangle& t) {
      return mesh_.points[*std::find_if(t.begin(), t.end(), [&](int n) { return n != p && n != q; })];
    };
    const Vec3 start = mesh_.points[p], along = (mesh_.points[q] - start).normalized();
    Vec3 u = apex(a_) - start, v = apex(b_) - start;
    u -= along * along.dot(u);
    v -= along * along.dot(v);
    return u.dot(v) > 0 && u.cross(v).norm() <= tolerance * std::max(u.norm(), v.norm());
  }

  const TriMesh& mesh_;
  const Triangle &a_, &b_;
};

}  // namespace

std::vector<std::pair<int, int>> touching_pairs(const TriMesh& mesh, double tolerance) {
  const int n = static_cast<int>(mesh.triangles.size());
  std::vector<Vec3> low(n), high(n);
  for (int t = 0; t < n; ++t) {
    const Triangle& c = mesh.triangles[t];
    low[t] = mesh.points[c[0]].cwiseMin(mesh.points[c[1]]).cwiseMin(mesh.points[c[2]]).array() - tolerance;
    high[t] = mesh.points[c[0]].cwiseMax(mesh.points[c[1]]).cwiseMax(mesh.points[c[2]]);
  }
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return low[a].x() != low[b].x() ? low[a].x() < low[b].x() : a < b; });
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n && low[order[j]].x() <= high[order[i]].x(); ++j) {
      const auto [a, b] = std::minmax(order[i], order[j]);
      if ((low[a].array() > high[b].array()).any() || (low[b].array() > high[a].array()).any()) continue;
      if (Pair(mesh, a, b).touch(tolerance)) pairs.emplace_back(a, b);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace calot
