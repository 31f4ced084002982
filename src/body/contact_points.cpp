#include "body/contact_points.h"

#include <algorithm>

#include "fem/links.h"

namespace calot {
namespace {

std::array<Vec3, contacts_each> middles_of_parts() {
  std::array<Vec3, contacts_each> out;
  std::size_t count = 0;
  const auto add = [&](double u, double v) {
    out[count++] = Vec3(contact_parts - u - v, u, v) / contact_parts;
  };
  for (int i = 0; i < contact_parts; ++i)
    for (int j = 0; i + j < contact_parts; ++j) {
      add(i + 1.0 / 3, j + 1.0 / 3);
      if (i + j + 1 < contact_parts) add(i + 2.0 / 3, j + 2.0 / 3);
    }
  return out;
}

}  // namespace

const std::array<Vec3, contacts_each> contact_rule = middles_of_parts();

const std::array<int, 4> broad_points = [] {
  std::array<int, 4> out{};
  const Vec3 middles[4] = {Vec3(4, 1, 1) / 6, Vec3(1, 4, 1) / 6, Vec3(1, 1, 4) / 6, Vec3::Constant(1.0 / 3)};
  for (std::size_t k = 0; k < 4; ++k)
    for (int point = 0; point < contacts_each; ++point)
      if ((contact_weights(point) - middles[k]).norm() < 1e-12) out[k] = point;
  std::sort(out.begin(), out.end());
  return out;
}();

const Vec3& ContactPlaces::corner(int row) {
  Corner& known = known_[static_cast<std::size_t>(row) % known_.size()];
  if (known.row != row) known = {row, blend(skin_.stencils, skin_.stencils.value, row, x_)};
  return known.at;
}

const Mat3& ContactPlaces::corners(int triangle) {
  if (triangle == triangle_) return corners_;
  triangle_ = triangle;
  for (int c = 0; c < 3; ++c) corners_.col(c) = corner(skin_.triangles[triangle][c]);
  return corners_;
}

Vec3 ContactPlaces::at(int point) { return corners(point / contacts_each) * contact_weights(point); }

Nearness ContactPlaces::nearness(int triangle, const Shape& shape) {
  const Vec3 middle = corners(triangle).rowwise().mean();
  const DistanceSlope d = distance_slope(shape, middle);
  Nearness near{d.distance, (corners_.colwise() - middle).transpose() * d.gradient};
  if (radii_ == nullptr) return near;
  const Vec3 radii = corner_radii(triangle);
  near.middle -= radii.mean();
  near.slopes -= radii - Vec3::Constant(radii.mean());
  return near;
}

void ContactLoad::add(int point, const Vec3& force) {
  if (point / contacts_each != triangle_) finish();
  triangle_ = point / contacts_each;
  sum_ += force * contact_weights(point).transpose();
}

void ContactLoad::finish() {
  if (triangle_ >= 0)
    for (int c = 0; c < 3; ++c) spread(skin_.stencils, skin_.triangles[triangle_][c], sum_.col(c), nodes_);
  triangle_ = -1;
  sum_.setZero();
}

void ContactStiffness::add(int point, const Mat3& hessian) {
  const int triangle = point / contacts_each;
  if (sums_.empty() || sums_.back().triangle != triangle) sums_.emplace_back().triangle = triangle;
  const Vec3& w = contact_weights(point);
  const Products products(w[0] * w[0], w[1] * w[0], w[2] * w[0], w[1] * w[1], w[2] * w[1], w[2] * w[2]);
  sums_.back().sum += hessian.reshaped() * products;
}

Eigen::Matrix<double, 12, 12> ContactStiffness::OfTriangle::by_corners() const {
  Eigen::Matrix<double, 12, 12> whole = Eigen::Matrix<double, 12, 12>::Zero();
  int pair = 0;
  for (int b = 0; b < 3; ++b)
    for (int a = b; a < 3; ++a) {
      const Mat3 block = sum.col(pair++).reshaped(3, 3);
      whole.block<3, 3>(3 * a, 3 * b) = block;
      whole.block<3, 3>(3 * b, 3 * a) = block.transpose();
    }
  return whole;
}

void ContactStiffness::finish() {
  // A triangle's nodes are coupled by its body.
  add_in_columns(workers_, sums_.size(), [&](std::size_t k, const ColumnShare& share) {
    const Triangle& t = skin_.triangles[sums_[k].triangle];
    return add_points_hessian(skin_.stencils, {t[0], t[1], t[2], -1}, sums_[k].by_corners(), matrix_, share);
  });
  sums_.clear();
}

}  // namespace calot
