#include "geometry/solid_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace calot {

TriMesh rounded_box(const Vec3& size, double rounding, const Vec3& centre, double spacing) {
  const double longest = size.maxCoeff() + 2 * rounding;
  const int parts = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 4, 24);
  TriMesh mesh;
  std::map<std::array<int, 3>, int> known;  // points of the cube's grid, which faces share
  const auto point = [&](const std::array<int, 3>& grid) {
    const auto [found, fresh] = known.try_emplace(grid, static_cast<int>(mesh.points.size()));
    if (fresh) {
      Vec3 on_cube, even;
      for (int c = 0; c < 3; ++c) {
        on_cube[c] = 2.0 * grid[c] / parts - 1;
        even[c] = std::tan(0.25 * M_PI * on_cube[c]);  // the ball's triangles are then nearly alike
      }
      mesh.points.push_back(centre + 0.5 * size.cwiseProduct(on_cube) + rounding * even.normalized());
    }
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int end : {0, parts})
      for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> grid{};
            grid[axis] = end, grid[(axis + 1) % 3] = u, grid[(axis + 2) % 3] = v;
            return point(grid);
          };
          const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
          if (end > 0) {
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
          } else {
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({a, d, c});
          }
        }
  return mesh;
}

TriMesh ring_surface(double radius, double rod, double spacing) {
  const auto count = [&](double way, int least) {
    return std::max(least, static_cast<int>(std::ceil(way / spacing)));
  };
  const int around = count(2 * M_PI * (radius + rod), 12), across = count(2 * M_PI * rod, 6);
  TriMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * M_PI * i / around, b = 2 * M_PI * j / across;
      const double out = radius - rod * std::cos(b);
      mesh.points.emplace_back(out * std::cos(a), out * std::sin(a), rod * std::sin(b));
    }
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const int next = (i + 1) % around * across, up = (j + 1) % across;
      const int a = i * across + j, b = next + j, c = next + up, d = i * across + up;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

namespace {

/// Points in the middle of edges, by the edge's points, the lower one first.
using MiddlePoints = std::map<std::pair<int, int>, int>;

MiddlePoints cut_long_edges(TriMesh& mesh, double longest) {
  MiddlePoints middles;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const auto edge = std::minmax(t[k], t[(k + 1) % 3]);
      const Vec3 a = mesh.points[edge.first], b = mesh.points[edge.second];
      if ((b - a).norm() <= longest || middles.contains(edge)) continue;
      middles[edge] = static_cast<int>(mesh.points.size());
      mesh.points.push_back(0.5 * (a + b));
    }
  return middles;
}

/// A triangle's parts, by which of its edges have a point in the middle.
void add_parts(const TriMesh& mesh, Triangle t, const MiddlePoints& middles, std::vector<Triangle>& out) {
  const auto middle = [&](int k) {
    const auto found = middles.find(std::minmax(t[k], t[(k + 1) % 3]));
    return found == middles.end() ? -1 : found->second;
  };
  const int cut = (middle(0) >= 0) + (middle(1) >= 0) + (middle(2) >= 0);
  if (cut == 0) return out.push_back(t);
  // Turned until the first edge is cut, and with two of them the third is the one that is not.
  while (middle(0) < 0 || (cut == 2 && middle(2) >= 0)) std::rotate(t.begin(), t.begin() + 1, t.end());
  const int ab = middle(0), bc = middle(1), ca = middle(2);
  if (cut == 1) {
    out.push_back({t[0], ab, t[2]});
    out.push_back({ab, t[1], t[2]});
    return;
  }
  out.push_back({ab, t[1], bc});
  if (cut == 3) {
    out.push_back({t[0], ab, ca});
    out.push_back({bc, t[2], ca});
    out.push_back({ab, bc, ca});
    return;
  }
  // What is left has four corners: it is cut along the shorter way across.
  const auto way = [&](int a, int b) { return (mesh.points[a] - mesh.points[b]).squaredNorm(); };
  const bool from_first = way(t[0], bc) <= way(ab, t[2]);
  out.push_back({t[0], ab, from_first ? bc : t[2]});
  out.push_back(from_first ? Triangle{t[0], bc, t[2]} : Triangle{ab, bc, t[2]});
}

}  // namespace

TriMesh with_short_edges(TriMesh mesh, double longest, std::size_t most_triangles) {
  while (mesh.triangles.size() <= most_triangles) {
    const MiddlePoints middles = cut_long_edges(mesh, longest);
    if (middles.empty()) break;
    std::vector<Triangle> parts;
    for (const Triangle& t : mesh.triangles) add_parts(mesh, t, middles, parts);
    mesh.triangles = std::move(parts);
  }
  return mesh;
}

}  // namespace calot
