#include "body/rigid_body.h"

#include <algorithm>
#include <cmath>
#include <set>

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
  body.choose_landmark_points();
  return body;
}

void RigidBody::choose_landmark_points() {
  landmark_points_["centre"] = 0;
  std::set<int> taken = {0};
  const std::vector<Vec3>& points = setup_.surface.points;
  for (const auto& landmark : setup_.landmarks) {
    const auto squared = [&](int point) { return (points[point] - landmark.second).squaredNorm(); };
    int nearest = -1;
    for (int point = 0; point < static_cast<int>(points.size()); ++point)
      if (!taken.contains(point) && (nearest < 0 || squared(point) < squared(nearest))) nearest = point;
    landmark_points_[landmark.first] = nearest;
    taken.insert(nearest);
  }
}

Vec3 RigidBody::landmark_place(int row, const VecX& x) const {
  for (const auto& [name, place] : setup_.landmarks) {
    if (landmark_points_.at(name) != row) continue;
    const std::array<double, AffineBody::nodes> weights = affine_->weights(place);
    Vec3 at = Vec3::Zero();
    for (int node = 0; node < AffineBody::nodes; ++node) at += weights[node] * x.segment<3>(3 * node);
    return at;
  }
  // Its nodes have its moments: their middle is its centre.
  return x.reshaped(3, 4).rowwise().mean();
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

}  // namespace calot
