#include "sim/virtual_structure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "skin/subdivision.h"

namespace calot {
namespace {

std::vector<FacePoint> quadrature_points(int faces, const std::vector<QuadraturePoint>& rule) {
  std::vector<FacePoint> points;
  for (int f = 0; f < faces; ++f)
    for (const QuadraturePoint& q : rule) points.push_back({f, q.u, q.v});
  return points;
}

std::vector<double> lumped_areas(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<double> areas(points.size(), 0.0);
  for (const Triangle& t : triangles) {
    const double area = 0.5 * (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm();
    for (int p : t) areas[p] += area / 3.0;
  }
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

double widest_gap(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  double widest = 0;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) widest = std::max(widest, (points[t[k]] - points[t[(k + 1) % 3]]).norm());
  return widest;
}

/// The coarsest tessellation whose points stand close enough, or the finest that is allowed.
Tessellation close_skin(const LoopSurface& surface, const VecX& rest) {
  constexpr int finest = 24;
  int parts = 4;
  while (true) {
    Tessellation skin = surface.tessellate(parts);
    const double gap = widest_gap(blend_all(skin.stencils, skin.stencils.value, rest), skin.triangles);
    if (parts == finest || gap <= skin_spacing) return skin;
    parts = std::clamp(static_cast<int>(std::ceil(parts * gap / skin_spacing)), parts + 1, finest);
  }
}

std::vector<VirtualStructure::SkinFace> faces_of(const Tessellation& skin, int faces) {
  std::vector<VirtualStructure::SkinFace> out(faces);
  for (int r = 0; r < skin.stencils.rows(); ++r) {
    VirtualStructure::SkinFace& face = out[skin.at[r].face];
    face.rows.push_back(r);
    face.nodes.insert(face.nodes.end(), skin.stencils.node.begin() + skin.stencils.begin[r],
                      skin.stencils.node.begin() + skin.stencils.begin[r + 1]);
  }
  for (VirtualStructure::SkinFace& face : out) {
    std::sort(face.nodes.begin(), face.nodes.end());
    face.nodes.erase(std::unique(face.nodes.begin(), face.nodes.end()), face.nodes.end());
  }
  return out;
}

}  // namespace

Result<VirtualStructure> VirtualStructure::create(const Setup& setup) {
  Result<LoopSurface> surface = LoopSurface::create(setup.control);
  if (!surface) return surface.failure();
  VirtualStructure body;
  body.name_ = setup.name;
  body.control_ = setup.control;
  body.rest_ = to_coordinates(setup.control.points);
  const int faces = surface->faces();
  body.quadrature_ = surface->evaluate(quadrature_points(faces, setup.rule), 2);
  Result<Shell> shell = Shell::create(body.quadrature_, setup.rule, body.rest_, setup.material);
  if (!shell) return shell.failure();
  body.shell_ = std::move(shell).value();

  body.skin_ = close_skin(surface.value(), body.rest_);
  body.skin_faces_ = faces_of(body.skin_, faces);
  body.skin_rest_ = body.skin_positions(body.rest_);
  body.skin_areas_ = lumped_areas(body.skin_rest_, body.skin_.triangles);
  body.edge_lengths_ = shortest_edges(setup.control);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : body.skin_rest_) box.extend(p);
  body.size_ = box.diagonal().norm();

  body.cliques_ = body.shell_.cliques();
  if (setup.bile) {
    const double weight = setup.bile->density * units::standard_gravity;
    Result<Bile> bile = Bile::create(surface->tessellate(2), faces, weight, setup.up, box.center());
    if (!bile) return bile.failure();
    body.bile_ = std::move(bile).value();
    for (std::vector<int>& clique : body.bile_->cliques()) body.cliques_.push_back(std::move(clique));
  }
  for (const SkinFace& face : body.skin_faces_) body.cliques_.push_back(face.nodes);
  if (setup.foundation) {
    const std::vector<double> areas = body.shell_.point_areas();
    for (int r = 0; r < body.quadrature_.rows(); ++r) {
      const Vec3 at = blend(body.quadrature_, body.quadrature_.value, r, body.rest_);
      const double stiffness = setup.foundation(at) * areas[r];
      if (stiffness <= 0) continue;
      body.foundation_.row.push_back(r);
      body.foundation_.target.push_back(at);
      body.foundation_.stiffness.push_back(stiffness);
    }
  }
  BlockMatrix constant = body.pattern();
  body.foundation_.add_hessian(body.quadrature_, constant);
  body.constant_hessian_ = constant.entries();
  return body;
}

BlockMatrix VirtualStructure::pattern() const { return BlockMatrix(nodes(), cliques_); }

double VirtualStructure::widest_skin_gap() const { return widest_gap(skin_rest_, skin_.triangles); }

std::vector<Vec3> VirtualStructure::skin_positions(const VecX& x) const {
  return blend_all(skin_.stencils, skin_.stencils.value, x);
}

std::vector<Vec3> VirtualStructure::skin_normals(const VecX& x) const {
  const std::vector<Vec3> u = blend_all(skin_.stencils, skin_.stencils.du, x);
  const std::vector<Vec3> v = blend_all(skin_.stencils, skin_.stencils.dv, x);
  std::vector<Vec3> normals(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) normals[i] = u[i].cross(v[i]).normalized();
  return normals;
}

}  // namespace calot
