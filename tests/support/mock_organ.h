#pragma once
// A gallbladder-like mesh with a tented fold, in closed form: what pictures are tried on without a
// simulation.

#include <cmath>
#include <numbers>

#include "geometry/shapes.h"
#include "render/scene.h"

namespace calot::test {

/// A pear in its own frame (neck at the origin, fundus along +z), placed by `frame`. The skin near the rest
/// point `grasped` follows `pull` (m, pear frame), fading over `reach` (m): a tent.
inline SceneMesh mock_pear(const Pose& frame, const Vec3& grasped, const Vec3& pull, double reach = 9e-3,
                           double length = 80e-3, double width = 35e-3) {
  constexpr int rows = 60, columns = 72;
  const Profile profile = pear_profile(length, width);
  SceneMesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const Vec2 p = profile.point(static_cast<double>(j) / rows);
      const double a = 2 * std::numbers::pi * i / columns;
      mesh.rest_positions.emplace_back(p.x() * std::cos(a), p.x() * std::sin(a), p.y());
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int k = (i + 1) % columns;
      const int a = j * columns + i, b = j * columns + k, c = a + columns, d = b + columns;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  mesh.normals.assign(mesh.rest_positions.size(), Vec3::Zero());
  for (const Vec3& rest : mesh.rest_positions) {
    const double fade = 1 / (1 + (rest - grasped).squaredNorm() / (reach * reach));
    mesh.positions.push_back(frame * Vec3(rest + fade * std::sqrt(fade) * pull));
  }
  const auto& x = mesh.positions;
  for (const Triangle& t : mesh.triangles)
    for (const int corner : t) mesh.normals[corner] += (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
  for (int end : {0, rows})  // the poles' points coincide: one normal for all
    for (int i = 0; i < columns; ++i)
      mesh.normals[end * columns + i] = frame.linear().col(2) * (end ? 1 : -1);
  for (Vec3& n : mesh.normals) n.normalize();
  return mesh;
}

}  // namespace calot::test
