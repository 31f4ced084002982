#include "geometry/star_split.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace calot {
namespace {

/// Where p lies in a triangle, whose plane it is in.
FacePoint place_in(const TriMesh& mesh, int face, const Vec3& p) {
  const Triangle& t = mesh.triangles[face];
  const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
  const Vec3 n = (b - a).cross(c - a);
  return {face, (p - a).cross(c - a).dot(n) / n.squaredNorm(), (b - a).cross(p - a).dot(n) / n.squaredNorm()};
}

int add_point(TriMesh& mesh, const Vec3& p) {
  mesh.points.push_back(p);
  return static_cast<int>(mesh.points.size()) - 1;
}

int add_middle(TriMesh& mesh, int a, int b) {
  return add_point(mesh, 0.5 * (mesh.points[a] + mesh.points[b]));
}

void add_star(StarMesh& split, const FacePoint& at) {
  TriMesh& mesh = split.mesh;
  Star star;
  const Triangle t = mesh.triangles[at.face];
  star.corners = t;
  const Vec3 w(1 - at.u - at.v, at.u, at.v);
  star.centre =
      add_point(mesh, w[0] * mesh.points[t[0]] + w[1] * mesh.points[t[1]] + w[2] * mesh.points[t[2]]);
  for (int i = 0; i < 3; ++i) star.inner[i] = add_middle(mesh, star.centre, t[i]);
  star.heirs = star.inner;
  std::vector<Triangle> parts;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    parts.push_back({star.centre, star.inner[i], star.inner[j]});
    parts.push_back({t[i], t[j], star.inner[j]});
    parts.push_back({t[i], star.inner[j], star.inner[i]});
  }
  // In the touched triangle's place, so that the others keep their numbers.
  mesh.triangles[at.face] = parts.back();
  mesh.triangles.insert(mesh.triangles.end(), parts.begin(), parts.end() - 1);
  split.parent.insert(split.parent.end(), parts.size() - 1, at.face);
  split.stars.push_back(star);
}

/// Numbers the middles of the edges between two triangles of one and the same parent with a star.
class Middles {
 public:
  Middles(StarMesh& split, const std::vector<bool>& has_star) : mesh_(split.mesh) {
    std::map<std::pair<int, int>, int> parent_of;
    for (std::size_t t = 0; t < split.parent.size(); ++t) {
      if (!has_star[split.parent[t]]) continue;
      const Triangle& c = split.mesh.triangles[t];
      for (int k = 0; k < 3; ++k) {
        const std::pair<int, int> edge = std::minmax(c[k], c[(k + 1) % 3]);
        const auto [seen, is_new] = parent_of.emplace(edge, split.parent[t]);
        if (!is_new && seen->second == split.parent[t])
          middle_.emplace(edge, add_middle(mesh_, c[k], c[(k + 1) % 3]));
      }
    }
  }
  /// -1: the edge stays whole.
  int operator()(int a, int b) const {
    const auto found = middle_.find(std::minmax(a, b));
    return found == middle_.end() ? -1 : found->second;
  }

 private:
  TriMesh& mesh_;
  std::map<std::pair<int, int>, int> middle_;
};

/// One triangle of a star: into four, or three when the edge from a to b stays whole.
void add_parts(const TriMesh& mesh, const Triangle& t, const Middles& middle, std::vector<Triangle>& out) {
  int k = 0;
  while (k < 2 && middle(t[k], t[(k + 1) % 3]) >= 0) ++k;
  const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
  const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
  out.push_back({ca, bc, c});
  if (ab >= 0) {
    out.insert(out.end(), {{a, ab, ca}, {ab, b, bc}, {ab, bc, ca}});
  } else if ((mesh.points[a] - mesh.points[bc]).norm() <= (mesh.points[b] - mesh.points[ca]).norm()) {
    out.insert(out.end(), {{a, b, bc}, {a, bc, ca}});
  } else {
    out.insert(out.end(), {{a, b, ca}, {b, bc, ca}});
  }
}

void subdivide(StarMesh& split, const std::vector<bool>& has_star) {
  const Middles middle(split, has_star);
  std::vector<Triangle> triangles;
  std::vector<int> parent;
  for (std::size_t t = 0; t < split.parent.size(); ++t) {
    if (has_star[split.parent[t]])
      add_parts(split.mesh, split.mesh.triangles[t], middle, triangles);
    else
      triangles.push_back(split.mesh.triangles[t]);
    parent.resize(triangles.size(), split.parent[t]);
  }
  split.mesh.triangles = std::move(triangles);
  split.parent = std::move(parent);
  for (Star& star : split.stars)
    for (int i = 0; i < 3; ++i) star.heirs[i] = middle(star.corners[i], star.heirs[i]);
}

}  // namespace

StencilTable linear_stencils(const std::vector<Triangle>& triangles, std::span<const FacePoint> points) {
  StencilTable table;
  for (const FacePoint& p : points) {
    const Triangle& t = triangles[p.face];
    const double value[3] = {1 - p.u - p.v, p.u, p.v}, du[3] = {-1, 1, 0}, dv[3] = {-1, 0, 1};
    int order[3] = {0, 1, 2};
    std::sort(order, order + 3, [&t](int a, int b) { return t[a] < t[b]; });
    for (int k : order) {
      table.node.push_back(t[k]);
      table.value.push_back(value[k]);
      table.du.push_back(du[k]);
      table.dv.push_back(dv[k]);
    }
    table.begin.push_back(static_cast<int>(table.node.size()));
  }
  return table;
}

FacePoint stand_back(const FacePoint& contact) {
  Vec3 w(1 - contact.u - contact.v, contact.u, contact.v);
  w = (w.array() - least_weight).max(0.0);
  w = least_weight + (1 - 3 * least_weight) / w.sum() * w.array();
  return {contact.face, w[1], w[2]};
}

Result<StarMesh> star_split(const TriMesh& coarse, std::span<const FacePoint> contacts, int levels) {
  const int faces = static_cast<int>(coarse.triangles.size());
  if (levels < 0) return fail(FailureKind::usage, fmt::format("{} levels of subdivision", levels));
  StarMesh split;
  split.mesh = coarse;
  split.coarse_nodes = static_cast<int>(coarse.points.size());
  for (int t = 0; t < faces; ++t) split.parent.push_back(t);
  std::vector<bool> has_star(faces, false);
  for (const FacePoint& contact : contacts) {
    if (contact.face < 0 || contact.face >= faces || !std::isfinite(contact.u) || !std::isfinite(contact.v))
      return fail(FailureKind::usage, fmt::format("a contact at ({}, {}) of face {} of {}", contact.u,
                                                  contact.v, contact.face, faces));
    if (has_star[contact.face])
      return fail(FailureKind::usage, fmt::format("two contacts in face {}", contact.face),
                  "one extension serves both");
    add_star(split, stand_back(contact));
    has_star[contact.face] = true;
  }
  for (int level = 0; level < levels; ++level) subdivide(split, has_star);
  split.places.resize(split.mesh.points.size() - coarse.points.size());
  for (std::size_t t = 0; t < split.parent.size(); ++t) {
    const int face = split.parent[t];
    split.extended.push_back(has_star[face]);
    for (int node : split.mesh.triangles[t])
      if (node >= split.coarse_nodes)
        split.places[node - split.coarse_nodes] = place_in(coarse, face, split.mesh.points[node]);
  }
  return split;
}

namespace {

/// Turns the edge from a to b of triangle t: its other triangle and t share the edge between their apexes.
void flip(TriMesh& mesh, Triangle& t, int a, int b, int apex) {
  for (Triangle& other : mesh.triangles) {
    for (int j = 0; j < 3; ++j) {
      if (other[j] != b || other[(j + 1) % 3] != a) continue;
      const int opposite = other[(j + 2) % 3];
      t = {apex, a, opposite};
      other = {opposite, b, apex};
      return;
    }
  }
}

/// Corners drawn along their spokes may come to lie on one line with a node between them: a triangle without
/// area, whose long edge is then flipped.
void mend_flat(TriMesh& mesh) {
  constexpr double flat = 1e-9;
  for (Triangle& t : mesh.triangles) {
    const Triangle c = t;
    for (int k = 0; k < 3; ++k) {
      const int a = c[k], b = c[(k + 1) % 3], apex = c[(k + 2) % 3];
      const Vec3 to_a = mesh.points[a] - mesh.points[apex], to_b = mesh.points[b] - mesh.points[apex];
      if (to_a.cross(to_b).norm() <= flat * (to_a - to_b).squaredNorm() && to_a.dot(to_b) < 0)
        flip(mesh, t, a, b, apex);
    }
  }
}

}  // namespace

StarControl star_control(const StarMesh& structure) {
  const auto& points = structure.mesh.points;
  std::vector<int> stands_for(points.size());
  for (std::size_t i = 0; i < stands_for.size(); ++i) stands_for[i] = static_cast<int>(i);
  for (const Star& star : structure.stars)
    for (int i = 0; i < 3; ++i) {
      const int corner = star.corners[i];
      int& heir = stands_for[corner];
      if (heir == corner ||
          (points[star.heirs[i]] - points[corner]).norm() < (points[heir] - points[corner]).norm())
        heir = star.heirs[i];
    }
  StarControl control;
  std::vector<int> number(stands_for.size(), -1);
  for (std::size_t i = 0; i < stands_for.size(); ++i) {
    if (stands_for[i] != static_cast<int>(i)) continue;
    number[i] = add_point(control.mesh, points[i]);
    control.node.push_back(static_cast<int>(i));
  }
  for (const Triangle& t : structure.mesh.triangles) {
    const Triangle c = {number[stands_for[t[0]]], number[stands_for[t[1]]], number[stands_for[t[2]]]};
    if (c[0] != c[1] && c[1] != c[2] && c[2] != c[0]) control.mesh.triangles.push_back(c);
  }
  mend_flat(control.mesh);
  return control;
}

}  // namespace calot
