#include "body/loop_skin.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "body/body.h"

namespace calot {

std::vector<double> lumped(const std::vector<double>& areas, const std::vector<Triangle>& triangles,
                           std::size_t points) {
  std::vector<double> out(points, 0.0);
  for (std::size_t k = 0; k < triangles.size(); ++k)
    for (int p : triangles[k]) out[p] += areas[k] / 3.0;
  return out;
}

Tessellation close_skin(const LoopSurface& surface, const VecX& rest, double spacing) {
  constexpr int finest = 24;
  int parts = 4;
  while (true) {
    Tessellation skin = surface.tessellate(parts);
    const double gap = widest_gap(blend_all(skin.stencils, skin.stencils.value, rest), skin.triangles);
    if (parts == finest || gap <= spacing) return skin;
    const int wanted = static_cast<int>(std::ceil(parts * gap / spacing));
    parts = std::clamp(wanted + wanted % 2, parts + 2, finest);
  }
}

int parts_of(int triangles_each) { return static_cast<int>(std::lround(std::sqrt(triangles_each))); }

void add_nodes(const StencilTable& skin, const std::vector<int>& points, int first, std::vector<char>& seen,
               std::vector<int>& nodes) {
  const std::size_t known = nodes.size();
  for (int r : points) {
    // Nodes increase within a row: those looked for are its last.
    for (int e = skin.begin[r + 1] - 1; e >= skin.begin[r] && skin.node[e] >= first; --e)
      if (!std::exchange(seen[skin.node[e] - first], 1)) nodes.push_back(skin.node[e]);
  }
  for (std::size_t k = known; k < nodes.size(); ++k) seen[nodes[k] - first] = 0;
  std::sort(nodes.begin() + static_cast<std::ptrdiff_t>(known), nodes.end());
}

std::vector<std::vector<int>> points_of_faces(const Tessellation& skin, std::size_t faces) {
  const std::size_t each = skin.triangles.size() / faces;
  std::vector<std::vector<int>> out(faces);
  for (std::size_t k = 0; k < skin.triangles.size(); ++k)
    out[k / each].insert(out[k / each].end(), skin.triangles[k].begin(), skin.triangles[k].end());
  for (std::vector<int>& points : out) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
  }
  return out;
}

}  // namespace calot
