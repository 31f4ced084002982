#include "fem/point_mass.h"

#include <gtest/gtest.h>

#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace {

struct PointBody {
  StencilTable table;
  VecX rest;
  PointMass mass;
  BlockMatrix matrix;
};

PointBody point_body() {
  const TriMesh mesh = test::pear(20);
  const LoopSurface surface = LoopSurface::create(mesh).value();
  StencilTable table = surface.evaluate(test::at_all_faces(surface.faces(), {{0.2, 0.3}, {0.5, 0.1}}), 0);
  PointMass mass;
  for (int r = 0; r < table.rows(); ++r) mass.mass.push_back(1e-4 * (1 + r % 3));
  std::vector<std::vector<int>> cliques;
  for (int r = 0; r < table.rows(); ++r)
    cliques.emplace_back(table.node.begin() + table.begin[r], table.node.begin() + table.begin[r + 1]);
  BlockMatrix matrix(surface.nodes(), cliques);
  return {std::move(table), to_coordinates(mesh.points), std::move(mass), std::move(matrix)};
}

TEST(PointMass, AStepsEnergyHasTheseDerivatives) {
  PointBody b = point_body();
  Rng rng(1);
  const int n = static_cast<int>(b.rest.size());
  const VecX x = b.rest + test::random_coordinates(rng, n, 2e-3),
             predicted = b.rest + test::random_coordinates(rng, n, 2e-3);
  const double h = 0.02;
  const auto energy = [&](const VecX& y) { return b.mass.energy(b.table, (y - predicted) / h); };
  double expected = 0;
  for (int r = 0; r < b.table.rows(); ++r) {
    const Vec3 off = blend(b.table, b.table.value, r, x) - blend(b.table, b.table.value, r, predicted);
    expected += 0.5 * b.mass.mass[r] * off.squaredNorm() / (h * h);
  }
  EXPECT_NEAR(energy(x), expected, 1e-12 * expected);
  VecX gradient = VecX::Zero(n);
  b.mass.add_product(b.table, x - predicted, 1 / (h * h), gradient);
  // Quadratic: differences are off by rounding alone.
  EXPECT_LT(test::relative_error(gradient, test::difference_gradient(energy, x, 1e-4)), 1e-9);
  b.matrix.set_zero();
  b.mass.add_hessian(b.table, 1 / (h * h), b.matrix);
  const auto slope = [&](const VecX& y) {
    VecX out = VecX::Zero(n);
    b.mass.add_product(b.table, y - predicted, 1 / (h * h), out);
    return out;
  };
  EXPECT_LT(test::relative_error(test::dense(b.matrix), test::difference_hessian(slope, x, 1e-3)), 1e-9);
}

TEST(PointMass, ARigidBodysMomentaAreItsMassTimesItsCentresVelocityAndItsSpin) {
  const PointBody b = point_body();
  double total = 0;
  Vec3 centre = Vec3::Zero();
  Mat3 about_origin = Mat3::Zero();
  for (int r = 0; r < b.table.rows(); ++r) {
    const Vec3 p = blend(b.table, b.table.value, r, b.rest);
    const double m = b.mass.mass[r];
    total += m;
    centre += m * p;
    about_origin += m * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
  }
  centre /= total;
  EXPECT_NEAR(b.mass.total(), total, 1e-14);
  const Vec3 speed(0.3, -0.2, 0.5), spin(2, 1, -3);
  VecX velocity(b.rest.size());
  for (Eigen::Index i = 0; i < velocity.size(); i += 3)
    velocity.segment<3>(i) = speed + spin.cross(Vec3(b.rest.segment<3>(i)));
  const Vec3 momentum = total * (speed + spin.cross(centre));
  const Vec3 angular = total * centre.cross(speed) + about_origin * spin;
  EXPECT_LT((b.mass.momentum(b.table, velocity) - momentum).norm(), 1e-13 * momentum.norm());
  EXPECT_LT((b.mass.angular_momentum(b.table, b.rest, velocity) - angular).norm(), 1e-13 * angular.norm());
  const double energy = 0.5 * (speed.dot(momentum) + spin.dot(angular));
  EXPECT_NEAR(b.mass.energy(b.table, velocity), energy, 1e-12 * energy);
}

TEST(PointMass, ItsWeightPullsAtItsCentre) {
  const PointBody b = point_body();
  const Vec3 gravity(1, -2, -9);
  VecX load = VecX::Zero(b.rest.size());
  b.mass.add_weight(b.table, gravity, load);
  EXPECT_LT((test::net_force(load) - b.mass.total() * gravity).norm(), 1e-13);
  // Work of a small shift of some nodes: minus the change of the masses' height.
  Rng rng(2);
  const VecX shift = test::random_coordinates(rng, static_cast<int>(b.rest.size()), 1e-3);
  EXPECT_NEAR(load.dot(shift), gravity.dot(b.mass.momentum(b.table, shift)), 1e-16);
}

}  // namespace
}  // namespace calot
