#include "numerics/border.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "random_matrices.h"

namespace calot {
namespace {

TEST(Border, ItsSolutionIsThatOfTheWholeSystem) {
  Rng rng(5);
  BlockMatrix matrix = test::random_positive(rng, 7);
  Cholesky factor(matrix);
  ASSERT_EQ(factor.factorise(matrix), FactorStatus::ok);
  const int n = matrix.size();
  for (int constraints : {0, 1, 3}) {
    Border border;
    border.gradients.resize(n, constraints);
    for (int k = 0; k < constraints; ++k) border.gradients.col(k) = test::random_coordinates(rng, n, 1.0);
    border.solve_with(factor);
    EXPECT_FALSE(border.dependent());
    const VecX load = test::random_coordinates(rng, n, 1.0),
               values = test::random_coordinates(rng, constraints, 1.0);
    VecX step = factor.solve(load);
    const VecX multipliers = border.keep(values, step);
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + constraints, n + constraints);
    whole.topLeftCorner(n, n) = test::dense(matrix);
    whole.topRightCorner(n, constraints) = -border.gradients;
    whole.bottomLeftCorner(constraints, n) = border.gradients.transpose();
    VecX right(n + constraints), found(n + constraints);
    right << load, -values;
    found << step, multipliers;
    const VecX expected = whole.fullPivLu().solve(right);
    EXPECT_LT((found - expected).norm(), 1e-13 * expected.norm()) << "rounding times a condition of 100";
  }
}

TEST(Border, WhatGivesWayIsSolvedWithItsCompliance) {
  Rng rng(8);
  BlockMatrix matrix = test::random_positive(rng, 7);
  Cholesky factor(matrix);
  ASSERT_EQ(factor.factorise(matrix), FactorStatus::ok);
  const int n = matrix.size();
  Border border;
  border.gradients.resize(n, 4);
  for (int k = 0; k < 4; ++k) border.gradients.col(k) = test::random_coordinates(rng, n, 1.0);
  border.gradients.col(2) = border.gradients.col(0);  // one of them gives way
  border.gradients.col(3).setZero();                  // as does this
  border.compliances = VecX{{0, 0, 0.3, 1e-20}};
  border.solve_with(factor);
  EXPECT_EQ(border.kept(), (std::vector<int>{0, 1}));
  EXPECT_FALSE(border.dependent());
  const VecX load = test::random_coordinates(rng, n, 1.0), left{{0.3, -0.2, 0.7, 1e-20}};
  VecX step = factor.solve(load);
  const VecX multipliers = border.keep(left, step);
  const Eigen::MatrixXd& c = border.gradients;
  const double rounding = 1e-13 * load.norm() * 100;  // times a condition of 100
  EXPECT_LT((test::dense(matrix) * step - c * multipliers - load).norm(), rounding);
  EXPECT_LT((c.transpose() * step + border.compliances.cwiseProduct(multipliers) + left).norm(), rounding);
  EXPECT_NEAR(multipliers[3], -1, 1e-13) << "what nothing moves still has its multiplier";
  border.compliances[2] = 1e-18;
  border.solve_with(factor);
  EXPECT_FALSE(border.dependent()) << "however little it gives way";
  border.compliances[2] = 0;
  border.solve_with(factor);
  EXPECT_TRUE(border.dependent());
}

TEST(Border, AConstraintThatIsTheOthersOrNoneIsFound) {
  Rng rng(6);
  BlockMatrix matrix = test::random_positive(rng, 7);
  Cholesky factor(matrix);
  ASSERT_EQ(factor.factorise(matrix), FactorStatus::ok);
  const auto dependent = [&](const Eigen::MatrixXd& gradients) {
    Border border;
    border.gradients = gradients;
    border.solve_with(factor);
    return border.dependent();
  };
  const int n = matrix.size();
  // Volumes in m^3 of bodies of very different sizes are no less independent.
  Eigen::MatrixXd gradients(n, 3);
  for (int k = 0; k < 3; ++k) gradients.col(k) = std::pow(1e-5, k) * test::random_coordinates(rng, n, 1.0);
  EXPECT_FALSE(dependent(gradients));
  Eigen::MatrixXd sum = gradients;
  sum.col(2) = 0.3 * gradients.col(0) - 1e3 * gradients.col(1);
  EXPECT_TRUE(dependent(sum));
  Eigen::MatrixXd none = gradients;
  none.col(1).setZero();
  EXPECT_EQ(dependent(none), 1);
  EXPECT_EQ(dependent(Eigen::MatrixXd::Zero(n, 1)), 0);
}

}  // namespace
}  // namespace calot
