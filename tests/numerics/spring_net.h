#pragma once
// A body for tests of Newton's method: few nodes, nonlinear, with a volume that can be kept.

#include "numerics/newton.h"
#include "numerics/response.h"
#include "support/derivatives.h"

namespace calot::test {

/// A net of stiffening springs, some to the ground, under a dead load; optionally the enclosed volume of a
/// tetrahedron of its first four nodes is kept.
class Net : public BodyEnergy {
 public:
  explicit Net(bool keeps_volume) : keeps_volume_(keeps_volume) {
    Rng rng(1);
    rest_ = random_coordinates(rng, 3 * nodes, 0.5);
    rest_.segment<12>(0) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    load = 0.05 * random_coordinates(rng, 3 * nodes, 1.0);
    for (int i = 0; i < nodes; ++i)
      for (int j = i + 1; j < nodes; ++j) springs_.push_back({i, j});
    volume = volume_of(rest_);
  }

  static constexpr int nodes = 6;
  VecX load;
  double ground = 1.0;  ///< N/m, of every node to its rest place
  double poison = 0.0;  ///< added to gradients
  double volume = 0;

  const VecX& rest() const { return rest_; }
  NewtonWorkspace workspace() const {
    std::vector<int> all(nodes);
    for (int i = 0; i < nodes; ++i) all[i] = i;
    return NewtonWorkspace(BlockMatrix(nodes, std::vector<std::vector<int>>{all}));
  }

  bool constrained() const override { return keeps_volume_; }
  double value(const VecX& x) const override {
    double sum = 0.5 * ground * (x - rest_).squaredNorm() - load.dot(x);
    for (const auto& [i, j] : springs_) {
      const double e = extension(x, i, j);
      sum += 0.5 * e * e + 0.25 * e * e * e * e;
    }
    return sum;
  }
  void gradient(const VecX& x, VecX& gradient, double& largest_internal) const override {
    gradient = ground * (x - rest_) - load;
    for (const auto& [i, j] : springs_) {
      const double e = extension(x, i, j);
      const Vec3 pull = (e + e * e * e) * 2 * (x.segment<3>(3 * i) - x.segment<3>(3 * j));
      gradient.segment<3>(3 * i) += pull;
      gradient.segment<3>(3 * j) -= pull;
    }
    gradient[0] += poison;
    largest_internal = load.lpNorm<Eigen::Infinity>();
  }
  void hessian(const VecX& x, double multiplier, BlockMatrix& matrix) const override {
    matrix.set_zero();
    for (int i = 0; i < nodes; ++i) matrix.add(i, i, ground * Mat3::Identity());
    for (const auto& [i, j] : springs_) {
      const double e = extension(x, i, j);
      const Vec3 d = 2 * (x.segment<3>(3 * i) - x.segment<3>(3 * j));
      const Mat3 h = (1 + 3 * e * e) * d * d.transpose() + 2 * (e + e * e * e) * Mat3::Identity();
      matrix.add(i, i, h);
      matrix.add(j, j, h);
      matrix.add(j, i, -h);
    }
    if (!keeps_volume_) return;
    // Minus multiplier times the volume's Hessian, itself by differences: exact, the volume being cubic.
    const Eigen::MatrixXd second =
        difference_hessian([&](const VecX& y) { return volume_gradient(y); }, x, 0.1);
    for (int j = 0; j < 4; ++j)
      for (int i = j; i < 4; ++i) matrix.add(i, j, -multiplier * second.block<3, 3>(3 * i, 3 * j));
  }
  double constraint(const VecX& x, VecX& gradient) const override {
    gradient = volume_gradient(x);
    return constraint_value(x);
  }
  double constraint_value(const VecX& x) const override { return volume_of(x) - volume; }
  double constraint_scale() const override { return volume_of(rest_); }
  double length_scale() const override { return 1.0; }
  double safe_share(const VecX&, const VecX&) const override { return 1.0; }

 private:
  /// Half the growth of the squared length.
  double extension(const VecX& x, int i, int j) const {
    return (x.segment<3>(3 * i) - x.segment<3>(3 * j)).squaredNorm() -
           (rest_.segment<3>(3 * i) - rest_.segment<3>(3 * j)).squaredNorm();
  }
  static double volume_of(const VecX& x) {
    const Vec3 a = x.segment<3>(0);
    return (x.segment<3>(3) - a).dot((x.segment<3>(6) - a).cross(x.segment<3>(9) - a)) / 6;
  }
  static VecX volume_gradient(const VecX& x) {
    const Vec3 a = x.segment<3>(0);
    const Vec3 b = x.segment<3>(3) - a, c = x.segment<3>(6) - a, d = x.segment<3>(9) - a;
    VecX g = VecX::Zero(x.size());
    g.segment<3>(3) = c.cross(d) / 6;
    g.segment<3>(6) = d.cross(b) / 6;
    g.segment<3>(9) = b.cross(c) / 6;
    g.segment<3>(0) = -(g.segment<3>(3) + g.segment<3>(6) + g.segment<3>(9));
    return g;
  }

  bool keeps_volume_;
  VecX rest_;
  std::vector<std::pair<int, int>> springs_;
};

/// Residual of stationarity of the Lagrangian.
inline VecX residual(const Net& net, const VecX& x, double multiplier) {
  VecX g, c;
  double scale = 0;
  net.gradient(x, g, scale);
  if (!net.constrained()) return g;
  net.constraint(x, c);
  return g - multiplier * c;
}

}  // namespace calot::test
