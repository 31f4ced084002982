#pragma once
// Control meshes whose limit surface is a known shape, and rigid motions of their nodes.

#include <cstdlib>

#include "geometry/shapes.h"
#include "geometry/stencil.h"
#include "skin/subdivision.h"
#include "support/derivatives.h"
#include "support/random.h"

namespace calot::test {

/// Moves the control points so that the limit surface passes through where they were.
inline TriMesh fitted(TriMesh mesh) {
  const Result<LoopSurface> surface = LoopSurface::create(mesh);
  Result<std::vector<Vec3>> points = fit_to_limit(surface.value(), mesh.points);
  mesh.points = points.value();
  return mesh;
}

/// Control meshes of a sphere about the origin and of a standard pear (neck at the origin, along +z).
inline TriMesh sphere(int nodes, double radius = 20e-3) {
  return fitted(revolve(sphere_profile(radius), nodes).value());
}
inline TriMesh pear(int nodes, double length = 80e-3, double width = 35e-3) {
  const auto spacing = [length](const Vec3& p) { return pear_spacing(p, length); };
  return fitted(revolve(pear_profile(length, width), nodes, spacing).value());
}

inline std::vector<FacePoint> at_all_faces(int faces, const std::vector<Vec2>& places) {
  std::vector<FacePoint> points;
  for (int f = 0; f < faces; ++f)
    for (const Vec2& p : places) points.push_back({f, p.x(), p.y()});
  return points;
}

inline Pose random_motion(Rng& rng, double reach) {
  const Vec3 axis = random_vector(rng, 1.0).normalized(), shift = random_vector(rng, reach);
  return Eigen::Translation3d(shift) * Eigen::AngleAxisd(rng.uniform(-3.0, 3.0), axis);
}

/// Nodes moved as points; forces turned as vectors.
inline VecX moved(const Pose& motion, VecX x) {
  for (int i = 0; i < x.size(); i += 3) x.segment<3>(i) = (motion * Vec3(x.segment<3>(i))).eval();
  return x;
}
inline VecX turned(const Mat3& rotation, VecX f) {
  for (int i = 0; i < f.size(); i += 3) f.segment<3>(i) = (rotation * f.segment<3>(i)).eval();
  return f;
}

/// Sum of nodal forces, and of their moments about `centre`.
inline Vec3 net_force(const VecX& f) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < f.size(); i += 3) sum += f.segment<3>(i);
  return sum;
}
inline Vec3 net_torque(const VecX& x, const VecX& f, const Vec3& centre) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < f.size(); i += 3) sum += (x.segment<3>(i) - centre).cross(f.segment<3>(i));
  return sum;
}

/// Points of the skin of a sphere whose 14 nodes are shaken by up to 2 mm.
struct SkinOfSphere {
  StencilTable table;
  VecX x;

  explicit SkinOfSphere(Rng& rng) {
    const TriMesh mesh = sphere(14);
    const LoopSurface surface = LoopSurface::create(mesh).value();
    table = surface.tessellate(2).stencils;
    x = to_coordinates(mesh.points) + random_coordinates(rng, 3 * surface.nodes(), 2e-3);
  }
  Vec3 point(int row) const { return blend(table, table.value, row, x); }
  /// With room for what couples the nodes of each of these rows.
  BlockMatrix matrix(const std::vector<int>& rows) const {
    std::vector<std::vector<int>> cliques;
    for (int row : rows)
      cliques.emplace_back(table.node.begin() + table.begin[row], table.node.begin() + table.begin[row + 1]);
    return BlockMatrix(static_cast<int>(x.size() / 3), cliques);
  }
};

}  // namespace calot::test
