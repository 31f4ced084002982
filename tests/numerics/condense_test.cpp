#include "numerics/condense.h"

#include <gtest/gtest.h>

#include "numerics/dense_cholesky.h"
#include "random_matrices.h"

namespace calot {
namespace {

TEST(Condensation, SolvesTheWholeSystem) {
  Rng rng(1);
  for (int kept : {1, 13, 29}) {
    const BlockMatrix matrix = test::random_positive(rng, 30);
    Cholesky whole(matrix, 30, FactorKind::dense), condensed(matrix, kept, FactorKind::condensed);
    ASSERT_EQ(whole.factorise(matrix), FactorStatus::ok);
    ASSERT_EQ(condensed.factorise(matrix), FactorStatus::ok);
    const VecX right = test::random_coordinates(rng, matrix.size(), 1.0), x = whole.solve(right);
    EXPECT_LT((condensed.solve(right) - x).norm(), 1e-13 * x.norm());  // rounding
    EXPECT_GT(x.norm(), 1e-3);
  }
}

TEST(Condensation, KeptUnknownsAnswerTheirLoadsAsInTheWholeSystem) {
  Rng rng(2);
  const BlockMatrix matrix = test::random_positive(rng, 20);
  Condensation condensation(matrix, 12);
  ASSERT_EQ(condensation.eliminate(matrix), FactorStatus::ok);
  const Eigen::MatrixXd whole = test::dense(matrix);
  const Eigen::MatrixXd inside = whole.bottomRightCorner(24, 24), across = whole.bottomLeftCorner(24, 36);
  Eigen::MatrixXd factor = inside, answered = across;
  ASSERT_TRUE(cholesky_in_place(factor));
  for (Eigen::Index c = 0; c < across.cols(); ++c) answered.col(c) = cholesky_solve(factor, across.col(c));
  const Eigen::MatrixXd schur = whole.topLeftCorner(36, 36) - across.transpose() * answered;
  const Eigen::MatrixXd difference = condensation.condensed() - schur;
  EXPECT_LT(Eigen::MatrixXd(difference.triangularView<Eigen::Lower>()).norm(), 1e-13 * schur.norm());
  EXPECT_GT((schur - whole.topLeftCorner(36, 36)).norm(), 1e-3 * schur.norm());
}

TEST(Condensation, NodesThatAreNotCoupledAreEliminatedApart) {
  // Two pairs of condensed nodes that meet kept ones only.
  BlockMatrix matrix(7, std::vector<std::vector<int>>{{0, 1, 3, 4}, {1, 2, 5, 6}});
  EXPECT_EQ(Condensation(matrix, 3).groups(), 2);
  BlockMatrix joined(7, std::vector<std::vector<int>>{{0, 1, 3, 4}, {1, 2, 5, 6}, {4, 5}});
  EXPECT_EQ(Condensation(joined, 3).groups(), 1);
}

TEST(Condensation, AGroupThatIsNotPositiveDefiniteIsReported) {
  Rng rng(3);
  BlockMatrix matrix = test::random_positive(rng, 10);
  Condensation condensation(matrix, 6);
  matrix.add(8, 8, -100 * Mat3::Identity());
  EXPECT_EQ(condensation.eliminate(matrix), FactorStatus::not_positive_definite);
}

}  // namespace
}  // namespace calot
