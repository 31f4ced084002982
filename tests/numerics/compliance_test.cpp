// Constraints that give way, against the energy they stand for, assembled whole.

#include <gtest/gtest.h>

#include "numerics/tangent.h"
#include "spring_net.h"

namespace calot {
namespace {

using test::Net;

/// The tetrahedron's volume resists with 1 / (2 e) (volume - kept)^2, by its full matrix.
class Penalised : public Net {
 public:
  explicit Penalised(double e) : Net(true), e_(e) { volume *= 1.4; }
  bool constrained() const override { return false; }
  double value(const VecX& x) const override {
    return Net::value(x) + 0.5 / e_ * constraint_value(x) * constraint_value(x);
  }
  void gradient(const VecX& x, VecX& gradient, double& largest_internal) const override {
    Net::gradient(x, gradient, largest_internal);
    VecX g;
    const double c = constraint(x, g);
    gradient += c / e_ * g;
  }
  void hessian(const VecX& x, double, BlockMatrix& matrix) const override {
    VecX g;
    const double c = constraint(x, g);
    Net::hessian(x, -c / e_, matrix);
    for (int j = 0; j < nodes; ++j)
      for (int i = j; i < nodes; ++i)
        matrix.add(i, j, g.segment<3>(3 * i) * g.segment<3>(3 * j).transpose() / e_);
  }

 private:
  double e_;
};

/// The same by a constraint with a compliance; 0: kept.
struct Compliant : LoneBody {
  explicit Compliant(const Net& net, double e) : LoneBody(net, net.rest(), 0), e_(e) {}
  VecX compliances() const override { return VecX::Constant(1, e_); }

 private:
  double e_;
};

Net blown_up() {
  Net net(true);
  net.volume *= 1.4;
  return net;
}

NewtonSettings tight() {
  NewtonSettings out;
  out.tolerance = 1e-12;
  out.constraint_tolerance = 1e-13;
  return out;
}

struct Solved {
  NewtonResult result;
  VecX x, multipliers;
};

Solved solved(const ConstrainedEnergy& problem, const Net& net, const NewtonSettings& settings = tight()) {
  Solved out{{}, net.rest(), VecX::Zero(problem.constraints())};
  NewtonWorkspace work = net.workspace();
  out.result = solve_equilibrium(problem, settings, work, out.x, out.multipliers);
  return out;
}

TEST(Compliance, AConstraintThatGivesWayIsItsEnergyAssembledWhole) {
  const Net net = blown_up();
  for (double e : {1.0, 1e-2, 1e-4}) {
    const Penalised direct(e);
    VecX x = net.rest();
    double none = 0;
    NewtonWorkspace work = net.workspace();
    // Its forces are of the order of 1 / e and cancel: 1e-12 of what is left is below their rounding.
    NewtonSettings settings = tight();
    settings.tolerance = 1e-11;
    ASSERT_TRUE(solve_equilibrium(direct, settings, work, x, none).converged()) << e;
    const Solved out = solved(Compliant(net, e), net);
    ASSERT_TRUE(out.result.converged()) << to_text(out.result.status) << ' ' << e;
    EXPECT_LT((out.x - x).norm(), 1e-10) << e;
    EXPECT_GT((out.x - net.rest()).norm(), 1e-2);
    EXPECT_NEAR(out.multipliers[0], -net.constraint_value(out.x) / e, 1e-10) << e;
    EXPECT_GT(out.multipliers[0], 0.01) << "it pushes outward";
  }
}

TEST(Compliance, NewtonConvergesQuadratically) {
  const Net net = blown_up();
  for (double e : {1e-2, 1e-6}) {
    const Compliant problem(net, e);
    const Solved end = solved(problem, net);
    NewtonSettings one = tight();
    one.max_iterations = 1;
    VecX x = net.rest(), multipliers = VecX::Zero(1);
    std::vector<double> errors;
    for (int k = 0; k < 12; ++k) {
      NewtonWorkspace work = net.workspace();  // no factor to reuse
      solve_equilibrium(problem, one, work, x, multipliers);
      errors.push_back((x - end.x).norm());
    }
    int seen = 0;
    for (std::size_t k = 1; k < errors.size(); ++k)
      if (errors[k - 1] < 0.05 && errors[k] > 1e-12) {
        ++seen;
        // Springs of order 1 with third derivatives of order 10.
        EXPECT_LT(errors[k], 10 * errors[k - 1] * errors[k - 1]) << k;
      }
    EXPECT_GE(seen, 1) << e;
    EXPECT_LT(errors.back(), 1e-12);
  }
}

TEST(Compliance, TheSmallerItIsTheNearerTheConstraintIsToKept) {
  const Net net = blown_up();
  const Solved kept = solved(Compliant(net, 0), net);
  ASSERT_TRUE(kept.result.converged());
  double before = 0;
  for (double e : {1e-4, 1e-5, 1e-6}) {
    const Solved out = solved(Compliant(net, e), net);
    ASSERT_TRUE(out.result.converged()) << e;
    const double off = (out.x - kept.x).norm();
    EXPECT_GT(off, 0);
    if (before > 0) {
      EXPECT_NEAR(off / before, 0.1, 1e-3) << "to first order in e";
    }
    before = off;
  }
  // However stiff: where the energy's own matrix would have no figures left.
  const Solved stiff = solved(Compliant(net, 1e-18), net);
  ASSERT_TRUE(stiff.result.converged());
  EXPECT_LT((stiff.x - kept.x).norm(), 1e-12);
  EXPECT_LE(stiff.result.iterations, kept.result.iterations + 1);
}

/// A net that nothing holds but constraints with a compliance, each of a rigid motion's share of where it is.
class Tethered : public LoneBody {
 public:
  Tethered(const Net& net, int tethers, double e) : LoneBody(net, net.rest(), 0), e_(e), rest_(net.rest()) {
    gradients_ = Eigen::MatrixXd::Zero(rest_.size(), tethers);
    for (int k = 0; k < tethers; ++k)
      for (int i = 0; i < Net::nodes; ++i)
        gradients_.col(k).segment<3>(3 * i) =
            k < 3 ? Vec3(Vec3::Unit(k)) : Vec3(Vec3::Unit(k - 3).cross(Vec3(rest_.segment<3>(3 * i))));
  }
  int constraints() const override { return static_cast<int>(gradients_.cols()); }
  void hessian(const VecX& x, const VecX&, BlockMatrix& matrix) const override {
    LoneBody::hessian(x, VecX(), matrix);
  }
  void constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const override {
    values = constraint_values(x);
    gradients = gradients_;
  }
  VecX constraint_values(const VecX& x) const override { return gradients_.transpose() * (x - rest_); }
  void gradient_and_constraint(const VecX& x, VecX& of_energy, VecX& largest_internal, VecX& values,
                               Eigen::MatrixXd& of_constraints) const override {
    ConstrainedEnergy::gradient_and_constraint(x, of_energy, largest_internal, values, of_constraints);
  }
  VecX constraint_scales() const override { return VecX::Ones(constraints()); }
  VecX compliances() const override { return VecX::Constant(constraints(), e_); }
  const Eigen::MatrixXd& gradients() const { return gradients_; }

 private:
  double e_;
  VecX rest_;
  Eigen::MatrixXd gradients_;
};

Net loose() {
  Net net(false);
  net.ground = 0;
  return net;
}

TEST(Compliance, WhatHoldsABodyIsNoMechanism) {
  const Net net = loose();
  for (double e : {1.0, 1e-3, 1e-12}) {
    const Tethered held(net, 6, e);
    const Solved out = solved(held, net, {});
    ASSERT_TRUE(out.result.converged()) << to_text(out.result.status) << ' ' << e;
    VecX g, internal, values;
    held.gradient(out.x, g, internal);
    EXPECT_LT((g - held.gradients() * out.multipliers).norm(), 1e-5 * net.load.norm());
    EXPECT_LT((held.constraint_values(out.x) + e * out.multipliers).norm(), 1e-9);
    EXPECT_LT(out.result.iterations, 15) << e;
    EXPECT_EQ(solved(Tethered(net, 5, e), net, {}).result.status, NewtonStatus::mechanism) << e;
  }
  EXPECT_EQ(solved(Tethered(net, 0, 1), net, {}).result.status, NewtonStatus::mechanism);
}

TEST(Compliance, TheAnswerToALoadIsThatOfTheWholeMatrix) {
  Net unloaded = loose();  // under a load, turns that only the tethers hold may lack stiffness of their own
  unloaded.load.setZero();
  for (const Net& net : {blown_up(), unloaded}) {
    const double e = 0.05;
    const Tethered held(net, 6, e);
    const Solved at = solved(held, net, {});
    ASSERT_TRUE(at.result.converged());
    NewtonWorkspace work = net.workspace();
    Rng rng(4);
    const VecX load = test::random_coordinates(rng, 3 * Net::nodes, 1.0);
    ASSERT_TRUE(factorise_tangent(held, work, at.x, at.multipliers, true).converged());
    VecX dmultipliers;
    const VecX dx = linear_response(work, load, dmultipliers);
    BlockMatrix matrix = net.workspace().matrix;
    held.hessian(at.x, at.multipliers, matrix);
    const Eigen::MatrixXd& c = held.gradients();
    const Eigen::MatrixXd whole = test::dense(matrix) + c * c.transpose() / e;
    // The loose net's own matrix is factorised with a shift of 1e-7 of it, which costs as many figures.
    EXPECT_LT((whole * dx - load).norm(), 1e-5 * load.norm());
    EXPECT_LT((dmultipliers + c.transpose() * dx / e).norm(), 1e-5 * dmultipliers.norm());
    EXPECT_TRUE(serves(work, held)) << "a factor that later steps can use";
  }
}

}  // namespace
}  // namespace calot
