#include "geometry/tri_mesh.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "geometry/self_touch.h"

namespace calot {

namespace {

using Edge = std::pair<int, int>;

/// Twice a triangle's area over its longest edge squared is its height over its base: below this it is a
/// line.
constexpr double kFlat = 1e-6;
/// Surfaces closer than this share of the mesh's size touch; well above rounding, well below any wall.
constexpr double kTouch = 1e-9;

Edge undirected(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

class Checker {
 public:
  Checker(const TriMesh& mesh, const MeshRequirements& requirements)
      : mesh_(mesh), requirements_(requirements) {}

  std::vector<Problem> run() {
    if (mesh_.triangles.empty()) report("the mesh has no triangles", "", "give it at least four");
    check_points();
    check_triangles();
    if (indices_good_ && !check_crowds()) return std::move(problems_);
    if (!indices_good_ || mesh_.triangles.empty()) return std::move(problems_);
    collect_edges();
    check_edges();
    check_fans();
    check_pieces();
    if (!shapes_good_) return std::move(problems_);
    if (closed_ && enclosed_volume(mesh_) <= 0)
      report("the mesh is inside out", "its enclosed volume is not positive", "turn every triangle around");
    check_touching();
    return std::move(problems_);
  }

 private:
  void report(const std::string& what, const std::string& which, std::string hint) {
    Problem problem;
    problem.message = which.empty() ? what : fmt::format("{}: {}", what, which);
    problem.hint = std::move(hint);
    problems_.push_back(std::move(problem));
  }

  /// At most eight of the offenders by name; a mesh from a file can have thousands.
  static std::string list(const std::vector<std::string>& names) {
    constexpr std::size_t most = 8;
    const std::size_t shown = std::min(names.size(), most);
    const std::string text =
        fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
    return names.size() == shown ? text : fmt::format("{} and {} more", text, names.size() - shown);
  }
  void report_if_any(const std::vector<std::string>& names, const std::string& what, std::string hint) {
    if (!names.empty()) report(what, list(names), std::move(hint));
  }

  std::string triangle(int t) const {
    const Triangle& c = mesh_.triangles[t];
    return fmt::format("triangle {} (points {} {} {})", counted(t), counted(c[0]), counted(c[1]),
                       counted(c[2]));
  }
  std::string point(std::size_t i) const { return fmt::format("point {}", counted(static_cast<int>(i))); }
  std::string edge(const Edge& e) const {
    return fmt::format("edge {}-{}", counted(e.first), counted(e.second));
  }
  /// An index as its author counts.
  int counted(int index) const { return index + requirements_.counted_from; }

  /// Before anything whose cost grows with the edges at a point.
  bool check_crowds() {
    std::vector<int> edges(mesh_.points.size(), 0);
    for (const Triangle& t : mesh_.triangles)
      for (int node : t) ++edges[node];
    const int most = requirements_.most_edges_at_a_point;
    std::vector<std::string> crowded;
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (edges[i] > most) crowded.push_back(fmt::format("{} with {} triangles", point(i), edges[i]));
    report_if_any(crowded, fmt::format("more than {} triangles at a point", most),
                  "mesh anew around it, with triangles of even size");
    return crowded.empty();
  }

  void check_points() {
    std::vector<std::string> wrong, unused;
    for (std::size_t i = 0; i < mesh_.points.size(); ++i)
      if (!mesh_.points[i].allFinite()) wrong.push_back(point(i));
    if (!requirements_.unused_points)
      for (int i : unused_points(mesh_)) unused.push_back(point(static_cast<std::size_t>(i)));
    shapes_good_ = wrong.empty();
    report_if_any(wrong, "coordinates are not finite", "every coordinate must be a number");
    report_if_any(unused, "no triangle uses", "remove the points or add the missing triangles");
  }

  void check_triangles() {
    std::vector<std::string> range, flat, twice;
    std::map<Triangle, int> seen;
    for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
      Triangle c = mesh_.triangles[t];
      std::sort(c.begin(), c.end());
      if (c[0] < 0 || c[2] >= static_cast<int>(mesh_.points.size())) {
        range.push_back(triangle(t));
      } else if (is_flat(c)) {
        flat.push_back(triangle(t));
      }
      const auto [first, is_new] = seen.emplace(c, t);
      if (!is_new) twice.push_back(fmt::format("{} repeats {}", triangle(t), counted(first->second)));
    }
    indices_good_ = range.empty();
    shapes_good_ = shapes_good_ && flat.empty();
    report_if_any(range, fmt::format("index out of range (there are {} points)", mesh_.points.size()),
                  fmt::format("indices start at {}", requirements_.counted_from));
    report_if_any(flat, "degenerate", "a triangle needs three corners that are not on one line");
    report_if_any(twice, "duplicate", "remove one of the two");
  }

  bool is_flat(const Triangle& c) const {
    if (c[0] == c[1] || c[1] == c[2]) return true;
    const Vec3 &a = mesh_.points[c[0]], &b = mesh_.points[c[1]], &d = mesh_.points[c[2]];
    if (!a.allFinite() || !b.allFinite() || !d.allFinite()) return false;  // reported with the points
    const double longest2 = std::max({(b - a).squaredNorm(), (d - b).squaredNorm(), (a - d).squaredNorm()});
    return (b - a).cross(d - a).norm() <= kFlat * longest2;
  }

  /// Triangles of each edge; those that run along it from its lower to its higher point count as forward.
  struct EdgeUse {
    std::vector<int> triangles;
    int forward = 0;
  };

  void collect_edges() {
    for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
      const Triangle& c = mesh_.triangles[t];
      for (int k = 0; k < 3; ++k) {
        const int a = c[k], b = c[(k + 1) % 3];
        if (a == b) continue;
        EdgeUse& use = edges_[undirected(a, b)];
        use.triangles.push_back(t);
        if (a < b) ++use.forward;
      }
    }
  }

  void check_edges() {
    std::vector<std::string> crowded, winding, open;
    for (const auto& [e, use] : edges_) {
      const auto& t = use.triangles;
      std::vector<int> named;
      for (int triangle : t) named.push_back(counted(triangle));
      if (t.size() > 2) crowded.push_back(fmt::format("{} in triangles {}", edge(e), fmt::join(named, " ")));
      if (t.size() == 2 && use.forward != 1)
        winding.push_back(fmt::format("triangles {} and {} at {}", named[0], named[1], edge(e)));
      if (t.size() == 1) open.push_back(fmt::format("{} of triangle {}", edge(e), named[0]));
    }
    closed_ = crowded.empty() && winding.empty() && open.empty();
    report_if_any(crowded, "non-manifold edge", "at most two triangles may meet at an edge");
    report_if_any(winding, "inconsistent winding", "order corners counter-clockwise seen from outside");
    if (requirements_.closed)
      report_if_any(open, "open boundary", "close the hole: every edge needs two triangles");
  }

  /// Triangles round a point that are joined by edges form one fan; two fans meet in the point alone.
  void check_fans() {
    std::vector<std::vector<int>> at(mesh_.points.size());
    for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
      for (int node : mesh_.triangles[t])
        if (at[node].empty() || at[node].back() != t) at[node].push_back(t);
    }
    std::vector<std::string> pinched;
    for (std::size_t node = 0; node < at.size(); ++node) {
      if (count_groups(at[node], static_cast<int>(node)) > 1) pinched.push_back(point(node));
    }
    report_if_any(pinched, "non-manifold point",
                  "separate surfaces that meet in one point need a point each");
  }

  void check_pieces() {
    std::vector<int> all(mesh_.triangles.size());
    for (std::size_t t = 0; t < all.size(); ++t) all[t] = static_cast<int>(t);
    const int pieces = count_groups(all, -1);
    if (pieces > 1) {
      report("the mesh is in several pieces", fmt::format("{} of them share no edge", pieces),
             "give each piece a mesh of its own");
    }
  }

  /// Groups of the triangles joined by edges (those at `node` only, unless it is negative).
  int count_groups(const std::vector<int>& triangles, int node) const {
    std::vector<int> open;
    std::map<int, bool> reached;
    for (int t : triangles) reached[t] = false;
    int groups = 0;
    for (int first : triangles) {
      if (reached[first]) continue;
      ++groups;
      open.assign(1, first);
      reached[first] = true;
      while (!open.empty()) {
        const Triangle& c = mesh_.triangles[open.back()];
        open.pop_back();
        for (int k = 0; k < 3; ++k) {
          const Edge e = undirected(c[k], c[(k + 1) % 3]);
          const auto use = edges_.find(e);
          if (use == edges_.end() || (node >= 0 && e.first != node && e.second != node)) continue;
          for (int t : use->second.triangles) {
            const auto neighbour = reached.find(t);
            if (neighbour == reached.end() || neighbour->second) continue;
            neighbour->second = true;
            open.push_back(t);
          }
        }
      }
    }
    return groups;
  }

  void check_touching() {
    Vec3 low = mesh_.points[0], high = low;
    for (const Vec3& p : mesh_.points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    std::vector<std::string> touching;
    for (const auto& [a, b] : touching_pairs(mesh_, kTouch * (high - low).norm()))
      touching.push_back(fmt::format("triangles {} and {}", counted(a), counted(b)));
    report_if_any(touching, "self-touching", "surfaces must stay apart except where triangles share an edge");
  }

  const TriMesh& mesh_;
  const MeshRequirements& requirements_;
  std::vector<Problem> problems_;
  std::map<Edge, EdgeUse> edges_;
  bool indices_good_ = true, shapes_good_ = true, closed_ = false;
};

}  // namespace

std::vector<Problem> check(const TriMesh& mesh, const MeshRequirements& requirements) {
  return Checker(mesh, requirements).run();
}

std::vector<int> unused_points(const TriMesh& mesh) {
  std::vector<bool> used(mesh.points.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (int node : t)
      if (node >= 0 && node < static_cast<int>(used.size())) used[node] = true;
  std::vector<int> out;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!used[i]) out.push_back(static_cast<int>(i));
  return out;
}

TriMesh without_unused_points(const TriMesh& mesh) {
  const std::vector<int> unused = unused_points(mesh);
  if (unused.empty()) return mesh;
  TriMesh out;
  std::vector<int> now(mesh.points.size(), -1);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    if (std::binary_search(unused.begin(), unused.end(), static_cast<int>(i))) continue;
    now[i] = static_cast<int>(out.points.size());
    out.points.push_back(mesh.points[i]);
  }
  for (const Triangle& t : mesh.triangles) out.triangles.push_back({now[t[0]], now[t[1]], now[t[2]]});
  return out;
}

double enclosed_volume(const TriMesh& mesh) {
  if (mesh.points.empty()) return 0;
  const Vec3& origin = mesh.points[0];  // near the mesh, so that a distant one loses no digits
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.points[t[0]] - origin, b = mesh.points[t[1]] - origin, c = mesh.points[t[2]] - origin;
    sum += a.dot(b.cross(c));
  }
  return sum / 6;
}

std::vector<double> areas_of(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<double> areas;
  for (const Triangle& t : triangles)
    areas.push_back(0.5 * (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm());
  return areas;
}

std::vector<double> shortest_edges(const TriMesh& mesh) {
  std::vector<double> shortest(mesh.points.size(), std::numeric_limits<double>::infinity());
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const double length = (mesh.points[a] - mesh.points[b]).norm();
      shortest[a] = std::min(shortest[a], length);
      shortest[b] = std::min(shortest[b], length);
    }
  }
  return shortest;
}

int nearest_of(const std::vector<Vec3>& points, const Vec3& place) {
  const auto nearer = [&](const Vec3& a, const Vec3& b) {
    return (a - place).squaredNorm() < (b - place).squaredNorm();
  };
  return static_cast<int>(std::min_element(points.begin(), points.end(), nearer) - points.begin());
}

TriMesh split_edges(const TriMesh& mesh) {
  TriMesh result{mesh.points, {}};
  std::map<Edge, int> middle;
  const auto midpoint = [&](int a, int b) {
    const auto [place, is_new] = middle.emplace(undirected(a, b), static_cast<int>(result.points.size()));
    if (is_new) result.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const int ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
    result.triangles.insert(result.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return result;
}

}  // namespace calot
