#include "numerics/condense.h"

#include <gtest/gtest.h>

#include <algorithm>

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

/// Nodes that chance keeps, and a matrix in which the others are chains and single nodes, coupled with some of them.
struct Pieces {
  std::vector<char> kept;
  BlockMatrix matrix;
};
Pieces random_pieces(Rng& rng, int nodes, double share_kept) {
  std::vector<char> kept(static_cast<std::size_t>(nodes));
  std::vector<int> stay;
  for (int i = 0; i < nodes; ++i)
    if ((kept[i] = rng.uniform() < share_kept)) stay.push_back(i);
  std::vector<std::vector<int>> cliques;
  for (std::size_t i = 1; i < stay.size(); ++i) cliques.push_back({stay[i - 1], stay[i]});
  int last = -1;
  for (int i = 0; i < nodes && !stay.empty(); ++i) {
    if (kept[i]) continue;
    const std::size_t face =
        std::min<std::size_t>(stay.size() - 1, static_cast<std::size_t>(rng.uniform(0, 3)));
    cliques.push_back({i, stay[face], stay[stay.size() - 1 - face]});
    if (last >= 0 && rng.uniform() < 0.5) cliques.push_back({last, i});  // else a piece ends here
    last = i;
  }
  for (std::vector<int>& clique : cliques) std::sort(clique.begin(), clique.end());
  for (std::vector<int>& clique : cliques)
    clique.erase(std::unique(clique.begin(), clique.end()), clique.end());
  BlockMatrix matrix(nodes, cliques);
  for (int j = 0; j < nodes; ++j)
    for (int i = j; i < nodes; ++i)
      if (matrix.slot(i, j) >= 0) {
        const Mat3 block = test::random_block(rng);
        matrix.add(i, j, i == j ? Mat3(block + block.transpose()) : block);
      }
  matrix.add_to_diagonal(1.0 + test::dense(matrix).cwiseAbs().rowwise().sum().maxCoeff());
  return {kept, matrix};
}

TEST(Condensation, AnyNodesMayBeKeptAndThePiecesBeMany) {
  Rng rng(4);
  int most = 0;
  for (double share : {0.0, 0.1, 0.4, 0.7, 1.0})
    for (int trial = 0; trial < 5; ++trial) {
      const Pieces given = random_pieces(rng, 40, share);
      most = std::max(most, Condensation(given.matrix, given.kept).pieces());
      Cholesky whole(given.matrix, given.kept, FactorKind::dense),
          condensed(given.matrix, given.kept, FactorKind::condensed);
      ASSERT_EQ(whole.factorise(given.matrix), FactorStatus::ok);
      ASSERT_EQ(condensed.factorise(given.matrix), FactorStatus::ok);
      const VecX right = test::random_coordinates(rng, given.matrix.size(), 1.0), x = whole.solve(right),
                 y = condensed.solve(right);
      EXPECT_LT((y - x).norm(), 1e-13 * x.norm()) << share;  // rounding
      EXPECT_LT((given.matrix.multiply(y) - right).norm(), 1e-13 * right.norm()) << share;
      EXPECT_GT(x.norm(), 1e-3);
    }
  EXPECT_GT(most, 5);
}

TEST(Condensation, HundredsOfPiecesGiveTheSameBitsAtAnyNumberOfThreads) {
  Rng rng(9);
  Workers workers(3);
  const Pieces given = random_pieces(rng, 250, 0.3);
  ASSERT_GT(Condensation(given.matrix, given.kept).pieces(), 32) << "more than are eliminated at once";
  Cholesky whole(given.matrix, given.kept, FactorKind::dense),
      alone(given.matrix, given.kept, FactorKind::condensed),
      shared(given.matrix, given.kept, FactorKind::condensed);
  ASSERT_EQ(whole.factorise(given.matrix), FactorStatus::ok);
  ASSERT_EQ(alone.factorise(given.matrix), FactorStatus::ok);
  const VecX right = test::random_coordinates(rng, given.matrix.size(), 1.0), x = whole.solve(right);
  EXPECT_LT((alone.solve(right) - x).norm(), 1e-13 * x.norm());  // rounding
  for (int round = 0; round < 20; ++round) {
    ASSERT_EQ(shared.factorise(given.matrix, &workers), FactorStatus::ok);
    ASSERT_EQ(shared.solve(right), alone.solve(right)) << round;
  }
}

TEST(Condensation, KeptUnknownsAnswerTheirLoadsAsInTheWholeSystem) {
  Rng rng(2);
  const BlockMatrix matrix = test::random_positive(rng, 20);
  const Condensation found(matrix, first_kept(20, 12));
  Condensation condensation = found.blank();
  EnvelopeFactor kept(condensation.kept_couplings());
  ASSERT_EQ(condensation.eliminate(matrix, kept), FactorStatus::ok);
  ASSERT_TRUE(kept.factorise());
  const Eigen::MatrixXd whole = test::dense(matrix);
  const Eigen::MatrixXd inside = whole.bottomRightCorner(24, 24), across = whole.bottomLeftCorner(24, 36);
  Eigen::MatrixXd factor = inside;
  ASSERT_TRUE(cholesky_in_place(factor));
  const Eigen::MatrixXd answered = cholesky_solve(factor, across);
  const Eigen::MatrixXd schur = whole.topLeftCorner(36, 36) - across.transpose() * answered;
  const VecX right = test::random_coordinates(rng, 36, 1.0);
  EXPECT_LT((schur * kept.solve(right) - right).norm(), 1e-13 * right.norm());
  EXPECT_GT((schur - whole.topLeftCorner(36, 36)).norm(), 1e-3 * schur.norm());
}

TEST(Condensation, NodesThatAreNotCoupledAreEliminatedApart) {
  // Two pairs of condensed nodes that meet kept ones only.
  BlockMatrix matrix(7, std::vector<std::vector<int>>{{0, 1, 3, 4}, {1, 2, 5, 6}});
  EXPECT_EQ(Condensation(matrix, first_kept(7, 3)).pieces(), 2);
  BlockMatrix joined(7, std::vector<std::vector<int>>{{0, 1, 3, 4}, {1, 2, 5, 6}, {4, 5}});
  EXPECT_EQ(Condensation(joined, first_kept(7, 3)).pieces(), 1);
}

TEST(Condensation, SingleNodesBetweenTheSameKeptOnesShareAPieceThatIsStillNoMoreThanTheirOwn) {
  const std::vector<std::vector<int>> strands = {{0, 1, 3}, {0, 1, 4}, {0, 1, 5}, {1, 2, 6}};
  const Condensation apart(BlockMatrix(7, strands), first_kept(7, 3));
  EXPECT_EQ(apart.pieces(), 2);
  EXPECT_EQ(apart.nonzeros(), 4 * (6 + 3 * 6)) << "four factors of 3 x 3, four couplings with two nodes";
}

TEST(Condensation, APieceThatIsNotPositiveDefiniteIsReportedAndSoIsTheCore) {
  Rng rng(3);
  const Pieces given = random_pieces(rng, 40, 0.5);
  const Condensation analysed(given.matrix, given.kept);
  for (int node = 0; node < 40; ++node) {
    BlockMatrix bad = given.matrix;
    bad.add(node, node, -1000 * Mat3::Identity());
    Cholesky condensed(given.matrix, given.kept, FactorKind::condensed);
    EXPECT_EQ(condensed.factorise(bad), FactorStatus::not_positive_definite) << node;
    EXPECT_EQ(condensed.factorise(given.matrix), FactorStatus::ok) << "the next one is served";
    Condensation pieces = analysed.blank();
    EnvelopeFactor core(pieces.kept_couplings());
    EXPECT_EQ(pieces.eliminate(bad, core) == FactorStatus::ok, given.kept[node] == 1) << "who refuses it";
  }
}

TEST(Condensation, CopiesShareAFactorUntilOneIsMadeAnew) {
  Rng rng(5);
  const Pieces given = random_pieces(rng, 40, 0.5);
  BlockMatrix stiffer = given.matrix;
  stiffer.add_to_diagonal(100);
  Cholesky first(given.matrix, given.kept, FactorKind::condensed);
  ASSERT_EQ(first.factorise(given.matrix), FactorStatus::ok);
  Cholesky second = first;
  EXPECT_TRUE(second.shares_factor_with(first));
  const VecX right = test::random_coordinates(rng, given.matrix.size(), 1.0), x = first.solve(right);
  ASSERT_EQ(second.factorise(stiffer), FactorStatus::ok);
  EXPECT_FALSE(second.shares_factor_with(first));
  EXPECT_EQ(first.solve(right), x);
  EXPECT_LT((stiffer.multiply(second.solve(right)) - right).norm(), 1e-13 * right.norm());
}

}  // namespace
}  // namespace calot
