// What is kept of a solve is as good when it was made again of its bytes.

#include "numerics/newton_workspace.h"

#include <gtest/gtest.h>

#include "random_matrices.h"

namespace calot {
namespace {

/// Of so many nodes, every other of which may be condensed, with two constraints; its matrix has other values by now.
NewtonWorkspace factored(Rng& rng, int nodes) {
  const BlockMatrix matrix = test::random_positive(rng, nodes);
  std::vector<char> kept;
  for (int node = 0; node < nodes; ++node) kept.push_back(node % 2 == 0 ? 1 : 0);
  NewtonWorkspace work(matrix, kept);
  EXPECT_EQ(work.factor.factorise(work.matrix), FactorStatus::ok);
  work.border.gradients = Eigen::MatrixXd::Ones(matrix.size(), 2);
  for (int k = 0; k < 2; ++k)
    work.border.gradients.col(k) = test::random_coordinates(rng, matrix.size(), 1.0);
  work.border.solve_with(work.factor);
  work.factored = true;
  work.sharp = {{1, -1, 7, test::random_block(rng)}, {2, 3, 0, test::random_block(rng)}};
  work.matrix.set_zero();
  return work;
}

std::string bytes_of(const NewtonWorkspace& work) {
  ByteWriter out;
  MemberWriter{out}(work);
  return out.bytes();
}

bool take(const std::string& bytes, NewtonWorkspace& work) {
  ByteReader in(bytes);
  MemberReader{in}(work);
  return in.complete();
}

TEST(NewtonWorkspace, MadeAgainOfItsBytesSolvesToTheSameBits) {
  Rng rng(4);
  for (const int nodes : {1, 12, 40}) {
    const NewtonWorkspace work = factored(rng, nodes);
    NewtonWorkspace again(BlockMatrix(0, {}));
    ASSERT_TRUE(take(bytes_of(work), again));
    EXPECT_TRUE(again.factored);
    EXPECT_EQ(again.factor.kind(), work.factor.kind());
    const VecX load = test::random_coordinates(rng, work.matrix.size(), 1.0);
    VecX step = work.factor.solve(load), step_again = again.factor.solve(load);
    EXPECT_EQ(step_again, step);
    EXPECT_EQ(again.border.keep(VecX::Ones(2), step_again), work.border.keep(VecX::Ones(2), step));
    EXPECT_EQ(step_again, step);
    ASSERT_EQ(again.sharp.size(), 2u);
    EXPECT_EQ(again.sharp[1].stiffness, work.sharp[1].stiffness);
    EXPECT_EQ(bytes_of(again), bytes_of(work));
  }
}

TEST(NewtonWorkspace, WithoutAFactorIsItsPattern) {
  Rng rng(5);
  NewtonWorkspace work = factored(rng, 12), again(BlockMatrix(0, {}));
  work.factored = false;
  work.shifted = true;
  ASSERT_TRUE(take(bytes_of(work), again));
  EXPECT_FALSE(again.factored);
  EXPECT_TRUE(again.shifted);
  EXPECT_EQ(again.matrix.block_rows(), work.matrix.block_rows());
  EXPECT_EQ(again.factor.kept(), work.factor.kept());
}

TEST(NewtonWorkspace, BytesThatCannotBeOfOneAreRefused) {
  Rng rng(6);
  const NewtonWorkspace work = factored(rng, 5);
  const std::string bytes = bytes_of(work);
  NewtonWorkspace again(BlockMatrix(0, {}));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(take(bytes.substr(0, size), again)) << size;
  NewtonWorkspace other = work;
  BlockMatrix unfit = work.matrix;
  unfit.add_to_diagonal(-100.0);
  other.factor.factorise(unfit);
  EXPECT_FALSE(take(bytes_of(other), again)) << "of a matrix that has no factor";
  other = work;
  other.border.gradients.conservativeResize(3, 2);
  EXPECT_FALSE(take(bytes_of(other), again)) << "of other nodes";
}

}  // namespace
}  // namespace calot
