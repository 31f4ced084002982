#include "group/vibration.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "base/rng.h"
#include "fem/potential_flow.h"
#include "numerics/dense_cholesky.h"
#include "numerics/modes.h"
#include "numerics/response.h"

namespace calot {

BodyMass::BodyMass(const ShellBody& body, const VecX& x, double wall_thickness, double bile_density)
    : body_(body), bile_density_(bile_density) {
  for (double area : body.shell().point_areas()) {
    row_mass_.push_back(area * wall_thickness * wall_density);
    wall_ += row_mass_.back();
  }
  const double half = 0.5 * body.size();
  PotentialFlow flow = PotentialFlow::inside(body.skin().stencils, body.skin().triangles, x, half);
  flow_ = std::move(flow.flow);
  kinetic_ = flow.energy();
  // An energy: on a skin too coarse to tell, none is found, and no frequency either.
  if (!cholesky_in_place(kinetic_)) kinetic_.setConstant(std::numeric_limits<double>::quiet_NaN());
}

VecX BodyMass::multiply(const VecX& motion) const {
  VecX out = VecX::Zero(motion.size());
  const StencilTable& table = body_.quadrature();
  for (int r = 0; r < table.rows(); ++r)
    spread(table, r, row_mass_[r] * blend(table, table.value, r, motion), out);
  out += bile_density_ * (flow_ * cholesky_solve(kinetic_, VecX(flow_.transpose() * motion)));
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
  constexpr int vectors = 6, max_rounds = 300;
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
    const std::optional<Modes> ritz =
        modes(0.5 * (stiffness + stiffness.transpose()), 0.5 * (inertia + inertia.transpose()));
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
