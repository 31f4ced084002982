#include "fem/capsule_net.h"

#include <gtest/gtest.h>

#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace {

/// The skin of a sphere, drawn out by up to 1.6 and shaken.
struct Rig {
  Tessellation skin;
  VecX rest, x;
  CapsuleNet net;
  BlockMatrix matrix{0, {}};
};

Rig make_rig(Rng& rng) {
  const TriMesh mesh = test::sphere(14);
  const LoopSurface surface = LoopSurface::create(mesh).value();
  Rig rig;
  rig.skin = surface.tessellate(2);
  rig.rest = to_coordinates(mesh.points);
  rig.net = CapsuleNet(rig.skin, rig.rest, {1500, 1.25, 0.1});
  rig.x = rig.rest;
  for (Eigen::Index i = 2; i < rig.x.size(); i += 3) rig.x[i] *= 1.6;
  rig.x += test::random_coordinates(rng, static_cast<int>(rig.x.size()), 1e-3);
  std::vector<int> all;
  for (int node = 0; node < surface.nodes(); ++node) all.push_back(node);
  rig.matrix = BlockMatrix(surface.nodes(), std::vector<std::vector<int>>{all});
  return rig;
}

VecX gradient_of(const Rig& rig, const VecX& x) {
  VecX g = VecX::Zero(x.size());
  rig.net.add_gradient(x, g);
  return g;
}

TEST(CapsuleNet, GradientAndHessianAreTheDerivativesOfTheEnergy) {
  Rng rng(1);
  Rig rig = make_rig(rng);
  const auto value = [&](const VecX& y) { return rig.net.value(y); };
  const auto gradient = [&](const VecX& y) { return gradient_of(rig, y); };
  // Central differences of a law whose tension has a kink in its slope: to some h by its size.
  EXPECT_LT(test::relative_error(gradient(rig.x), test::difference_gradient(value, rig.x, 1e-6)), 1e-6);
  rig.net.add_hessian(rig.x, rig.matrix);
  EXPECT_LT(test::relative_error(test::dense(rig.matrix), test::difference_hessian(gradient, rig.x, 1e-7)),
            1e-4);
  EXPECT_GT(test::stored(rig.matrix).norm(), 0);
  EXPECT_GT(gradient(rig.x).norm(), 0.1) << "N";
}

TEST(CapsuleNet, IsSlackUntilItIsStretched) {
  Rng rng(2);
  const Rig rig = make_rig(rng);
  for (double stretch : {0.5, 1.0, 1.24}) {
    EXPECT_EQ(rig.net.value(stretch * rig.rest), 0);
    EXPECT_EQ(gradient_of(rig, stretch * rig.rest).norm(), 0);
  }
  EXPECT_GT(rig.net.value(1.3 * rig.rest), 0);
}

TEST(CapsuleNet, ASphereOfItBlownUpHoldsByLaplacesLaw) {
  // All cords stretched alike carry an isotropic tension T a width, whose work is that of a pressure 2 T / r.
  const TriMesh mesh = test::sphere(60);
  const LoopSurface surface = LoopSurface::create(mesh).value();
  const Tessellation skin = surface.tessellate(2);
  const VecX rest = to_coordinates(mesh.points);
  const CapsuleNet net(skin, rest, {1500, 1.25, 0.1});
  constexpr double stretch = 1.45, h = 1e-6;
  const double slope = (net.value((stretch + h) * rest) - net.value((stretch - h) * rest)) / (2 * h);
  double area = 0;
  const std::vector<Vec3> points = blend_all(skin.stencils, skin.stencils.value, rest);
  for (double of_triangle : areas_of(points, skin.triangles)) area += of_triangle;
  // A membrane of modulus E and Poisson's ratio 1/3 bears E / (1 - 1/3) of a strain alike in all directions: the cords'
  // tension by 3/2. Its work by the stretch is twice that by the area at rest.
  EXPECT_NEAR(slope, 2 * 1.5 * net.material.tension(stretch) * area, 1e-3 * slope);
  EXPECT_NEAR(net.material.tension(stretch), 1500 * (stretch - 1.3), 1e-9) << "N/m";
}

TEST(CapsuleNet, RigidMotionChangesNoEnergyAndTurnsTheForces) {
  Rng rng(3);
  const Rig rig = make_rig(rng);
  const Pose motion = test::random_motion(rng, 0.1);
  const VecX there = test::moved(motion, rig.x);
  const double energy = rig.net.value(rig.x);
  EXPECT_NEAR(rig.net.value(there), energy, 1e-11 * energy);
  const VecX here = gradient_of(rig, rig.x);
  EXPECT_LT(test::relative_error(gradient_of(rig, there), test::turned(motion.linear(), here)), 1e-11);
  EXPECT_LT(test::net_force(here).norm(), 1e-12 * here.lpNorm<1>());
}

}  // namespace
}  // namespace calot
