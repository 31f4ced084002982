#include "view/surfaces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace calot {
namespace {

Vec3 area_normal(const std::vector<Vec3>& points, const Triangle& t) {
  return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
}

}  // namespace

std::vector<Vec3> mean_normals(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<Vec3> normals(points.size(), Vec3::Zero());
  for (const Triangle& t : triangles)
    for (const int corner : t) normals[corner] += area_normal(points, t);
  for (Vec3& n : normals) n.normalize();
  return normals;
}

SceneMesh sheet(Material material, int columns, int rows,
                const std::function<Vec3(double u, double v)>& place) {
  SceneMesh mesh;
  mesh.material = material;
  const int across = columns + 1;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.positions.push_back(place(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * across + i, b = a + 1, c = a + across, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  mesh.normals = mean_normals(mesh.positions, mesh.triangles);
  mesh.rest_positions = mesh.positions;
  return mesh;
}

void give_creased_normals(SceneMesh& mesh, double crease) {
  double volume = 0;  // about the first point, so that a nearly closed surface counts too
  for (const Triangle& t : mesh.triangles)
    volume += (mesh.positions[t[0]] - mesh.positions[0]).dot(area_normal(mesh.positions, t));
  if (volume < 0)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  std::vector<std::vector<int>> around(mesh.positions.size());
  const double cosine = std::cos(crease);
  std::vector<Vec3> face;
  std::vector<double> lengths;  // of these
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    face.push_back(area_normal(mesh.positions, mesh.triangles[t]));
    lengths.push_back(face.back().norm());
    for (const int corner : mesh.triangles[t]) around[corner].push_back(static_cast<int>(t));
  }
  std::vector<std::vector<int>> parts(mesh.positions.size());  // of the split mesh, by point
  SceneMesh split;
  split.material = mesh.material;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle corners{};
    for (int k = 0; k < 3; ++k) {
      const int point = mesh.triangles[t][k];
      Vec3 normal = Vec3::Zero();
      for (const int other : around[point])
        if (face[other].dot(face[t]) >= cosine * lengths[other] * lengths[t]) normal += face[other];
      normal.normalize();
      std::vector<int>& known = parts[point];
      const auto same =
          std::find_if(known.begin(), known.end(), [&](int part) { return split.normals[part] == normal; });
      corners[k] = same != known.end() ? *same : static_cast<int>(split.positions.size());
      if (same != known.end()) continue;
      known.push_back(corners[k]);
      split.positions.push_back(mesh.positions[point]);
      split.rest_positions.push_back(mesh.rest_positions[point]);
      split.normals.push_back(normal);
    }
    split.triangles.push_back(corners);
  }
  mesh = std::move(split);
}

void move(SceneMesh& mesh, const Pose& motion) {
  for (Vec3& p : mesh.positions) p = motion * p;
  for (Vec3& n : mesh.normals) n = motion.linear() * n;
}

void append(SceneMesh& mesh, const SceneMesh& more) {
  const int base = static_cast<int>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
  mesh.normals.insert(mesh.normals.end(), more.normals.begin(), more.normals.end());
  mesh.rest_positions.insert(mesh.rest_positions.end(), more.rest_positions.begin(),
                             more.rest_positions.end());
  for (const Triangle& t : more.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

}  // namespace calot
