#include "skin/detail_basis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "base/rng.h"
#include "numerics/dense_cholesky.h"
#include "skin/meshes.h"

namespace calot::test {
namespace {

/// Control points of the next level by Loop's masks.
VecX subdivided(const SurfaceLevels& levels, int level, const VecX& x) {
  std::vector<std::set<int>> ring(levels.nodes(level));
  for (const Triangle& t : levels.faces(level))
    for (int k = 0; k < 3; ++k) ring[t[k]].insert({t[(k + 1) % 3], t[(k + 2) % 3]});
  const auto point = [&](int node) { return Vec3(x.segment<3>(Eigen::Index{3} * node)); };
  VecX out(3 * Eigen::Index{levels.nodes(level + 1)});
  for (int node = 0; node < levels.nodes(level); ++node) {
    const double n = static_cast<double>(ring[node].size());
    const double c = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n), beta = (0.625 - c * c) / n;
    Vec3 sum = (1 - n * beta) * point(node);
    for (int near : ring[node]) sum += beta * point(near);
    out.segment<3>(Eigen::Index{3} * node) = sum;
  }
  for (std::size_t f = 0; f < levels.faces(level).size(); ++f) {
    for (int edge = 0; edge < 3; ++edge) {
      const int node = levels.edge_node(level, static_cast<int>(f), edge);
      Vec3 sum = Vec3::Zero();
      const Triangle& t = levels.faces(level)[f];
      for (int end : {t[edge], t[(edge + 1) % 3]}) sum += 0.375 * point(end);
      for (int face : levels.faces_at_edge(level, node))
        for (int corner : levels.faces(level)[face])
          if (corner != t[edge] && corner != t[(edge + 1) % 3]) sum += 0.125 * point(corner);
      out.segment<3>(Eigen::Index{3} * node) = sum;
    }
  }
  return out;
}

std::vector<FacePoint> random_points(const SurfaceLevels& levels, int count) {
  Rng rng(11);
  std::vector<FacePoint> points;
  for (int k = 0; k < count; ++k) {
    double u = rng.uniform(0, 1), v = rng.uniform(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    points.push_back({k % static_cast<int>(levels.faces(0).size()), u, v});
  }
  return points;
}

TEST(SurfaceLevels, TheSurfaceAndItsDerivativesAreThoseOfEveryLevel) {
  for (const auto& [name, mesh] : closed_meshes()) {
    const SurfaceLevels levels = SurfaceLevels::create(mesh, 2).value();
    const std::vector<FacePoint> points = random_points(levels, 400);
    std::vector<VecX> x = {to_coordinates(mesh.points)};
    for (int level = 0; level < 2; ++level) x.push_back(subdivided(levels, level, x.back()));
    const StencilTable coarse = levels.evaluate(0, points, 2);
    for (int level : {1, 2}) {
      const StencilTable fine = levels.evaluate(level, points, 2);
      for (int r = 0; r < fine.rows(); ++r) {
        // The inexact cap of level 0 ends 1/64 of an edge from a node.
        const FacePoint& p = points[r];
        const double far =
            std::min({std::hypot(p.u, p.v), std::hypot(1 - p.u, p.v), std::hypot(p.u, 1 - p.v)});
        if (far < 0.04) continue;
        const auto apart = [&](const std::vector<double>& a, const std::vector<double>& b) {
          return (blend(coarse, a, r, x[0]) - blend(fine, b, r, x[level])).norm();
        };
        // Rounding; weights of derivatives grow by 64 and 64 squared near a node.
        EXPECT_LT(apart(coarse.value, fine.value), 1e-13) << name;
        EXPECT_LT(apart(coarse.du, fine.du), 1e-11) << name;
        EXPECT_LT(apart(coarse.dv, fine.dv), 1e-11) << name;
        EXPECT_LT(apart(coarse.duu, fine.duu), 1e-9) << name;
        EXPECT_LT(apart(coarse.duv, fine.duv), 1e-9) << name;
        EXPECT_LT(apart(coarse.dvv, fine.dvv), 1e-9) << name;
      }
    }
  }
}

std::vector<int> odd_nodes(const SurfaceLevels& levels, int level) {
  std::vector<int> out;
  for (int node = levels.nodes(level - 1); node < levels.nodes(level); ++node) out.push_back(node);
  return out;
}

std::vector<FacePoint> places_of(const SurfaceLevels& levels, int level) {
  std::vector<FacePoint> out;
  for (int node = 0; node < levels.nodes(level); ++node) out.push_back(levels.place(node));
  return out;
}

TEST(DetailBasis, CoarseFunctionsAndOddOnesAreIndependent) {
  const SurfaceLevels levels = SurfaceLevels::create(closed_meshes()[1].mesh, 2).value();
  std::vector<int> details = odd_nodes(levels, 1);
  for (int node : odd_nodes(levels, 2)) details.push_back(node);
  const DetailBasis basis(levels, details);
  const StencilTable table = basis.evaluate(places_of(levels, 2), 0);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(table.rows(), basis.nodes());
  for (int r = 0; r < table.rows(); ++r)
    for (int e = table.begin[r]; e < table.begin[r + 1]; ++e) matrix(r, table.node[e]) = table.value[e];
  ASSERT_EQ(matrix.rows(), matrix.cols());  // all functions of level 2
  // The pivots of Gram's matrix: one is zero where a function depends on those before it.
  Eigen::MatrixXd gram = matrix.transpose() * matrix;
  ASSERT_TRUE(cholesky_in_place(gram));
  const auto pivots = gram.diagonal();
  EXPECT_GT(pivots.minCoeff(), 0.02 * pivots.maxCoeff());
}

TEST(DetailBasis, FunctionsOfDetailsLieBetweenZeroAndAHalfAndVanishOutsideTheirSupport) {
  const SurfaceLevels levels = SurfaceLevels::create(closed_meshes()[2].mesh, 2).value();
  const std::vector<FacePoint> points = random_points(levels, 20 * static_cast<int>(levels.faces(0).size()));
  for (int level : {1, 2}) {
    const std::vector<int> odd = odd_nodes(levels, level);
    const StencilTable table = DetailBasis(levels, odd).evaluate(points, 1);
    std::vector<std::vector<int>> support;
    for (int node : odd) support.push_back(levels.support(level, node));
    for (int r = 0; r < table.rows(); ++r) {
      double sum = 0;
      for (int e = table.begin[r]; e < table.begin[r + 1]; ++e) {
        const int detail = table.node[e] - levels.nodes(0);
        if (detail < 0) continue;
        sum += table.value[e];
        EXPECT_GT(table.value[e], -1e-15);  // rounding
        EXPECT_LT(table.value[e], 0.5 + 1e-15);
        EXPECT_TRUE(std::binary_search(support[detail].begin(), support[detail].end(), points[r].face));
      }
      EXPECT_LT(sum, 1 + 1e-12);
      EXPECT_GT(sum, 0.4);  // odd nodes have a share everywhere: the check is not of zeros
    }
  }
}

TEST(DetailBasis, EvaluatesAFewDetailsAsItDoesAll) {
  const SurfaceLevels levels = SurfaceLevels::create(closed_meshes()[1].mesh, 2).value();
  const std::vector<FacePoint> points = random_points(levels, 500);
  std::vector<int> all = odd_nodes(levels, 1), few;
  for (int node : odd_nodes(levels, 2)) all.push_back(node);
  for (std::size_t i = 0; i < all.size(); i += 17) few.push_back(all[i]);
  const DetailBasis every(levels, all), some(levels, few);
  const StencilTable a = every.evaluate(points, 2), b = some.evaluate(points, 2);
  std::map<std::pair<int, int>, double> second;
  for (int r = 0; r < a.rows(); ++r)
    for (int e = a.begin[r]; e < a.begin[r + 1]; ++e) second[{r, a.node[e]}] = a.duv[e];
  int checked = 0;
  for (int r = 0; r < b.rows(); ++r) {
    for (int e = b.begin[r]; e < b.begin[r + 1]; ++e) {
      int column = b.node[e];
      if (const int detail = column - levels.nodes(0); detail >= 0) {
        const auto found = std::find(all.begin(), all.end(), few[detail]);
        column = levels.nodes(0) + static_cast<int>(found - all.begin());
        ++checked;
      }
      EXPECT_EQ(b.duv[e], (second[{r, column}]));
    }
  }
  EXPECT_GT(checked, 100);
}

/// Directed edges of triangles that have no opposite one.
std::size_t open_edges(const std::vector<Triangle>& triangles) {
  std::map<std::pair<int, int>, int> count;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      count[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  return static_cast<std::size_t>(
      std::count_if(count.begin(), count.end(), [](const auto& c) { return c.second != 0; }));
}

/// Up to 20 details of levels 1 to 3.
std::vector<int> random_details(const SurfaceLevels& levels, int count, Rng& rng) {
  std::set<int> details;
  for (int k = 0; k < count; ++k) {
    const int level = 1 + static_cast<int>(rng.uniform(0, 2.999));
    const std::vector<int> odd = odd_nodes(levels, level);
    details.insert(odd[static_cast<std::size_t>(rng.uniform(0, 0.999) * static_cast<double>(odd.size()))]);
  }
  return {details.begin(), details.end()};
}

void expect_no_cracks(const SurfaceLevels& levels, const FaceTree& tree) {
  double area = 0;
  std::vector<Triangle> fine, coarse;
  for (const FaceTree::Leaf& leaf : tree.leaves) {
    area += std::ldexp(1.0, -2 * leaf.level);
    for (const Triangle& t : cover(levels, leaf, true)) fine.push_back(t);
    for (const Triangle& t : cover(levels, leaf, false)) coarse.push_back(t);
  }
  EXPECT_EQ(area, static_cast<double>(levels.faces(0).size()));
  EXPECT_EQ(open_edges(fine), 0u);
  EXPECT_EQ(open_edges(coarse), 0u);
}

TEST(FaceTree, ItsLeavesCoverTheSurfaceWithoutCracks) {
  const SurfaceLevels levels = SurfaceLevels::create(closed_meshes()[1].mesh, 3).value();
  Rng rng(3);
  for (int round = 0; round < 20; ++round) {
    const std::vector<int> details = random_details(levels, 1 + round, rng);
    const FaceTree tree(levels, details);
    expect_no_cracks(levels, tree);
    EXPECT_GT(tree.leaves.size(), levels.faces(0).size());
    for (int detail : details) {
      // Both faces at a detail's edge are split.
      const int level = levels.level_of(detail) - 1;
      for (int face : levels.faces_at_edge(level, detail))
        for (const FaceTree::Leaf& leaf : tree.leaves) EXPECT_FALSE(leaf.level == level && leaf.face == face);
    }
  }
}

TEST(FaceTree, OneSplitLessMakesParentsOfAllTheirLeaves) {
  const SurfaceLevels levels = SurfaceLevels::create(closed_meshes()[1].mesh, 3).value();
  Rng rng(4);
  for (int round = 0; round < 20; ++round) {
    const std::vector<int> details = random_details(levels, 1 + round, rng);
    const FaceTree whole(levels, details), merged(levels, details, true);
    expect_no_cracks(levels, merged);
    EXPECT_LT(merged.leaves.size(), whole.leaves.size());
    std::set<std::pair<int, int>> leaves;
    for (const FaceTree::Leaf& leaf : whole.leaves) leaves.insert({leaf.level, leaf.face});
    for (const FaceTree::Leaf& leaf : merged.leaves) {
      if (leaves.count({leaf.level, leaf.face}) > 0) continue;
      for (int child = 4 * leaf.face; child < 4 * leaf.face + 4; ++child)
        EXPECT_EQ(leaves.count({leaf.level + 1, child}), 1u);
    }
  }
}

}  // namespace
}  // namespace calot::test
