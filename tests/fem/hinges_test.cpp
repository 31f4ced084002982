#include "fem/hinges.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot::hinges_test {
namespace {

constexpr double rigidity = 2.7e-4;

struct Rig {
  TriMesh mesh;
  VecX rest, x;
  Hinges hinges;
};

/// A sphere's triangles, bent well away from rest: angles change by tenths of a radian.
Rig make_rig(Rng& rng) {
  TriMesh mesh = revolve(sphere_profile(20e-3), 20).value();
  const VecX rest = to_coordinates(mesh.points);
  const VecX x = rest + test::random_coordinates(rng, static_cast<int>(rest.size()), 3e-3);
  Hinges hinges = Hinges::create(mesh.triangles, rest, rigidity).value();
  return {std::move(mesh), rest, x, std::move(hinges)};
}

VecX gradient_of(const Hinges& hinges, const VecX& x) {
  VecX g = VecX::Zero(x.size());
  hinges.add_gradient(x, g);
  return g;
}

/// Rows of equilateral triangles of edge a, columns along x, each row turned by `turn` against the one
/// before it about the x axis: a polygonal cylinder.
TriMesh rolled_sheet(int columns, int rows, double a, double turn) {
  TriMesh mesh;
  const double height = 0.5 * std::sqrt(3.0) * a;
  Vec3 at = Vec3::Zero();
  double slope = 0.5 * turn;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) mesh.points.push_back(at + (i + 0.5 * (j % 2)) * a * Vec3::UnitX());
    at += height * Vec3(0, std::cos(slope), -std::sin(slope));
    slope += turn;
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int p = j * (columns + 1) + i, q = p + columns + 1;
      if (j % 2 == 0) {
        mesh.triangles.push_back({p, p + 1, q});
        mesh.triangles.push_back({p + 1, q + 1, q});
      } else {
        mesh.triangles.push_back({p, p + 1, q + 1});
        mesh.triangles.push_back({p, q + 1, q});
      }
    }
  }
  return mesh;
}

TEST(Hinges, GradientAndHessianAreTheDerivativesOfTheEnergy) {
  Rng rng(1);
  const Rig rig = make_rig(rng);
  // Edges of 1e-2 m: differences are wrong by (1e-6 / 1e-2)^2 times higher derivatives, and by rounding.
  const auto value = [&](const VecX& y) { return rig.hinges.value(y); };
  const auto gradient = [&](const VecX& y) { return gradient_of(rig.hinges, y); };
  EXPECT_GT(gradient(rig.x).norm(), 1e-3);
  EXPECT_LT(test::relative_error(gradient(rig.x), test::difference_gradient(value, rig.x, 1e-6)), 1e-6);
  const auto cliques = rig.hinges.cliques();
  BlockMatrix matrix(static_cast<int>(rig.mesh.points.size()), cliques);
  rig.hinges.add_hessian(rig.x, matrix);
  EXPECT_GT(test::stored(matrix).norm(), 0);
  EXPECT_LT(test::relative_error(test::dense(matrix), test::difference_hessian(gradient, rig.x, 1e-6)), 1e-6);
  const Eigen::MatrixXd kept = test::stored(matrix);
  for (int i = 0; i < kept.rows(); i += 3) {
    const Mat3 block = kept.block<3, 3>(i, i);
    EXPECT_LT((block - block.transpose()).norm(), 1e-12 * kept.norm());
  }
}

TEST(Hinges, RestAndRigidMotionsOfItCarryNoEnergyAndNoForce) {
  Rng rng(2);
  const Rig rig = make_rig(rng);
  const VecX there = test::moved(test::random_motion(rng, 0.1), rig.rest);
  const double scale = rig.hinges.value(rig.x);
  EXPECT_GT(scale, 0);
  EXPECT_EQ(rig.hinges.value(rig.rest), 0);
  EXPECT_LT(rig.hinges.value(there), 1e-20 * scale);  // angles are right to 1e-14 or so
  EXPECT_LT(gradient_of(rig.hinges, there).norm(), 1e-10 * gradient_of(rig.hinges, rig.x).norm());
}

TEST(Hinges, ForcesAreInBalance) {
  Rng rng(3);
  const Rig rig = make_rig(rng);
  const VecX f = gradient_of(rig.hinges, rig.x);
  EXPECT_LT(test::net_force(f).norm(), 1e-12 * f.norm());
  EXPECT_LT(test::net_torque(rig.x, f, Vec3::Zero()).norm(), 1e-12 * f.norm() * 20e-3);
}

TEST(Hinges, ARolledSheetStoresThePlatesBendingEnergy) {
  const double a = 2e-3, turn = 0.05;
  const int columns = 10, rows = 9;
  const TriMesh flat = rolled_sheet(columns, rows, a, 0), rolled = rolled_sheet(columns, rows, a, turn);
  const Hinges hinges = Hinges::create(flat.triangles, to_coordinates(flat.points), rigidity).value();
  // Between the rows' fold lines: each of `rows` - 1 inner lines bends the half rows to its two sides.
  const double height = 0.5 * std::sqrt(3.0) * a, curvature = turn / height;
  const double area = columns * a * (rows - 1) * height;
  EXPECT_NEAR(hinges.value(to_coordinates(rolled.points)), 0.5 * rigidity * curvature * curvature * area,
              1e-10 * rigidity);
}

TEST(Hinges, AngleIsThatBetweenTheNormalsToEitherSide) {
  // A flat pair opened by pi / 2: energy 1/2 k (pi / 2)^2, k = D |e|^2 / A = D for these right triangles.
  const std::vector<Triangle> triangles = {{0, 1, 2}, {1, 0, 3}};
  const auto pair = [](double angle) {
    return to_coordinates({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -std::cos(angle), -std::sin(angle)}});
  };
  const double quarter = 0.5 * std::numbers::pi;
  const Hinges convex = Hinges::create(triangles, pair(0.3), rigidity).value();
  EXPECT_NEAR(convex.value(pair(0.3 + quarter)), 0.5 * rigidity * quarter * quarter, 1e-14);
  // From 2 rad one way to 1 rad the other, through flat.
  const Hinges folded = Hinges::create(triangles, pair(2.0), rigidity).value();
  EXPECT_NEAR(folded.value(pair(-1.0)), 0.5 * rigidity * 9, 1e-14);
}

TEST(Hinges, BadEdgesAreRefused) {
  const VecX rest = to_coordinates({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {2, 0, 0}});
  const std::vector<std::vector<Triangle>> bad = {{{0, 1, 2}, {0, 1, 3}}, {{0, 1, 2}, {1, 0, 4}}};
  for (const auto& triangles : bad) {
    const Result<Hinges> hinges = Hinges::create(triangles, rest, rigidity);
    ASSERT_FALSE(hinges);
    EXPECT_EQ(hinges.failure().kind, FailureKind::scenario);
  }
}

}  // namespace
}  // namespace calot::hinges_test
