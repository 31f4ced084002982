#pragma once
// The Loop limit surface by its definition, for tests: explicit subdivision (Loop 1987) round one point until
// the triangle that holds it has regular corners, and there the box spline in closed form (Stam 1998).

#include <algorithm>
#include <map>
#include <numbers>
#include <vector>

#include "geometry/stencil.h"
#include "geometry/tri_mesh.h"

namespace calot::test {

struct SurfacePoint {
  Vec3 value, du, dv, duu, duv, dvv;
};

/// One weight of the twelve-point box spline at barycentric (u, v, w) as the coefficient times u^i v^j w^k.
struct Term {
  double coefficient;
  int i, j, k;
};

/// Weight of the corner at w = 1; the other corners by permutation.
inline const std::vector<Term>& corner_terms() {
  static const std::vector<Term> terms = {{6, 0, 0, 4}, {24, 1, 0, 3}, {24, 2, 0, 2}, {8, 3, 0, 1},
                                          {1, 4, 0, 0}, {24, 0, 1, 3}, {60, 1, 1, 2}, {36, 2, 1, 1},
                                          {6, 3, 1, 0}, {24, 0, 2, 2}, {36, 1, 2, 1}, {12, 2, 2, 0},
                                          {8, 0, 3, 1}, {6, 1, 3, 0},  {1, 0, 4, 0}};
  return terms;
}
/// Weight of the point across the edge from the corner at w = 1: the reflection of that corner.
inline const std::vector<Term>& across_terms() {
  static const std::vector<Term> terms = {{1, 4, 0, 0}, {2, 3, 0, 1},  {6, 3, 1, 0},
                                          {6, 2, 1, 1}, {12, 2, 2, 0}, {6, 1, 2, 1},
                                          {6, 1, 3, 0}, {2, 0, 3, 1},  {1, 0, 4, 0}};
  return terms;
}
/// Weight of a point whose only corner of the triangle is that at u = 1 and that lies on the side of v.
inline const std::vector<Term>& outer_terms() {
  static const std::vector<Term> terms = {{1, 4, 0, 0}, {2, 3, 1, 0}};
  return terms;
}

/// Derivative of order (a, b) in (u, v), with w = 1 - u - v, of sum of terms / 12.
inline double derivative(std::vector<Term> terms, int a, int b, double u, double v) {
  const auto differentiate = [](const std::vector<Term>& from, bool by_u) {
    std::vector<Term> to;
    for (const Term& t : from) {
      const int power = by_u ? t.i : t.j;
      if (power > 0) to.push_back({t.coefficient * power, t.i - by_u, t.j - !by_u, t.k});
      if (t.k > 0) to.push_back({-t.coefficient * t.k, t.i, t.j, t.k - 1});
    }
    return to;
  };
  for (int n = 0; n < a; ++n) terms = differentiate(terms, true);
  for (int n = 0; n < b; ++n) terms = differentiate(terms, false);
  double sum = 0;
  for (const Term& t : terms)
    sum += t.coefficient * std::pow(u, t.i) * std::pow(v, t.j) * std::pow(1 - u - v, t.k);
  return sum / 12;
}

/// The part of a closed mesh round one triangle (`triangles[0]`): all triangles that share a corner with it.
class LocalMesh {
 public:
  LocalMesh(const TriMesh& mesh, int face) : triangles_(neighbourhood(mesh.triangles, face)) {
    for (const Triangle& t : triangles_)
      for (int node : t) points_[node] = mesh.points[node];
  }

  bool regular() const {
    const Triangle& t = triangles_[0];
    return std::all_of(t.begin(), t.end(), [&](int node) { return ring(node).size() == 6; });
  }

  /// Subdivides and moves to child 0, 1, 2 (at that corner) or 3 (the middle).
  void descend(int child) {
    std::map<std::pair<int, int>, int> middle;
    std::map<int, Vec3> next;
    int free = points_.rbegin()->first + 1;
    std::vector<Triangle> children;
    for (const auto& [a, b, c] : triangles_) {
      const int ab = midpoint(a, b, middle, free), bc = midpoint(b, c, middle, free),
                ca = midpoint(c, a, middle, free);
      children.insert(children.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    const std::vector<Triangle> kept = neighbourhood(children, child);
    for (const auto& [edge, node] : middle)
      if (contains(kept, node)) next[node] = edge_point(edge.first, edge.second);
    for (const auto& [node, point] : points_)
      if (contains(kept, node)) next[node] = vertex_point(node);
    triangles_ = kept;
    points_ = next;
  }

  SurfacePoint evaluate(double u, double v) const {
    const Triangle& t = triangles_[0];
    SurfacePoint sum{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    const auto add = [&](int node, const std::vector<Term>& terms, std::array<int, 3> order) {
      // `order` says which barycentric of (u, v, w) plays the part of each of the terms' three.
      std::vector<Term> turned;
      for (const Term& term : terms) {
        std::array<int, 3> power{};
        power[order[0]] = term.i, power[order[1]] = term.j, power[order[2]] = term.k;
        turned.push_back({term.coefficient, power[0], power[1], power[2]});
      }
      const Vec3& p = points_.at(node);
      sum.value += derivative(turned, 0, 0, u, v) * p;
      sum.du += derivative(turned, 1, 0, u, v) * p;
      sum.dv += derivative(turned, 0, 1, u, v) * p;
      sum.duu += derivative(turned, 2, 0, u, v) * p;
      sum.duv += derivative(turned, 1, 1, u, v) * p;
      sum.dvv += derivative(turned, 0, 2, u, v) * p;
    };
    // Corners 0, 1, 2 have barycentric w, u, v: numbers 2, 0, 1 of (u, v, w).
    const std::array<int, 3> part = {2, 0, 1};
    for (int k = 0; k < 3; ++k) {
      const int self = part[k], next = part[(k + 1) % 3], last = part[(k + 2) % 3];
      const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      add(a, corner_terms(), {next, last, self});
      add(beyond(c, b), across_terms(), {next, last, self});
      add(beyond(beyond(b, a), a), outer_terms(), {self, next, last});
      add(beyond(a, beyond(a, c)), outer_terms(), {self, last, next});
    }
    return sum;
  }

 private:
  static bool has(const Triangle& t, int node) { return std::find(t.begin(), t.end(), node) != t.end(); }
  static bool contains(const std::vector<Triangle>& all, int node) {
    return std::any_of(all.begin(), all.end(), [&](const Triangle& t) { return has(t, node); });
  }

  /// The triangle `face` first, then those that share a corner with it.
  static std::vector<Triangle> neighbourhood(const std::vector<Triangle>& all, int face) {
    std::vector<Triangle> kept = {all[face]};
    for (int t = 0; t < static_cast<int>(all.size()); ++t)
      if (t != face && std::any_of(all[face].begin(), all[face].end(), [&](int n) { return has(all[t], n); }))
        kept.push_back(all[t]);
    return kept;
  }

  static int midpoint(int a, int b, std::map<std::pair<int, int>, int>& middle, int& free) {
    const auto [place, is_new] = middle.emplace(std::minmax(a, b), free);
    if (is_new) ++free;
    return place->second;
  }

  std::vector<int> ring(int node) const {
    std::vector<int> result;
    for (const Triangle& t : triangles_)
      for (int other : t)
        if (has(t, node) && other != node && std::find(result.begin(), result.end(), other) == result.end())
          result.push_back(other);
    return result;
  }

  Vec3 vertex_point(int node) const {
    const std::vector<int> around = ring(node);
    const double n = static_cast<double>(around.size());
    const double c = 3.0 / 8 + std::cos(2 * std::numbers::pi / n) / 4;
    const double beta = (5.0 / 8 - c * c) / n;
    Vec3 sum = (1 - n * beta) * points_.at(node);
    for (int other : around) sum += beta * points_.at(other);
    return sum;
  }

  Vec3 edge_point(int a, int b) const {
    Vec3 sum = 3.0 / 8 * (points_.at(a) + points_.at(b));
    for (const Triangle& t : triangles_)
      for (int other : t)
        if (has(t, a) && has(t, b) && other != a && other != b) sum += 1.0 / 8 * points_.at(other);
    return sum;
  }

  /// The third corner of the triangle in which b follows a.
  int beyond(int a, int b) const {
    for (const Triangle& t : triangles_)
      for (int k = 0; k < 3; ++k)
        if (t[k] == a && t[(k + 1) % 3] == b) return t[(k + 2) % 3];
    return -1;
  }

  std::vector<Triangle> triangles_;
  std::map<int, Vec3> points_;
};

/// The limit surface at a point that is not an irregular corner itself.
inline SurfacePoint reference(const TriMesh& mesh, const FacePoint& at) {
  LocalMesh local(mesh, at.face);
  double u = at.u, v = at.v;
  // (u, v) of the small triangle as an affine map of the face's: only its linear part matters for
  // derivatives.
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
  while (!local.regular()) {
    // The children at the corners are half as large; the middle one has (1/2, 0), (1/2, 1/2), (0, 1/2).
    const int child = u > 0.5 ? 1 : v > 0.5 ? 2 : u + v < 0.5 ? 0 : 3;
    const std::array<Vec2, 4> shift = {Vec2(0, 0), Vec2(-1, 0), Vec2(0, -1), Vec2(-1, 1)};
    Eigen::Matrix2d step = 2 * Eigen::Matrix2d::Identity();
    if (child == 3) step << 2, 2, -2, 0;
    local.descend(child);
    const Vec2 now = step * Vec2(u, v) + shift[child];
    u = now.x();
    v = now.y();
    turn = step * turn;
  }
  const SurfacePoint p = local.evaluate(u, v);
  const auto second = [&](int a, int b) -> Vec3 {
    return turn(0, a) * turn(0, b) * p.duu + (turn(0, a) * turn(1, b) + turn(1, a) * turn(0, b)) * p.duv +
           turn(1, a) * turn(1, b) * p.dvv;
  };
  return {p.value,
          turn(0, 0) * p.du + turn(1, 0) * p.dv,
          turn(0, 1) * p.du + turn(1, 1) * p.dv,
          second(0, 0),
          second(0, 1),
          second(1, 1)};
}

}  // namespace calot::test
