#include "numerics/cholesky.h"

#include <gtest/gtest.h>

#include "random_matrices.h"

namespace calot {
namespace {

/// Every factorisation obeys the same laws; the condensed one keeps two thirds of the nodes.
class CholeskyOf : public ::testing::TestWithParam<FactorKind> {
 protected:
  static Cholesky factor(const BlockMatrix& matrix) {
    return Cholesky(matrix, (2 * matrix.nodes() + 2) / 3, GetParam());
  }
};
INSTANTIATE_TEST_SUITE_P(Each, CholeskyOf,
                         ::testing::Values(FactorKind::dense, FactorKind::sparse, FactorKind::condensed),
                         [](const auto& kind) {
                           return kind.param == FactorKind::dense    ? "Dense"
                                  : kind.param == FactorKind::sparse ? "Sparse"
                                                                     : "Condensed";
                         });

TEST_P(CholeskyOf, SolvesRandomPositiveSystems) {
  Rng rng(1);
  for (int nodes : {1, 5, 40}) {
    const BlockMatrix matrix = test::random_positive(rng, nodes);
    Cholesky cholesky = factor(matrix);
    ASSERT_EQ(cholesky.factorise(matrix), FactorStatus::ok);
    const VecX right = test::random_coordinates(rng, matrix.size(), 1.0);
    const VecX x = cholesky.solve(right);
    // Condition numbers near 10: the residual is rounding.
    EXPECT_LT((matrix.multiply(x) - right).norm(), 1e-13 * right.norm());
  }
}

TEST_P(CholeskyOf, AnalysisServesEveryMatrixOfItsPattern) {
  Rng rng(2);
  BlockMatrix matrix = test::random_positive(rng, 20);
  Cholesky cholesky = factor(matrix);
  Cholesky moved = std::move(cholesky);
  const VecX right = test::random_coordinates(rng, matrix.size(), 1.0);
  for (int trial = 0; trial < 5; ++trial) {
    for (int k = 0; k < static_cast<int>(matrix.entries().size()); ++k)
      matrix.values()[k] *= rng.uniform(0.95, 1.0);
    ASSERT_EQ(moved.factorise(matrix), FactorStatus::ok);
    EXPECT_LT((matrix.multiply(moved.solve(right)) - right).norm(), 1e-13 * right.norm());
  }
}

TEST_P(CholeskyOf, SharedWorkGivesTheSameBits) {
  Rng rng(4);
  Workers workers(3);
  ASSERT_EQ(workers.threads(), 3);
  // Several blocks of columns under a corner and several columns to solve for: more than one piece of each.
  const BlockMatrix matrix = test::random_positive(rng, 150);
  Eigen::MatrixXd right(matrix.size(), 9);
  for (Eigen::Index k = 0; k < right.cols(); ++k)
    right.col(k) = test::random_coordinates(rng, matrix.size(), 1.0);
  Cholesky alone = factor(matrix), shared = factor(matrix);
  ASSERT_EQ(alone.factorise(matrix), FactorStatus::ok);
  const Eigen::MatrixXd x = alone.solve(right);
  for (int round = 0; round < 20; ++round) {
    ASSERT_EQ(shared.factorise(matrix, &workers), FactorStatus::ok);
    ASSERT_EQ(shared.solve(right, &workers), x) << round;
  }
  EXPECT_EQ(alone.solve(Eigen::MatrixXd(matrix.size(), 0)).cols(), 0);
  for (Eigen::Index k = 0; k < right.cols(); ++k)
    EXPECT_LT((matrix.multiply(x.col(k)) - right.col(k)).norm(), 1e-13 * right.col(k).norm()) << k;
}

TEST_P(CholeskyOf, ComplianceIsTheNodesPartOfTheInverse) {
  Rng rng(5);
  Workers workers(3);
  const BlockMatrix matrix = test::random_positive(rng, 120);
  Cholesky cholesky = factor(matrix);
  ASSERT_EQ(cholesky.factorise(matrix), FactorStatus::ok);
  const Eigen::MatrixXd inverse = test::dense(matrix).inverse();
  // Kept ones, condensed ones, and both.
  for (const std::vector<int>& nodes :
       {std::vector<int>{0, 3, 40}, std::vector<int>{90, 118}, std::vector<int>{5, 79, 80, 81, 119}}) {
    std::vector<int> unknowns;
    for (int node : nodes)
      for (int c = 0; c < 3; ++c) unknowns.push_back(3 * node + c);
    const Eigen::MatrixXd compliance = cholesky.compliance(nodes);
    // Condition numbers near 10: the difference is rounding.
    EXPECT_LT((compliance - inverse(unknowns, unknowns)).norm(), 1e-13 * compliance.norm());
    EXPECT_EQ(compliance, compliance.transpose());
    EXPECT_EQ(cholesky.compliance(nodes, &workers), compliance);
  }
}

TEST_P(CholeskyOf, SameMatrixGivesTheSameBits) {
  Rng rng(3);
  const BlockMatrix matrix = test::random_positive(rng, 20);
  const VecX right = test::random_coordinates(rng, matrix.size(), 1.0);
  Cholesky first = factor(matrix), second = factor(matrix);
  ASSERT_EQ(first.factorise(matrix), FactorStatus::ok);
  ASSERT_EQ(second.factorise(matrix), FactorStatus::ok);
  const VecX x = first.solve(right);
  EXPECT_EQ(second.solve(right), x);
  ASSERT_EQ(first.factorise(matrix), FactorStatus::ok);
  EXPECT_EQ(first.solve(right), x);
}

TEST_P(CholeskyOf, ValueThatIsNotFiniteIsRefused) {
  Rng rng(4);
  for (double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    BlockMatrix matrix = test::random_positive(rng, 10);
    Cholesky cholesky = factor(matrix);
    matrix.values()[matrix.slot(4, 4)] = bad;  // on the diagonal, which CHOLMOD 3.0.14 lets pass
    EXPECT_EQ(cholesky.factorise(matrix), FactorStatus::not_finite);
  }
}

/// By inverse iteration: its error is the square of the vector's.
double least_eigenvalue(const BlockMatrix& matrix, const Cholesky& factor) {
  VecX v = VecX::Ones(matrix.size());
  for (int round = 0; round < 500; ++round) v = factor.solve(v).normalized();
  return v.dot(matrix.multiply(v));
}

TEST_P(CholeskyOf, IndefiniteMatrixIsReportedAndTheNextOneServed) {
  Rng rng(5);
  BlockMatrix matrix = test::random_positive(rng, 10);
  Cholesky cholesky = factor(matrix);
  ASSERT_EQ(cholesky.factorise(matrix), FactorStatus::ok);
  const double least = least_eigenvalue(matrix, cholesky);
  matrix.add_to_diagonal(-1.01 * least);
  EXPECT_EQ(cholesky.factorise(matrix), FactorStatus::not_positive_definite);
  matrix.add_to_diagonal(0.02 * least);
  ASSERT_EQ(cholesky.factorise(matrix), FactorStatus::ok);
  const VecX right = test::random_coordinates(rng, matrix.size(), 1.0);
  EXPECT_LT((matrix.multiply(cholesky.solve(right)) - right).norm(), 1e-10 * right.norm());
}

TEST_P(CholeskyOf, ConditionEstimateIsThatOfADiagonalMatrix) {
  BlockMatrix matrix(3, std::vector<std::vector<int>>{});
  for (int i = 0; i < 3; ++i) matrix.add(i, i, Vec3(1.0, 4.0, std::pow(10.0, -i)).asDiagonal());
  Cholesky cholesky = factor(matrix);
  ASSERT_EQ(cholesky.factorise(matrix), FactorStatus::ok);
  EXPECT_NEAR(cholesky.reciprocal_condition(), 0.01 / 4.0, 1e-15);
}

TEST_P(CholeskyOf, FactorIsNeverSmallerThanTheMatrix) {
  Rng rng(6);
  const BlockMatrix matrix = test::random_positive(rng, 20);
  Cholesky cholesky = factor(matrix);
  ASSERT_EQ(cholesky.factorise(matrix), FactorStatus::ok);
  long below = 0;
  for (int c = 0; c < matrix.size(); ++c)
    for (int e = matrix.column_starts()[c]; e < matrix.column_starts()[c + 1]; ++e)
      below += matrix.rows()[e] >= c;
  EXPECT_GE(cholesky.factor_nonzeros(), below);
  EXPECT_LE(cholesky.factor_nonzeros(), 60L * 61 / 2);
  EXPECT_GE(cholesky.factor_flops(), static_cast<double>(below));
}

TEST_P(CholeskyOf, ACopyThatFactorisesAnewCostsWhatTheFirstDid) {
  Rng rng(8);
  const BlockMatrix matrix = test::random_positive(rng, 20);
  const Cholesky first = factor(matrix);
  Cholesky second = first;
  ASSERT_EQ(second.factorise(matrix), FactorStatus::ok);
  EXPECT_FALSE(second.shares_factor_with(first));
  EXPECT_GT(first.factor_flops(), 0);
  EXPECT_EQ(second.factor_flops(), first.factor_flops());
  EXPECT_EQ(second.factor_nonzeros(), first.factor_nonzeros());
}

/// A band of `places` nodes, and strands of one node each between faces of it that are far from each other.
std::vector<std::vector<int>> tied_band(int places, int strands) {
  constexpr int face = 12;
  std::vector<std::vector<int>> out;
  for (int i = 0; i + face <= places; ++i) {
    out.emplace_back();
    for (int k = 0; k < face; ++k) out.back().push_back(i + k);
  }
  const std::vector<std::vector<int>> faces = out;
  for (int s = 0; s < strands; ++s) {
    const std::size_t here = static_cast<std::size_t>(s) % (faces.size() / 2);
    out.push_back(faces[here]);
    out.back().insert(out.back().end(), faces[faces.size() - 1 - here].begin(),
                      faces[faces.size() - 1 - here].end());
    out.back().push_back(places + s);
  }
  return out;
}

TEST(Cholesky, StrandsAreCondensedAndWhereTheyMayNotBeASparseFactorServes) {
  const BlockMatrix matrix(1000, tied_band(200, 800));
  const Cholesky condensed(matrix, 200), whole(matrix, 1000), dense(matrix, 1000, FactorKind::dense);
  EXPECT_EQ(condensed.kind(), FactorKind::condensed);
  EXPECT_EQ(whole.kind(), FactorKind::sparse);
  EXPECT_GT(dense.factor_flops(), 10 * whole.factor_flops());
}

TEST(Cholesky, OnlyKeptNodesCountForTheRoomADenseFactorTakes) {
  const BlockMatrix matrix(dense_nodes + 1, tied_band(dense_nodes, 1));
  EXPECT_EQ(Cholesky(matrix).kind(), FactorKind::sparse);
  EXPECT_EQ(Cholesky(matrix, dense_nodes).kind(), FactorKind::condensed);
}

TEST(Cholesky, SmallBodiesAreDenseAndAllKindsAgree) {
  Rng rng(7);
  const BlockMatrix matrix = test::random_positive(rng, 30);
  Cholesky chosen(matrix), dense(matrix, 30, FactorKind::dense), sparse(matrix, 30, FactorKind::sparse);
  const VecX right = test::random_coordinates(rng, matrix.size(), 1.0);
  for (Cholesky* one : {&chosen, &dense, &sparse}) ASSERT_EQ(one->factorise(matrix), FactorStatus::ok);
  EXPECT_EQ(chosen.solve(right), dense.solve(right));
  EXPECT_LT((sparse.solve(right) - dense.solve(right)).norm(), 1e-14 * dense.solve(right).norm());
}

}  // namespace
}  // namespace calot
