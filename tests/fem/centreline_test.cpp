#include "fem/centreline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace calot {
namespace {

Centreline line_of(int nodes) { return Centreline::create(nodes).value(); }

/// Coordinates (u, u^2, u^3) of the control nodes that make the line just that: products of a node's three inner knots,
/// averaged over the choices of them (Marsden's identity).
VecX powers(const Centreline& line) {
  std::vector<Vec3> nodes;
  for (int i = 0; i < line.nodes(); ++i) {
    const double a = std::clamp(i - 2, 0, line.spans()), b = std::clamp(i - 1, 0, line.spans()),
                 c = std::clamp(i, 0, line.spans());
    nodes.emplace_back((a + b + c) / 3, (a * b + b * c + c * a) / 3, a * b * c);
  }
  return to_coordinates(nodes);
}

TEST(Centreline, EveryCubicIsALineOfItWithItsDerivatives) {
  for (int nodes : {5, 6, 9}) {
    const Centreline line = line_of(nodes);
    const VecX x = powers(line);
    std::vector<double> at;
    for (int k = 0; k <= 20; ++k) at.push_back(k / 20.0 * line.spans());
    const StencilTable table = line.stencils(at);
    for (int row = 0; row < table.rows(); ++row) {
      const double u = at[row], close = 1e-13 * std::pow(line.spans(), 3);  // rounding
      EXPECT_LT((blend(table, table.value, row, x) - Vec3(u, u * u, u * u * u)).norm(), close);
      EXPECT_LT((blend(table, table.du, row, x) - Vec3(1, 2 * u, 3 * u * u)).norm(), close);
      EXPECT_LT((blend(table, table.duu, row, x) - Vec3(0, 2, 6 * u)).norm(), close);
      EXPECT_TRUE(
          std::is_sorted(table.node.begin() + table.begin[row], table.node.begin() + table.begin[row + 1]));
    }
  }
}

TEST(Centreline, ItsSecondDerivativeIsContinuousForAnyNodes) {
  const Centreline line = line_of(8);
  const double e = 1e-9;
  for (int knot = 1; knot < line.spans(); ++knot) {
    const StencilTable table = line.stencils({knot - e, knot + e});
    for (int node = 0; node < line.nodes(); ++node) {
      VecX x = VecX::Zero(3 * line.nodes());
      x[3 * node] = 1;
      const double before = blend(table, table.duu, 0, x).x(), after = blend(table, table.duu, 1, x).x();
      EXPECT_NEAR(before, after, 30 * e) << "third derivatives are below 10";
    }
  }
}

TEST(Centreline, APartIsTheSameCurveAndSoIsAPartOfThat) {
  const Centreline line = line_of(9);
  VecX x(3 * line.nodes());
  for (int i = 0; i < x.size(); ++i) x[i] = std::sin(1.7 * i * i);  // any nodes
  const auto expect_same = [&](const Centreline& part, const VecX& nodes) {
    ASSERT_EQ(nodes.size(), 3 * part.nodes());
    std::vector<double> at;
    for (int k = 0; k <= 30; ++k) at.push_back(part.from() + k / 30.0 * (part.to() - part.from()));
    const StencilTable of_line = line.stencils(at), of_part = part.stencils(at);
    for (int row = 0; row < of_line.rows(); ++row)
      for (const auto& [weights, other] : {std::pair{&of_line.value, &of_part.value},
                                           {&of_line.du, &of_part.du},
                                           {&of_line.duu, &of_part.duu}})
        EXPECT_LT((blend(of_line, *weights, row, x) - blend(of_part, *other, row, nodes)).norm(), 1e-11);
  };
  for (const auto& [from, to] : {std::pair{0.0, 2.4}, {2.4, 6.0}, {1.3, 4.0}, {3.2, 3.7}, {0.0, 1.0}}) {
    const Centreline part = line.part(from, to);
    EXPECT_GE(part.nodes(), Centreline::least_nodes);
    const VecX nodes = line.in_part(part, x);
    expect_same(part, nodes);
    const Centreline half = part.part(from, 0.5 * (from + to));
    expect_same(half, part.in_part(half, nodes));
  }
}

TEST(Centreline, QuadratureIsExactToDegreeThree) {
  const Centreline line = line_of(7);
  const RodQuadrature quadrature = line.quadrature();
  const VecX x = powers(line);
  Vec3 sum = Vec3::Zero();
  double length = 0;
  for (int row = 0; row < quadrature.stencils.rows(); ++row) {
    sum += quadrature.weights[row] * blend(quadrature.stencils, quadrature.stencils.value, row, x);
    length += quadrature.weights[row];
    EXPECT_NEAR(blend(quadrature.stencils, quadrature.stencils.value, row, x).x(),
                quadrature.shares[row] * line.spans(), 1e-14 * line.spans());
  }
  const double n = line.spans();
  EXPECT_NEAR(length, n, 1e-14 * n);
  EXPECT_LT((sum - Vec3(n * n / 2, n * n * n / 3, n * n * n * n / 4)).norm(), 1e-13 * n * n * n * n);
}

TEST(Centreline, AStraightPolylineGivesEqualSpansWhereverItsPointsLie) {
  const Vec3 from(0.1, -0.2, 0.3), to(0.4, 0.2, -0.1);
  const Centreline line = line_of(9);
  const VecX x = line.along({from, from, from + 0.3 * (to - from), to}).value();
  const StencilTable table = line.stencils({0, 0.7, 2.5, 6});
  const Vec3 speed = (to - from) / line.spans();
  for (int row = 0; row < table.rows(); ++row)
    EXPECT_LT((blend(table, table.du, row, x) - speed).norm(), 1e-15);
  EXPECT_EQ(blend(table, table.value, 0, x), from);
  EXPECT_LT((blend(table, table.value, 3, x) - to).norm(), 1e-16);
}

TEST(Centreline, ABendIsCutByASixthOfTheSpanSquaredTimesItsCurvature) {
  const double radius = 0.02;
  std::vector<Vec3> arc;
  for (int k = 0; k <= 4000; ++k) {
    const double angle = 2.0 * k / 4000;
    arc.push_back(radius * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  for (int spans : {8, 16}) {
    const Centreline line = line_of(spans + 3);
    const StencilTable middle = line.stencils({spans / 2.0});
    const double cut = radius - blend(middle, middle.value, 0, line.along(arc).value()).norm();
    const double h = 2 * radius / spans;
    EXPECT_NEAR(cut, h * h / 6 / radius, 0.02 * cut)
        << "the next term is (h / radius)^2 of it, at most 0.06, over 12";
  }
}

TEST(Centreline, TooFewNodesAndLinesWithoutLengthAreRefused) {
  EXPECT_EQ(Centreline::create(4).failure().kind, FailureKind::scenario);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::vector<Vec3>> bad = {
      {}, {Vec3::Ones()}, {Vec3::Ones(), Vec3::Ones()}, {Vec3::Zero(), Vec3(nan, 0, 0), Vec3::Ones()}};
  for (const auto& polyline : bad) {
    const Result<VecX> nodes = line_of(6).along(polyline);
    ASSERT_FALSE(nodes);
    EXPECT_EQ(nodes.failure().kind, FailureKind::scenario);
    EXPECT_FALSE(nodes.failure().problems[0].hint.empty());
  }
}

}  // namespace
}  // namespace calot
