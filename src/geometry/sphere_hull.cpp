#include "geometry/sphere_hull.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace calot {

namespace {

/// Six times the volume of (face, p): positive when p lies on the face's outer side.
double height(std::span<const Vec3> x, const Triangle& f, const Vec3& p) {
  return (x[f[1]] - x[f[0]]).cross(x[f[2]] - x[f[0]]).dot(p - x[f[0]]);
}

/// The first four points that span a tetrahedron, as its four outward faces; empty when there are none.
std::vector<Triangle> first_tetrahedron(std::span<const Vec3> x) {
  const int n = static_cast<int>(x.size());
  int a = 0, b = 1, c = 2, d = 3;
  double largest = 0;
  for (int k = 3; k < n; ++k) {
    const double h = std::abs(height(x, {0, 1, 2}, x[k]));
    if (h > largest) {
      largest = h;
      d = k;
    }
  }
  if (largest == 0) return {};
  if (height(x, {a, b, c}, x[d]) > 0) std::swap(b, c);
  return {{a, b, c}, {a, d, b}, {b, d, c}, {c, d, a}};
}

/// Replaces the faces that see point p by a fan from their common border.
void insert(std::span<const Vec3> x, int p, std::vector<Triangle>& faces) {
  std::vector<Triangle> kept;
  std::map<std::pair<int, int>, bool> edges;  // directed edges of the faces that see p
  for (const Triangle& f : faces) {
    if (height(x, f, x[p]) <= 0) {
      kept.push_back(f);
      continue;
    }
    for (int k = 0; k < 3; ++k) edges[{f[k], f[(k + 1) % 3]}] = true;
  }
  for (const auto& [edge, seen] : edges)
    if (!edges.contains({edge.second, edge.first})) kept.push_back({edge.first, edge.second, p});
  faces = std::move(kept);
}

/// Every point used, and the counts of a closed surface of genus 0 with each edge in two opposite faces.
bool is_sphere(int points, const std::vector<Triangle>& faces) {
  std::vector<bool> used(points, false);
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& f : faces) {
    for (int k = 0; k < 3; ++k) {
      used[f[k]] = true;
      ++edges[{f[k], f[(k + 1) % 3]}];
    }
  }
  for (const auto& [edge, count] : edges)
    if (count != 1 || !edges.contains({edge.second, edge.first})) return false;
  for (bool u : used)
    if (!u) return false;
  return static_cast<int>(faces.size()) == 2 * points - 4;
}

/// Rounding decides on which side of its own faces such a point would lie.
bool any_coincide(std::span<const Vec3> points) {
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::vector<Vec3> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(), less);
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

}  // namespace

Result<std::vector<Triangle>> sphere_hull(std::span<const Vec3> points) {
  const int n = static_cast<int>(points.size());
  std::vector<Triangle> faces;
  if (n >= 4 && !any_coincide(points)) faces = first_tetrahedron(points);
  if (!faces.empty()) {
    const int d = faces[1][1];
    for (int p = 3; p < n; ++p)
      if (p != d) insert(points, p, faces);
  }
  if (!is_sphere(n, faces)) {
    return fail(FailureKind::scenario, fmt::format("{} points have no triangulation on the sphere", n),
                "points may coincide; ask for fewer nodes or a more even spacing");
  }
  return faces;
}

}  // namespace calot
