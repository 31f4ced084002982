#include "fem/links.h"

#include <gtest/gtest.h>

#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace {

struct Rig {
  StencilTable table;
  VecX x;
  Links links;
  BlockMatrix matrix;
};

Rig make_rig(Rng& rng) {
  test::SkinOfSphere skin(rng);
  Links links;
  links.row = {0, 5, 20, 41};
  for (int row : links.row) {
    links.target.push_back(skin.point(row) + test::random_vector(rng, 3e-3));
    links.stiffness.push_back(rng.uniform(100, 1000));
  }
  BlockMatrix matrix = skin.matrix(links.row);
  return {std::move(skin.table), skin.x, links, std::move(matrix)};
}

VecX gradient_of(const Rig& rig, const VecX& x) {
  VecX g = VecX::Zero(x.size());
  rig.links.add_gradient(rig.table, x, g);
  return g;
}

TEST(Links, GradientAndHessianAreTheDerivativesOfTheEnergy) {
  Rng rng(1);
  Rig rig = make_rig(rng);
  // Quadratic: central differences are exact but for rounding / h.
  const auto value = [&](const VecX& y) { return rig.links.value(rig.table, y); };
  EXPECT_LT(test::relative_error(gradient_of(rig, rig.x), test::difference_gradient(value, rig.x, 1e-5)),
            1e-9);
  rig.links.add_hessian(rig.table, rig.matrix);
  const auto gradient = [&](const VecX& y) { return gradient_of(rig, y); };
  EXPECT_LT(test::relative_error(test::dense(rig.matrix), test::difference_hessian(gradient, rig.x, 1e-5)),
            1e-9);
  EXPECT_GT(test::stored(rig.matrix).norm(), 0);
}

TEST(Links, PullWithTheSpringsForceAtTheSurfacePoint) {
  Rng rng(2);
  const Rig rig = make_rig(rng);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  for (std::size_t i = 0; i < rig.links.row.size(); ++i) {
    const Vec3 at = blend(rig.table, rig.table.value, rig.links.row[i], rig.x);
    const Vec3 pull = rig.links.stiffness[i] * (at - rig.links.target[i]);
    force += pull;
    torque += at.cross(pull);
  }
  // Weights of a row sum to 1 and reproduce the point, so force and torque pass to the nodes unchanged.
  const VecX g = gradient_of(rig, rig.x);
  EXPECT_LT((test::net_force(g) - force).norm(), 1e-13 * force.norm());
  EXPECT_LT((test::net_torque(rig.x, g, Vec3::Zero()) - torque).norm(), 1e-12 * torque.norm());
}

TEST(Links, RigidMotionOfBodyAndTargetsChangesNoEnergyAndTurnsTheForces) {
  Rng rng(3);
  const Rig rig = make_rig(rng);
  const Pose motion = test::random_motion(rng, 0.1);
  Rig there = rig;
  for (Vec3& target : there.links.target) target = motion * target;
  there.x = test::moved(motion, rig.x);
  const double energy = rig.links.value(rig.table, rig.x);
  EXPECT_GT(energy, 0);
  EXPECT_NEAR(there.links.value(there.table, there.x), energy, 1e-11 * energy);
  EXPECT_LT(test::relative_error(gradient_of(there, there.x),
                                 test::turned(motion.linear(), gradient_of(rig, rig.x))),
            1e-11);
}

TEST(PointHessian, GoesToTheNodesByTheProductOfWeights) {
  Rng rng(4);
  Rig rig = make_rig(rng);
  Mat3 h = Mat3::Random();
  h = (h + h.transpose()).eval();
  const int row = 20;
  rig.matrix.set_zero();
  add_point_hessian(rig.table, row, h, rig.matrix);
  const VecX d = test::random_coordinates(rng, static_cast<int>(rig.x.size()), 1.0);
  const Vec3 at = blend(rig.table, rig.table.value, row, d);
  EXPECT_NEAR(d.dot(rig.matrix.multiply(d)), at.dot(h * at), 1e-12);
}

}  // namespace
}  // namespace calot
