#include "numerics/line_search.h"

#include <gtest/gtest.h>

namespace calot {
namespace {

/// One node, energy a / 2 x^2 within a reach; its first two coordinates are kept at `target`.
class Hilltop : public ConstrainedEnergy {
 public:
  double a = -100;     ///< N/m; < 0: falls to all sides
  double reach = 1e9;  ///< m
  double terms = 0;    ///< J, that cancel in the energy
  VecX target = VecX::Zero(2);

  std::vector<Part> parts() const override { return {{{0, 1}, {}, 1}}; }
  int constraints() const override { return 2; }
  double value(const VecX& x) const override {
    return x.norm() < reach ? 0.5 * a * x.squaredNorm() : std::numeric_limits<double>::infinity();
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
  double cancelling() const override { return terms; }
  VecX constraint_scales() const override { return VecX::Constant(2, 1000); }
  double safe_share(const VecX&, const VecX&) const override { return 1; }

  /// Of the step from the top that Newton's method takes.
  double share() const {
    const VecX x = VecX::Zero(3), multipliers = a * target, constraints = -target;
    VecX step = VecX::Zero(3);
    step.head(2) = target;
    return line_search(*this, {x, step, multipliers, constraints, a * target.squaredNorm()}, 1);
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

TEST(LineSearch, AStepIsHalvedUntilItIsAdmissible) {
  Hilltop problem;
  problem.target = VecX{{1, 0}};
  problem.reach = 0.3;
  EXPECT_EQ(problem.share(), 0.25);
}

TEST(LineSearch, ARiseThatIsRoundingOfWhatCancelsIsNoRise) {
  Hilltop problem;
  problem.a = 1;
  const VecX x = VecX::Zero(3), none = VecX::Zero(2), step = 1e-9 * VecX::Unit(3, 0);  // 5e-19 J uphill
  EXPECT_EQ(line_search(problem, {x, step, none, none, 0}, 1), 0);
  problem.terms = 1e-3;
  EXPECT_EQ(line_search(problem, {x, step, none, none, 0}, 1), 1);
}

}  // namespace
}  // namespace calot
