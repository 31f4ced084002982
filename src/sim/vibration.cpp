#include "sim/vibration.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "base/rng.h"
#include "numerics/dense_cholesky.h"
#include "numerics/modes.h"
#include "numerics/response.h"

namespace calot {
namespace {

constexpr int harmonics = 15;  // of degree 1 (3), 2 (5) and 3 (7)

/// Values and gradients of the solid harmonics at p.
void sample_harmonics(const Vec3& p, std::array<double, harmonics>& h, std::array<Vec3, harmonics>& g) {
  const double x = p.x(), y = p.y(), z = p.z();
  h = {x,
       y,
       z,
       x * y,
       y * z,
       z * x,
       x * x - y * y,
       2 * z * z - x * x - y * y,
       z * (2 * z * z - 3 * x * x - 3 * y * y),
       x * (4 * z * z - x * x - y * y),
       y * (4 * z * z - x * x - y * y),
       z * (x * x - y * y),
       x * y * z,
       x * (x * x - 3 * y * y),
       y * (3 * x * x - y * y)};
  g = {Vec3(1, 0, 0),
       Vec3(0, 1, 0),
       Vec3(0, 0, 1),
       Vec3(y, x, 0),
       Vec3(0, z, y),
       Vec3(z, 0, x),
       Vec3(2 * x, -2 * y, 0),
       Vec3(-2 * x, -2 * y, 4 * z),
       Vec3(-6 * x * z, -6 * y * z, 6 * z * z - 3 * x * x - 3 * y * y),
       Vec3(4 * z * z - 3 * x * x - y * y, -2 * x * y, 8 * x * z),
       Vec3(-2 * x * y, 4 * z * z - x * x - 3 * y * y, 8 * y * z),
       Vec3(2 * x * z, -2 * y * z, x * x - y * y),
       Vec3(y * z, z * x, x * y),
       Vec3(3 * x * x - 3 * y * y, -6 * x * y, 0),
       Vec3(6 * x * y, 3 * x * x - 3 * y * y, 0)};
}

/// Third of the area vectors of the triangles around each point: they sum to zero on a closed surface.
std::vector<Vec3> area_vectors(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<Vec3> out(points.size(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 area = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]) / 6.0;
    for (int p : t) out[p] += area;
  }
  return out;
}

}  // namespace

BodyMass::BodyMass(const ShellBody& body, const VecX& x, double wall_thickness, double bile_density)
    : body_(body), bile_density_(bile_density) {
  for (double area : body.shell().point_areas()) {
    row_mass_.push_back(area * wall_thickness * wall_density);
    wall_ += row_mass_.back();
  }
  const std::vector<Vec3> skin = body.skin_positions(x);
  const std::vector<Vec3> areas = area_vectors(skin, body.skin().triangles);
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : skin) centre += p / static_cast<double>(skin.size());
  const double scale = 2.0 / body.size();  // keeps the degrees comparable
  flow_ = Eigen::MatrixXd::Zero(x.size(), harmonics);
  Eigen::MatrixXd kinetic = Eigen::MatrixXd::Zero(harmonics, harmonics);
  std::array<double, harmonics> h;
  std::array<Vec3, harmonics> g;
  const StencilTable& table = body.skin().stencils;
  for (int p = 0; p < table.rows(); ++p) {
    sample_harmonics(scale * (skin[p] - centre), h, g);
    for (int k = 0; k < harmonics; ++k) {
      for (int e = table.begin[p]; e < table.begin[p + 1]; ++e)
        flow_.col(k).segment<3>(Eigen::Index{3} * table.node[e]) += table.value[e] * h[k] * areas[p];
      for (int l = 0; l < harmonics; ++l) kinetic(k, l) += h[k] * scale * g[l].dot(areas[p]);
    }
  }
  kinetic_ = 0.5 * (kinetic + kinetic.transpose());
  // An energy: on a skin too coarse to tell, none is found, and no frequency either.
  if (!cholesky_in_place(kinetic_)) kinetic_.setConstant(std::numeric_limits<double>::quiet_NaN());
}

VecX BodyMass::multiply(const VecX& motion) const {
  VecX out = VecX::Zero(motion.size());
  const StencilTable& table = body_.quadrature();
  for (int r = 0; r < table.rows(); ++r)
    spread(table, r, row_mass_[r] * blend(table, table.value, r, motion), out);
  out += bile_density_ * (flow_ * cholesky_solve(kinetic_, flow_.transpose() * motion));
  return out;
}

namespace {

/// K^-1 on the motions that keep the volume to first order, where K itself need not be positive definite: a balloon
/// blown up beyond its greatest pressure would burst or shrink if its filling could come and go. So changes of volume
/// are made stiff (K + s g g', g the volume's gradient), which those motions do not feel.
class KeptVolumeFactor {
 public:
  KeptVolumeFactor(const BlockMatrix& matrix, VecX gradient) : gradient_(std::move(gradient)) {
    // Far above what a wall takes off its filling's stiffness, and three figures of the sixteen.
    constexpr double stiffer = 1e3;
    factor_ =
        (stiffer * matrix.diagonal_mean() / gradient_.squaredNorm() * gradient_) * gradient_.transpose();
    for (int column = 0; column < matrix.size(); ++column)
      for (int e = matrix.column_starts()[column]; e < matrix.column_starts()[column + 1]; ++e)
        factor_(matrix.rows()[e], column) += matrix.entries()[e];
    stable_ = cholesky_in_place(factor_);
    if (!stable_) return;
    bordered_ = cholesky_solve(factor_, gradient_);
    complement_ = gradient_.dot(bordered_);
  }

  /// K is positive definite on these motions.
  bool stable() const { return stable_; }

  VecX response(const VecX& load) const {
    const VecX dx = cholesky_solve(factor_, load);
    return dx - gradient_.dot(dx) / complement_ * bordered_;
  }

 private:
  Eigen::MatrixXd factor_;
  VecX gradient_, bordered_;
  double complement_ = 0;
  bool stable_ = false;
};

using Response = std::function<VecX(const VecX&)>;

/// The smallest w^2 of K v = w^2 M v, in 1/s^2, by inverse iteration on a few vectors; `response` is K^-1 on the
/// motions that keep the volume.
Result<double> smallest_eigenvalue(const Response& response, const BodyMass& mass, Eigen::Index size) {
  constexpr int vectors = Mat6::RowsAtCompileTime, max_rounds = 300;
  constexpr double tolerance = 1e-8;
  Rng rng(1);
  Eigen::MatrixXd shapes(size, vectors);
  for (Eigen::Index i = 0; i < shapes.size(); ++i) shapes.data()[i] = rng.uniform(-1, 1);
  double lowest = 0;
  for (int round = 0; round < max_rounds; ++round) {
    // One step of K^-1 M on the whole space, then the best combinations in it (Rayleigh and Ritz).
    Eigen::MatrixXd loads(size, vectors), next(size, vectors), masses(size, vectors);
    for (int k = 0; k < vectors; ++k) {
      loads.col(k) = mass.multiply(shapes.col(k));
      next.col(k) = response(loads.col(k));
    }
    for (int k = 0; k < vectors; ++k) masses.col(k) = mass.multiply(next.col(k));
    // With K next = loads + a pressure that does no work on motions that keep the volume.
    const Eigen::MatrixXd stiffness = next.transpose() * loads, inertia = next.transpose() * masses;
    const std::optional<Modes6> ritz =
        modes(Mat6(0.5 * (stiffness + stiffness.transpose())), Mat6(0.5 * (inertia + inertia.transpose())));
    if (!ritz || !(ritz->values[0] > 0)) break;
    shapes = next * ritz->vectors;
    const double before = std::exchange(lowest, ritz->values[0]);
    if (std::abs(lowest - before) <= tolerance * lowest) return lowest;
  }
  return fail(FailureKind::simulation, "the organ's lowest natural frequency was not found",
              "give the organ more nodes");
}

}  // namespace

Result<double> lowest_frequency(const ShellBody& body, const ContactLoads& loads, const BodyState& state,
                                const BodyMass& mass) {
  NewtonWorkspace work(body.pattern());
  ContactSearch search;
  const BodyProblem problem(body, loads, search, state);
  const NewtonResult factored = factorise_tangent(problem, work, state.x, problem.multipliers(), true);
  if (!factored.converged())
    return fail(FailureKind::simulation, "the organ has no natural frequency: " + to_text(factored.status),
                "hold the organ, or give it fewer nodes");
  Response response = [&](const VecX& load) {
    VecX ignored;
    return linear_response(work, load, ignored);
  };
  std::optional<KeptVolumeFactor> kept;
  if (work.shifted) {
    problem.hessian(state.x, problem.multipliers(), work.matrix);
    if (problem.constraints() > 0) kept.emplace(work.matrix, work.border.gradients.col(0));
    if (!kept || !kept->stable())
      return fail(FailureKind::simulation,
                  "the organ has no natural frequency: its equilibrium is not stable",
                  "hold the organ, or fill it less");
    response = [&](const VecX& load) { return kept->response(load); };
  }
  const Result<double> squared = smallest_eigenvalue(response, mass, state.x.size());
  if (!squared) return squared.failure();
  return std::sqrt(squared.value()) / (2 * std::numbers::pi);
}

}  // namespace calot
