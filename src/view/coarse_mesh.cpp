#include "view/coarse_mesh.h"

#include <meshoptimizer.h>

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

}  // namespace

CoarseMesh coarser(const SceneMesh& fine, double most_error, double least) {
  const std::vector<Vec3>& points = fine.positions.empty() ? fine.rest_positions : fine.positions;
  CoarseMesh out;
  out.mesh.material = fine.material;
  out.mesh.vessels = fine.vessels;
  if (points.empty()) return out;
  std::vector<int> place(points.size(), -1);  // of a fine point among the kept ones
  const std::vector<unsigned> corners = simplified(points, fine.triangles, most_error, least);
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
