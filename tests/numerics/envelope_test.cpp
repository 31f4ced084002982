#include "numerics/envelope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "random_matrices.h"

namespace calot {
namespace {

using Graph = std::vector<std::vector<int>>;

/// A closed strip of rings of six nodes, each coupled with its own ring and the next, numbered at random.
Graph shuffled_tube(int rings, Rng& rng) {
  const int nodes = 6 * rings;
  std::vector<int> number(nodes);
  std::iota(number.begin(), number.end(), 0);
  for (int k = nodes - 1; k > 0; --k) std::swap(number[k], number[static_cast<int>(rng.uniform() * (k + 1))]);
  Graph out(nodes);
  for (int a = 0; a < nodes; ++a)
    for (int b = 0; b < nodes; ++b)
      if (a != b && std::abs(a / 6 - b / 6) <= 1) out[number[a]].push_back(number[b]);
  return out;
}

BlockMatrix positive_on(const Graph& graph, Rng& rng) {
  std::vector<std::vector<int>> cliques;
  for (int a = 0; a < static_cast<int>(graph.size()); ++a)
    for (int b : graph[a])
      if (b > a) cliques.push_back({a, b});
  BlockMatrix matrix(static_cast<int>(graph.size()), cliques);
  for (const std::vector<int>& pair : cliques) {
    Mat3 block;
    for (int k = 0; k < 9; ++k) block(k) = rng.uniform() - 0.5;
    matrix.add(pair[1], pair[0], block);
  }
  matrix.add_to_diagonal(40.0);  // more than a row's sum of 17 neighbours' blocks
  return matrix;
}

/// What the stored blocks couple.
Graph graph_of(const BlockMatrix& matrix) {
  Graph out(matrix.nodes());
  for (int a = 0; a < matrix.nodes(); ++a)
    for (int b = 0; b < a; ++b)
      if (matrix.slot(a, b) >= 0) out[a].push_back(b), out[b].push_back(a);
  return out;
}

void load(const BlockMatrix& matrix, EnvelopeFactor& factor) {
  factor.clear();
  for (int j = 0; j < matrix.nodes(); ++j)
    for (int i = j; i < matrix.nodes(); ++i)
      if (const int at = matrix.slot(i, j); at >= 0)
        factor.set(i, j, matrix.entries().data() + at, matrix.stride(j));
}

TEST(CloseOrder, HoldsEachNodeOnceAndKeepsRingsOfATubeTogether) {
  Rng rng(3);
  const Graph graph = shuffled_tube(20, rng);
  const std::vector<int> order = close_order(graph);
  std::vector<int> place(graph.size(), -1);
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  EXPECT_EQ(std::count(place.begin(), place.end(), -1), 0);
  int widest = 0;
  for (std::size_t a = 0; a < graph.size(); ++a)
    for (int b : graph[a]) widest = std::max(widest, std::abs(place[a] - place[b]));
  EXPECT_LE(widest, 17) << "two rings after its own at most";
}

TEST(CloseOrder, ServesNodesThatNothingCouples) {
  const std::vector<int> order = close_order({{}, {2}, {1}, {}});
  EXPECT_EQ(std::vector<int>(order).size(), 4u);
  EXPECT_EQ(std::accumulate(order.begin(), order.end(), 0), 6);
}

TEST(EnvelopeFactor, SolvesWhatItIsGivenWithFewerOperationsThanAFullFactor) {
  Rng rng(5);
  const Graph graph = shuffled_tube(20, rng);
  const BlockMatrix matrix = positive_on(graph, rng);
  EnvelopeFactor factor(graph);
  load(matrix, factor);
  ASSERT_TRUE(factor.factorise());
  const VecX right = test::random_coordinates(rng, matrix.size(), 1.0), x = factor.solve(right);
  EXPECT_LT((matrix.multiply(x) - right).norm(), 1e-13 * right.norm());
  EXPECT_GT(x.norm(), 1e-3);
  const double n = matrix.size();
  EXPECT_LT(factor.flops(), 0.3 * n * n * n / 3);
}

TEST(EnvelopeFactor, WhatIsTakenOffCountsAsIfItHadNeverBeenThere) {
  Rng rng(6);
  const Graph graph = shuffled_tube(12, rng);
  const BlockMatrix matrix = positive_on(graph, rng);
  // A ring's nodes, numbered as they come: some stand before, some behind each other in the factor's order.
  std::vector<int> nodes = graph[7];
  nodes.push_back(7);
  std::sort(nodes.begin(), nodes.end());
  BlockMatrix more = matrix.widened(std::vector<std::vector<int>>{nodes});
  const Eigen::Index size = 3 * std::ssize(nodes);
  Eigen::MatrixXd product(size, size);
  for (Eigen::Index c = 0; c < size; ++c)
    for (Eigen::Index r = 0; r < size; ++r) product(r, c) = product(c, r) = rng.uniform(-1, 1);
  for (std::size_t b = 0; b < nodes.size(); ++b)
    for (std::size_t a = b; a < nodes.size(); ++a)
      more.add(nodes[a], nodes[b], product.block<3, 3>(3 * static_cast<int>(a), 3 * static_cast<int>(b)));
  const EnvelopeFactor wide(graph_of(more));
  EnvelopeFactor taken_off = wide, never_there = wide;
  load(more, taken_off);
  taken_off.subtract(nodes, product.data());
  EnvelopeFactor by_shares = wide;
  load(more, by_shares);
  for (int k : {2, 0, 1}) by_shares.subtract(nodes, product.data(), k, 3);
  load(matrix, never_there);
  ASSERT_TRUE(taken_off.factorise() && never_there.factorise());
  const VecX right = test::random_coordinates(rng, matrix.size(), 1.0), x = never_there.solve(right);
  EXPECT_LT((taken_off.solve(right) - x).norm(), 1e-14 * x.norm());  // rounding
  ASSERT_TRUE(by_shares.factorise());
  EXPECT_EQ(by_shares.solve(right), taken_off.solve(right));
  EXPECT_LT((matrix.multiply(x) - right).norm(), 1e-13 * right.norm());
}

TEST(EnvelopeFactor, RefusesWhatIsNotPositiveDefinite) {
  Rng rng(7);
  const Graph graph = shuffled_tube(4, rng);
  BlockMatrix matrix = positive_on(graph, rng);
  matrix.add_to_diagonal(-60.0);
  EnvelopeFactor factor(graph);
  load(matrix, factor);
  EXPECT_FALSE(factor.factorise());
}

}  // namespace
}  // namespace calot
