#include "numerics/block_matrix.h"

#include <gtest/gtest.h>

#include "random_matrices.h"

namespace calot {
namespace {

TEST(BlockMatrix, ProductsAreThoseOfTheDenseMatrix) {
  Rng rng(1);
  for (int nodes : {1, 4, 20}) {
    const BlockMatrix matrix = test::random_matrix(rng, nodes);
    const VecX x = test::random_coordinates(rng, matrix.size(), 1.0);
    const VecX expected = test::dense(matrix) * x;
    EXPECT_LT((matrix.multiply(x) - expected).norm(), 1e-14 * expected.norm());
  }
}

TEST(BlockMatrix, BlocksAddUpAtTheirSlots) {
  Rng rng(2);
  const std::vector<std::vector<int>> cliques = {{3, 0}, {1, 3, 4}};
  BlockMatrix matrix(5, cliques);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(15, 15);
  for (const auto& [i, j] : {std::pair{0, 0}, {3, 0}, {3, 1}, {4, 1}, {4, 3}, {3, 0}, {2, 2}}) {
    const Mat3 block = test::random_block(rng);
    matrix.add(i, j, block);
    expected.block<3, 3>(3 * i, 3 * j) += block;
  }
  EXPECT_EQ(test::stored(matrix), expected);
  for (const auto& [i, j] : {std::pair{3, 0}, {4, 3}, {2, 2}})
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        EXPECT_EQ(matrix.values()[matrix.slot(i, j) + c * matrix.stride(j) + r],
                  expected(3 * i + r, 3 * j + c));
}

TEST(BlockMatrix, IsMadeAgainOfItsPatternAndOfNothingThatIsNone) {
  Rng rng(3);
  for (int nodes : {0, 1, 20, 700}) {
    const BlockMatrix matrix = test::random_matrix(rng, nodes);
    std::optional<BlockMatrix> again = BlockMatrix::of_pattern(matrix.block_starts(), matrix.block_rows());
    ASSERT_TRUE(again) << nodes;
    EXPECT_EQ(again->column_starts(), matrix.column_starts());
    EXPECT_EQ(again->rows(), matrix.rows());
    again->assign(matrix.entries());
    for (int j = 0; j < nodes; ++j)
      for (int i = j; i < nodes; ++i) ASSERT_EQ(again->slot(i, j), matrix.slot(i, j));
  }
  using List = std::vector<int>;
  EXPECT_TRUE(BlockMatrix::of_pattern({0, 2, 3}, {0, 1, 1}));
  for (const auto& [starts, rows] : {std::pair<List, List>{{}, {}},
                                     {{1, 3}, {0, 1, 1}},
                                     {{0, 2, 4}, {0, 1, 1}},
                                     {{0, 2, 2}, {0, 1}},
                                     {{0, 3, 2}, {0, 1}},
                                     {{0, 2, 3}, {0, 2, 1}},
                                     {{0, 2, 3}, {1, 0, 1}},
                                     {{0, 3, 4}, {0, 1, 1, 1}},
                                     {{0, 2, 3}, {0, -1, 1}}})
    EXPECT_FALSE(BlockMatrix::of_pattern(starts, rows)) << starts.size() << " " << rows.size();
}

TEST(BlockMatrix, SlotsAreTheSameWithATableAndWithout) {
  const std::vector<std::vector<int>> cliques = {{0, 3, 7, 8}, {1, 3, 4}, {4, 9}};
  const BlockMatrix few(10, cliques), many(1000, cliques);  // too many nodes for a table
  const std::vector<int> nodes = {0, 3, 8};
  int of_few[3], of_many[3];
  few.slots(nodes, of_few);
  many.slots(nodes, of_many);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(of_few[k], few.slot(nodes[k], 0));
    EXPECT_EQ(of_many[k], of_few[k]);
  }
  for (int j = 0; j < 10; ++j)
    for (int i = j; i < 10; ++i) EXPECT_EQ(few.slot(i, j), many.slot(i, j)) << i << " " << j;
  EXPECT_EQ(few.slot(2, 0), -1);
  EXPECT_GT(few.slot(9, 4), 0);
}

TEST(BlockMatrix, PatternHoldsTheCliquesAndEveryDiagonalBlockOnly) {
  const std::vector<std::vector<int>> cliques = {{3, 0}, {1, 3, 4}, {3, 0}};
  const BlockMatrix matrix(6, cliques);
  for (int j = 0; j < 6; ++j)
    for (int i = j; i < 6; ++i) {
      const bool coupled = std::any_of(cliques.begin(), cliques.end(), [&](const std::vector<int>& clique) {
        return std::count(clique.begin(), clique.end(), i) && std::count(clique.begin(), clique.end(), j);
      });
      EXPECT_EQ(matrix.slot(i, j) >= 0, i == j || coupled) << i << " " << j;
    }
  EXPECT_EQ(matrix.nodes(), 6);
  EXPECT_EQ(matrix.size(), 18);
}

TEST(BlockMatrix, RowsOfAColumnIncrease) {
  Rng rng(3);
  const BlockMatrix matrix = test::random_matrix(rng, 12);
  ASSERT_EQ(matrix.column_starts().size(), 37u);
  EXPECT_EQ(matrix.column_starts().back(), static_cast<int>(matrix.entries().size()));
  for (int c = 0; c < matrix.size(); ++c)
    for (int e = matrix.column_starts()[c] + 1; e < matrix.column_starts()[c + 1]; ++e)
      EXPECT_LT(matrix.rows()[e - 1], matrix.rows()[e]);
}

TEST(BlockMatrix, ShiftIsAddedToTheDiagonalAlone) {
  Rng rng(4);
  BlockMatrix matrix = test::random_matrix(rng, 6);
  const Eigen::MatrixXd before = test::stored(matrix);
  EXPECT_NEAR(matrix.diagonal_mean(), before.diagonal().cwiseAbs().mean(), 1e-14);
  matrix.add_to_diagonal(0.75);
  const Eigen::MatrixXd added = test::stored(matrix) - before;
  EXPECT_LT((added - 0.75 * Eigen::MatrixXd::Identity(18, 18)).norm(), 1e-14);
}

TEST(BlockMatrix, StartsFromAssignedValuesOrZero) {
  Rng rng(5);
  BlockMatrix matrix = test::random_matrix(rng, 6);
  const BlockMatrix copy = matrix;
  matrix.set_zero();
  EXPECT_EQ(test::stored(matrix).norm(), 0);
  matrix.assign(copy.entries());
  EXPECT_EQ(test::stored(matrix), test::stored(copy));
}

TEST(BlockMatrix, EntriesOfAnotherAddUpWithItsOwn) {
  Rng rng(9);
  BlockMatrix sum = test::random_matrix(rng, 12);
  BlockMatrix other = sum;
  for (double* value = other.values(); value != other.values() + other.entries().size(); ++value)
    *value = rng.uniform(-1, 1);
  const Eigen::MatrixXd expected = test::stored(sum) + test::stored(other);
  sum.add(other.entries());
  EXPECT_EQ(test::stored(sum), expected);
}

TEST(BlockMatrix, AWidenedMatrixIsTheSameWithRoomForMore) {
  const std::vector<std::vector<int>> few{{0, 1}, {2, 3}}, more{{1, 3}};
  BlockMatrix matrix(4, few);
  for (int k = 0; k < static_cast<int>(matrix.entries().size()); ++k) matrix.values()[k] = 1 + k;
  BlockMatrix wide = matrix.widened(more);
  Rng rng(4);
  const VecX x = test::random_coordinates(rng, 12, 1.0);
  EXPECT_EQ(wide.multiply(x), matrix.multiply(x));
  EXPECT_LT(matrix.slot(3, 1), 0);
  ASSERT_GE(wide.slot(3, 1), 0);
  wide.add(3, 1, Mat3::Identity());
  EXPECT_NE(wide.multiply(x), matrix.multiply(x));
  wide.assign(matrix);  // what is not in the narrower is zero again
  EXPECT_EQ(wide.multiply(x), matrix.multiply(x));
}

TEST(BlockMatrix, OneValueThatIsNotFiniteIsFound) {
  Rng rng(6);
  for (double bad : {std::nan(""), HUGE_VAL}) {
    BlockMatrix matrix = test::random_matrix(rng, 6);
    EXPECT_TRUE(matrix.all_finite());
    matrix.values()[17] = bad;
    EXPECT_FALSE(matrix.all_finite());
  }
}

}  // namespace
}  // namespace calot
