// Moments of solids: closed forms against meshes and against sums over slices.

#include "geometry/solid_moments.h"

#include <gtest/gtest.h>

#include <numbers>

#include "geometry/shapes.h"
#include "support/random.h"

namespace calot {
namespace {

using std::numbers::pi;

/// Largest difference, each moment relative to its own scale.
double misfit(const SolidMoments& actual, const SolidMoments& expected) {
  const double width = std::sqrt(expected.second.trace() / expected.volume);
  return std::max({std::abs(actual.volume / expected.volume - 1),
                   (actual.centroid - expected.centroid).norm() / width,
                   (actual.second - expected.second).norm() / expected.second.norm()});
}

Pose somewhere(Rng& rng) {
  const Vec3 axis = test::random_vector(rng, 1.0).normalized();
  return Eigen::Translation3d(test::random_vector(rng, 0.1)) *
         Eigen::AngleAxisd(rng.uniform(-3.0, 3.0), axis);
}

TriMesh moved_mesh(TriMesh mesh, const Pose& motion) {
  for (Vec3& p : mesh.points) p = motion * p;
  return mesh;
}

TriMesh box_mesh(const Vec3& half) {
  TriMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.points.push_back(half.cwiseProduct(Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
  const auto face = [&](int a, int b, int c, int d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  face(0, 2, 3, 1);
  face(4, 5, 7, 6);
  face(0, 1, 5, 4);
  face(2, 6, 7, 3);
  face(0, 4, 6, 2);
  face(1, 3, 7, 5);
  return mesh;
}

TEST(SolidMoments, AMeshedBoxHasTheBoxsMomentsWhereverItIs) {
  Rng rng(1);
  const Vec3 half(5e-3, 2e-3, 1e-3);
  const TriMesh mesh = box_mesh(half);
  ASSERT_TRUE(check(mesh).empty());
  for (int trial = 0; trial < 10; ++trial) {
    const Pose motion = somewhere(rng);
    // Rounding of places 0.1 m off, 1e-17 m, against 1e-3 m.
    EXPECT_LT(misfit(mesh_moments(moved_mesh(mesh, motion)), moved(box_moments(half), motion)), 1e-12);
  }
}

TEST(SolidMoments, ATetrahedronHasItsClosedForm) {
  const TriMesh corner{{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()},
                       {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const SolidMoments solid = mesh_moments(corner);
  EXPECT_NEAR(solid.volume, 1.0 / 6, 1e-15);
  EXPECT_LT((solid.centroid - Vec3::Constant(0.25)).norm(), 1e-15);
  // Integral of x^2 is 1/60, of x y 1/120; less volume / 16.
  EXPECT_NEAR(solid.second(0, 0), 1.0 / 60 - 1.0 / 96, 1e-15);
  EXPECT_NEAR(solid.second(0, 1), 1.0 / 120 - 1.0 / 96, 1e-15);
}

TEST(SolidMoments, AMeshedSphereTendsToTheBallsMoments) {
  std::vector<double> errors;
  for (int nodes : {100, 400})
    errors.push_back(
        misfit(mesh_moments(revolve(sphere_profile(7e-3), nodes).value()), ball_moments(Vec3::Zero(), 7e-3)));
  EXPECT_LT(errors[1], 0.05);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.5) << "of second order in the spacing";
}

/// A solid of revolution along z by slices of height h, each a disc.
template <class Radius>
SolidMoments by_slices(const Radius& radius, double from, double to) {
  constexpr int slices = 20000;
  SolidMoments out;
  const double h = (to - from) / slices;
  for (int k = 0; k < slices; ++k) {
    const double z = from + (k + 0.5) * h, r = radius(z);
    if (r > 0) out = joined(out, cylinder_moments({0, 0, z - h / 2}, {0, 0, z + h / 2}, r));
  }
  return out;
}

TEST(SolidMoments, CylinderAndCapsuleHaveTheMomentsOfTheirSlices) {
  Rng rng(2);
  const double radius = 2e-3, half = 4e-3;
  const SolidMoments slices = by_slices(
      [&](double z) {
        const double beyond = std::max(0.0, std::abs(z) - half);
        return std::sqrt(std::max(0.0, radius * radius - beyond * beyond));
      },
      -half - radius, half + radius);
  const SolidMoments discs = by_slices([&](double) { return radius; }, -half, half);
  for (int trial = 0; trial < 5; ++trial) {
    const Pose motion = somewhere(rng);
    const Vec3 a = motion * Vec3(0, 0, -half), b = motion * Vec3(0, 0, half);
    // The midpoint rule: the square of a slice's height.
    EXPECT_LT(misfit(capsule_moments(a, b, radius), moved(slices, motion)), 1e-7);
    EXPECT_LT(misfit(cylinder_moments(a, b, radius), moved(discs, motion)), 1e-10);
  }
  const Vec3 at(0.01, 0.02, 0.03);
  EXPECT_LT(misfit(capsule_moments(at, at, radius), ball_moments(at, radius)), 1e-15);
}

TEST(SolidMoments, TwoHalvesOfABoxAreTheBox) {
  const Vec3 half(1e-3, 2e-3, 3e-3), cut(0.25e-3, 2e-3, 3e-3), rest(0.75e-3, 2e-3, 3e-3);
  const auto at = [](double x) { return Pose(Eigen::Translation3d(x, 0, 0)); };
  const SolidMoments both =
      joined(moved(box_moments(cut), at(-0.75e-3)), moved(box_moments(rest), at(0.25e-3)));
  EXPECT_LT(misfit(both, box_moments(half)), 1e-14);
}

}  // namespace
}  // namespace calot
