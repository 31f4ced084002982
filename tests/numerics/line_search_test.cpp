#include "numerics/line_search.h"

#include <gtest/gtest.h>

namespace calot {
namespace {

/// One node, energy a / 2 x^2 within a reach; its first two coordinates are kept at `target`.
class Hilltop : public ConstrainedEnergy {
 public:
  double a = -100;     ///< N/m; < 0: falls to all sides
  double reach = 1e9;  ///< m
  double rise = 0;     ///< J, of the energy beyond half of `target`
  double terms = 0;    ///< J, that cancel in the energy
  double give = 0;     ///< the constraints' compliance, m/N
  VecX target = VecX::Zero(2);

  std::vector<Part> parts() const override { return {{{0, 1}, {}, 1}}; }
  int constraints() const override { return 2; }
  double value(const VecX& x) const override {
    const double beyond = x.norm() > 0.5 * target.norm() ? rise : 0;
    return x.norm() < reach ? 0.5 * a * x.squaredNorm() + beyond : std::numeric_limits<double>::infinity();
  }
  void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const override {
    gradient = a * x;
    largest_internal = VecX::Ones(1);
  }
  void hessian(const VecX&, const VecX&, BlockMatrix& matrix) const override {
    matrix.set_zero();
    matrix.add(0, 0, a * Mat3::Identity());
  }
  void constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const override {
    values = constraint_values(x);
    gradients = Eigen::MatrixXd::Identity(3, 2);
  }
  VecX constraint_values(const VecX& x) const override { return x.head(2) - target; }
  VecX compliances() const override { return VecX::Constant(2, give); }
  double cancelling() const override { return terms; }
  VecX constraint_scales() const override { return VecX::Constant(2, 1000); }
  double safe_share(const VecX&, const VecX&) const override { return 1; }

  /// Of the step from the top that Newton's method takes.
  double share() const {
    // a x = m and x - target + give m = 0.
    const VecX end = target / (1 + give * a), x = VecX::Zero(3), multipliers = a * end, left = -target;
    VecX step = VecX::Zero(3);
    step.head(2) = end;
    return line_search(*this, {x, step, multipliers, multipliers, left, a * end.squaredNorm()}, 1);
  }
};

TEST(LineSearch, WhicheverConstraintIsOffAStepThatMeetsItIsTakenWhole) {
  for (const VecX& target : {VecX{{1, 0}}, VecX{{0, 1}}, VecX{{0.3, -2}}})
    for (double a : {-100.0, 100.0}) {
      Hilltop problem;
      problem.a = a;
      problem.target = target;
      EXPECT_EQ(problem.share(), 1) << a << ", " << target.transpose();
    }
}

TEST(LineSearch, AStepToWhereTheConstraintsGiveWayIsTakenWhole) {
  for (double a : {-100.0, 100.0})
    for (double give : {5e-3, 1e-9, 9e-3}) {
      Hilltop problem;
      problem.a = a;
      problem.give = give;
      problem.target = VecX{{0.3, -2}};
      EXPECT_EQ(problem.share(), 1) << a << ", " << give;
    }
}

TEST(LineSearch, WhatAStepGainsIsTheEnergyWithThatOfWhatGaveWay) {
  for (double a : {-100.0, 100.0}) {
    Hilltop problem;
    problem.a = a;
    problem.give = 9e-3;
    problem.target = VecX{{0.3, 0}};
    const double end = 0.3 / (1 + problem.give * a), m = a * end, bent = a * end * end + problem.give * m * m;
    // Both penalties are the same where the curvature asks for them; else by the multiplier, and the second has none.
    const double penalty = std::max((std::abs(m) + 1) / 1000, 2 * std::max(0.0, -bent) / 0.09);
    const double left = m * 0.3 + 0.5 * penalty * 0.09;
    const double gained = left - 0.5 * a * end * end - 0.5 * problem.give * m * m;
    ASSERT_GT(gained, 0);
    for (double share : {0.999, 1.001}) {
      problem.rise = share * (gained - 1e-4 * (bent + penalty * 0.09));
      EXPECT_EQ(problem.share() == 1, share < 1) << a << ' ' << share;
    }
  }
}

TEST(LineSearch, AStepIsHalvedUntilItIsAdmissible) {
  Hilltop problem;
  problem.target = VecX{{1, 0}};
  problem.reach = 0.3;
  EXPECT_EQ(problem.share(), 0.25);
}

/// One node in a well with two bottoms, at x = -1 and 1; a wall that no step may pass.
class TwoBottoms : public Hilltop {
 public:
  double wall = 1e9;  ///< m

  int constraints() const override { return 0; }
  double value(const VecX& x) const override {
    return 0.25 * std::pow(x.squaredNorm(), 2) - 0.5 * x.squaredNorm();
  }
  double safe_share(const VecX& x, const VecX& step) const override {
    return step[0] > 0 ? std::min(1.0, (wall - x[0]) / step[0]) : 1;
  }
  /// Of a step along the first coordinate.
  double lengthened(double from, double by) const {
    const VecX x = from * VecX::Unit(3, 0), step = by * VecX::Unit(3, 0), none;
    const double curvature = -(std::pow(from, 3) - from) * by;  // of the matrix that took it there
    return line_search(*this, {x, step, none, none, none, curvature}, 1, true);
  }
};

TEST(LineSearch, AStepOutOfASaddleIsDoubledAsLongAsTheEnergyFalls) {
  TwoBottoms problem;
  EXPECT_EQ(problem.lengthened(0.01, 0.01), 64) << "to 0.65: twice as far is beyond the bottom and higher";
  EXPECT_EQ(problem.lengthened(1.3, -0.3), 1) << "to the bottom: twice as far is higher";
  EXPECT_EQ(problem.lengthened(1.3, -0.2), 2) << "to 1.1: twice as far is a little lower still";
  EXPECT_LT(problem.lengthened(1, 1e-3), 1) << "uphill";
}

TEST(LineSearch, ALengthenedStepEndsAtWhatItMayNotPass) {
  TwoBottoms problem;
  problem.wall = 0.21;
  EXPECT_DOUBLE_EQ(problem.lengthened(0.01, 0.01), 20);
}

TEST(LineSearch, ARiseThatIsRoundingOfWhatCancelsIsNoRise) {
  Hilltop problem;
  problem.a = 1;
  const VecX x = VecX::Zero(3), none = VecX::Zero(2), step = 1e-9 * VecX::Unit(3, 0);  // 5e-19 J uphill
  EXPECT_EQ(line_search(problem, {x, step, none, none, none, 0}, 1), 0);
  problem.terms = 1e-3;
  EXPECT_EQ(line_search(problem, {x, step, none, none, none, 0}, 1), 1);
}

}  // namespace
}  // namespace calot
