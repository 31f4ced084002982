#include "view/coarse_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <map>

namespace calot {
namespace {

std::vector<float> single_precision(const std::vector<Vec3>& points) {
  std::vector<float> out;
  out.reserve(3 * points.size());
  for (const Vec3& p : points)
    for (int c = 0; c < 3; ++c) out.push_back(static_cast<float>(p[c]));
  return out;
}

std::vector<unsigned> simplified(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                 double most_error, double least) {
  const std::vector<float> places = single_precision(points);
  std::vector<unsigned> corners;
  for (const Triangle& t : triangles)
    for (const int corner : t) corners.push_back(static_cast<unsigned>(corner));
  constexpr std::size_t stride = 3 * sizeof(float);
  // The library takes errors as shares of the surface's extent.
  const float extent = meshopt_simplifyScale(places.data(), points.size(), stride);
  const auto goal = 3 * static_cast<std::size_t>(least * static_cast<double>(triangles.size()));
  std::vector<unsigned> out(corners.size());
  out.resize(meshopt_simplify(out.data(), corners.data(), corners.size(), places.data(), points.size(),
                              stride, goal, static_cast<float>(most_error) / extent, 0, nullptr));
  return out;
}

/// Takes off what simplifying leaves of a spike: two triangles back to back. The point between them would have no normal.
void drop_flaps(std::vector<unsigned>& corners) {
  std::map<std::array<unsigned, 3>, std::size_t>
      first_of;  // by their corners in order: where the first one begins
  std::vector<char> dropped(corners.size() / 3, 0);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    std::array<unsigned, 3> sorted{corners[i], corners[i + 1], corners[i + 2]};
    std::sort(sorted.begin(), sorted.end());
    const auto [found, is_new] = first_of.try_emplace(sorted, i);
    if (!is_new) dropped[i / 3] = dropped[found->second / 3] = 1;
  }
  std::vector<unsigned> left;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (!dropped[i / 3]) left.push_back(corners[i]);
  corners = std::move(left);
}

}  // namespace

CoarseMesh coarser(const SceneMesh& fine, double most_error, double least) {
  const std::vector<Vec3>& points = fine.positions.empty() ? fine.rest_positions : fine.positions;
  CoarseMesh out;
  out.mesh.material = fine.material;
  out.mesh.vessels = fine.vessels;
  if (points.empty()) return out;
  std::vector<int> place(points.size(), -1);  // of a fine point among the kept ones
  std::vector<unsigned> corners = simplified(points, fine.triangles, most_error, least);
  drop_flaps(corners);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    Triangle& triangle = out.mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      int& corner = place[corners[i + k]];
      if (corner < 0) {
        corner = static_cast<int>(out.kept.size());
        out.kept.push_back(static_cast<int>(corners[i + k]));
      }
      triangle[k] = corner;
    }
  }
  if (!fine.positions.empty()) out.mesh.positions = entries(fine.positions, out.kept);
  if (!fine.normals.empty()) out.mesh.normals = entries(fine.normals, out.kept);
  if (!fine.burnt.empty()) out.mesh.burnt = entries(fine.burnt, out.kept);
  out.mesh.rest_positions = entries(fine.rest_positions, out.kept);
  return out;
}

}  // namespace calot
