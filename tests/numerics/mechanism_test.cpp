#include "numerics/mechanism.h"

#include <gtest/gtest.h>

#include "spring_net.h"

namespace calot {
namespace {

using test::Net;

/// Tangent of a net that nothing holds, at rest: zero but for rounding on its rigid motions.
BlockMatrix free_tangent() {
  Net net(false);
  net.ground = 0;
  BlockMatrix matrix = net.workspace().matrix;
  net.hessian(net.rest(), 0, matrix);
  return matrix;
}

TEST(Mechanism, WhatOnlyAPressureTakesUpHoldsNothing) {
  // Lifted, a liquid's weight asks for another pressure and for nothing else: K t = g for its volume's gradient g.
  const Net net(true);
  BlockMatrix matrix = free_tangent();
  VecX g;
  net.constraint(net.rest(), g);
  for (int node = 0; node < Net::nodes; ++node)
    for (int other = 0; other <= node; ++other) {
      const Vec3 here = g.segment<3>(3 * node), there = g.segment<3>(3 * other);
      matrix.add(node, other, here * Vec3::UnitZ().transpose() + Vec3::UnitZ() * there.transpose());
      if (node == other) {
        Mat3 held = Mat3::Zero();
        held.diagonal() << 1, 1, 0;  // to the sides, which leaves the lift alone
        matrix.add(node, node, held);
      }
    }
  const std::vector<Part> parts{{{0, Net::nodes}, {}, 1}};
  EXPECT_EQ(mechanism(matrix, g, VecX(), net.rest(), parts), 0);
  EXPECT_EQ(mechanism(matrix, Eigen::MatrixXd(g.size(), 0), VecX(), net.rest(), parts), std::nullopt);
}

TEST(Mechanism, DisplacementsThatAreHeldDoNotHoldThePlaces) {
  // Details are added to where the places take them, so that a shift leaves them as they are.
  const Net net(false);
  const int all = 2 * Net::nodes;
  std::vector<int> clique;
  for (int i = 0; i < Net::nodes; ++i) clique.push_back(i);
  BlockMatrix matrix(all, std::vector<std::vector<int>>{clique});
  const Eigen::MatrixXd loose = test::dense(free_tangent());
  for (int j = 0; j < Net::nodes; ++j)
    for (int i = j; i < Net::nodes; ++i) matrix.add(i, j, loose.block<3, 3>(3 * i, 3 * j));
  for (int i = Net::nodes; i < all; ++i) matrix.add(i, i, Mat3::Identity());
  Rng rng(7);
  VecX x = test::random_coordinates(rng, 3 * all, 0.1);
  x.head(3 * Net::nodes) = net.rest();
  const Eigen::MatrixXd unconstrained(x.size(), 0);
  EXPECT_EQ(
      mechanism(matrix, unconstrained, VecX(), x, std::vector<Part>{{{0, Net::nodes}, {Net::nodes, all}, 1}}),
      0);
  // As a body of their own they hold nothing either; as places of the same one they do.
  EXPECT_EQ(mechanism(matrix, unconstrained, VecX(), x,
                      std::vector<Part>{{{Net::nodes, all}, {}, 1}, {{0, Net::nodes}, {}, 1}}),
            1);
  EXPECT_EQ(mechanism(matrix, unconstrained, VecX(), x, std::vector<Part>{{{0, all}, {}, 1}}), std::nullopt);
}

TEST(Mechanism, AHeldBodyWhoseNodesAreInLineIsNone) {
  constexpr int nodes = 3;
  BlockMatrix matrix(nodes, std::vector<std::vector<int>>{{0, 1, 2}});
  for (int i = 0; i < nodes; ++i) matrix.add(i, i, Mat3::Identity());
  const VecX x{{0, 0, 0, 1, 0, 0, 2, 0, 0}};
  EXPECT_EQ(
      mechanism(matrix, Eigen::MatrixXd(x.size(), 0), VecX(), x, std::vector<Part>{{{0, nodes}, {}, 1}}),
      std::nullopt);
  BlockMatrix nothing = matrix.blank();
  EXPECT_EQ(
      mechanism(nothing, Eigen::MatrixXd(x.size(), 0), VecX(), x, std::vector<Part>{{{0, nodes}, {}, 1}}), 0)
      << "without any stiffness at all";
}

}  // namespace
}  // namespace calot
