#include <gtest/gtest.h>

#include <cmath>

#include "fem/shell.h"

namespace calot {
namespace {

/// Integral of u^i v^j over the unit triangle: i! j! / (i + j + 2)!.
double exact(int i, int j) { return std::tgamma(i + 1) * std::tgamma(j + 1) / std::tgamma(i + j + 3); }

double by_rule(const std::vector<QuadraturePoint>& rule, int i, int j) {
  double sum = 0;
  for (const QuadraturePoint& q : rule) sum += q.weight * std::pow(q.u, i) * std::pow(q.v, j);
  return sum;
}

double worst_of_degree(const std::vector<QuadraturePoint>& rule, int degree) {
  double worst = 0;
  for (int i = 0; i <= degree; ++i)
    worst = std::max(worst, std::abs(by_rule(rule, i, degree - i) - exact(i, degree - i)));
  return worst;
}

TEST(Quadrature, RulesAreExactToTheirDegree) {
  // Dunavant's points are given with 15 digits.
  for (int degree = 0; degree <= 2; ++degree) EXPECT_LT(worst_of_degree(three_point_rule(), degree), 1e-15);
  for (int degree = 0; degree <= 4; ++degree) EXPECT_LT(worst_of_degree(six_point_rule(), degree), 1e-14);
}

TEST(Quadrature, RulesTreatTheCornersOfAFaceAlike) {
  for (const auto& rule : {three_point_rule(), six_point_rule()})
    for (const QuadraturePoint& q : rule) {
      const double w = 1 - q.u - q.v;
      EXPECT_GT(w, 0);
      const bool turned = std::any_of(rule.begin(), rule.end(), [&](const QuadraturePoint& p) {
        return std::abs(p.u - q.v) + std::abs(p.v - w) + std::abs(p.weight - q.weight) < 1e-14;
      });
      EXPECT_TRUE(turned);
    }
}

}  // namespace
}  // namespace calot
