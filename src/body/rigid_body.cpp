#include "body/rigid_body.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/units.h"
#include "numerics/parts.h"

namespace calot {
Result<RigidBody> RigidBody::create(const Setup& setup) {
  RigidBody body;
  body.setup_ = setup;
  Result<AffineBody> affine =
      AffineBody::create(mesh_moments(setup.surface), setup.stiffness / AffineBody::young_over_kappa);
  if (!affine) return affine.failure();
  body.affine_ = std::move(affine).value();
  body.rest_ = body.affine_->placed();
  body.skin_.stencils = body.affine_->stencils(setup.surface.points);
  body.skin_.triangles = setup.surface.triangles;
  body.skin_.at.assign(setup.surface.points.size(), FacePoint{});
  Eigen::AlignedBox3d box;
  for (const Vec3& p : setup.surface.points) {
    box.extend(p);
    double sum = 0;
    for (double weight : body.affine_->weights(p)) sum += std::abs(weight);
    body.farthest_weights_ = std::max(body.farthest_weights_, sum);
  }
  body.size_ = box.diagonal().norm();
  body.edge_lengths_.assign(AffineBody::nodes, 0.5 * body.size_ / body.farthest_weights_);
  body.skin_areas_.assign(setup.surface.points.size(), 0.0);
  for (const Triangle& t : setup.surface.triangles) {
    const Vec3& a = setup.surface.points[t[0]];
    body.areas_.push_back(0.5 *
                          (setup.surface.points[t[1]] - a).cross(setup.surface.points[t[2]] - a).norm());
    for (int corner : t) body.skin_areas_[corner] += body.areas_.back() / 3;
  }
  body.weight_.resize(3 * AffineBody::nodes);
  // The nodes have the body's own moments: a quarter of its mass each.
  const double quarter = 0.25 * setup.density * body.affine_->volume();
  for (int node = 0; node < AffineBody::nodes; ++node) {
    body.weight_.segment<3>(3 * node) = -quarter * units::standard_gravity * setup.up;
    body.mass_.add_to_diagonal(node, quarter);
  }
  return body;
}

double RigidBody::value(const VecX& x) const { return affine_->value(x); }

void RigidBody::add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const {
  gradient += affine_->sample(x).gradient;
  largest_internal = std::max(largest_node(gradient), largest_node(weight_));
}

void RigidBody::add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* /*assembly*/) const {
  const AffineBody::Hessian h = affine_->sample(x).hessian;
  for (int j = 0; j < AffineBody::nodes; ++j)
    for (int i = j; i < AffineBody::nodes; ++i) matrix.add(i, j, h.block<3, 3>(3 * i, 3 * j));
}

double RigidBody::largest_motion(const VecX& dx) const { return farthest_weights_ * largest_node(dx); }

std::vector<Vec3> RigidBody::skin_normals(const VecX& x) const {
  const std::vector<Vec3> at = skin_positions(x);
  std::vector<Vec3> normals(at.size(), Vec3::Zero());
  for (const Triangle& t : skin_.triangles) {
    const Vec3 area = (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]);
    for (int corner : t) normals[corner] += area;
  }
  for (Vec3& normal : normals) normal.normalize();
  return normals;
}

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

}  // namespace calot
