#include "fem/potential_flow.h"

#include <gtest/gtest.h>

#include <numbers>

#include "numerics/dense_cholesky.h"
#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace {

constexpr double radius = 20e-3;

struct Surface {
  Tessellation skin;
  VecX x;

  explicit Surface(const TriMesh& mesh)
      : skin(LoopSurface::create(mesh).value().tessellate(4)), x(to_coordinates(mesh.points)) {}
  FlowModes modes() const { return FlowModes::inside(skin.stencils, skin.triangles, x, radius).value(); }
};

VecX motion_of(const VecX& x, const std::function<Vec3(const Vec3&)>& velocity) {
  VecX out(x.size());
  for (Eigen::Index i = 0; i < x.size(); i += 3) out.segment<3>(i) = velocity(x.segment<3>(i));
  return out;
}

/// Of a motion, kg/m^3 apart.
double energy(const FlowModes& modes, const VecX& motion) {
  return 0.5 * (modes.columns.transpose() * motion).squaredNorm();
}

TEST(FlowModes, AHarmonicInASphereHasItsMassOverItsDegree) {
  const Surface sphere(test::sphere(238));
  const FlowModes modes = sphere.modes();
  // Potential flow in a sphere (Lamb, Hydrodynamics, art. 262): 1/2 R / n times the integral of q^2 for a normal
  // velocity q that is a harmonic of degree n.
  const double area = 4 * std::numbers::pi * radius * radius;
  const auto normal = [&](const std::function<double(const Vec3&)>& speed) {
    const LoopSurface surface = LoopSurface::create(test::sphere(238)).value();
    const StencilTable vertices = surface.tessellate(1).stencils;
    std::vector<Vec3> velocity;
    for (const Vec3& at : blend_all(vertices, vertices.value, sphere.x))
      velocity.push_back(speed(at.normalized()) * at.normalized());
    return to_coordinates(fit_to_limit(surface, velocity).value());
  };
  const auto per_degree = [&](int degree, double mean_square) {
    return 0.5 * radius / degree * area * mean_square;
  };
  const double one = energy(modes, normal([](const Vec3& n) { return n.z(); }));
  const double two = energy(modes, normal([](const Vec3& n) { return 3 * n.z() * n.z() - 1; }));
  const double three = energy(modes, normal([](const Vec3& n) { return n.z() * (5 * n.z() * n.z() - 3); }));
  // Mean squares over the sphere: 1/3, 4/5, 4/7; a harmonic of degree 1 moves the centroid alone. A surface that
  // interpolates a harmonic at 238 vertices is off between them.
  EXPECT_LT(one / per_degree(1, 1.0 / 3), 1e-4);
  EXPECT_NEAR(two / per_degree(2, 4.0 / 5), 1, 3e-3);
  EXPECT_NEAR(three / per_degree(3, 4.0 / 7), 1, 5e-3);
}

TEST(FlowModes, ATranslationHasNoneAndASpinningSphereNextToNone) {
  for (const TriMesh& mesh : {test::sphere(61), test::pear(61)}) {
    const Surface surface(mesh);
    const FlowModes modes = surface.modes();
    const double some =
        energy(modes, motion_of(surface.x, [](const Vec3& p) { return Vec3(p.x(), 0, -p.z()); }));
    for (int axis = 0; axis < 3; ++axis) {
      const VecX shift = motion_of(surface.x, [&](const Vec3&) { return Vec3(radius * Vec3::Unit(axis)); });
      EXPECT_LT(energy(modes, shift), 1e-20 * some) << "rounding, squared";
    }
  }
  const Surface sphere(test::sphere(61));
  const FlowModes modes = sphere.modes();
  const double bulk =
      0.5 * 4.0 / 3 * std::numbers::pi * std::pow(radius, 5);  // as fast as the sphere's equator
  const VecX spin = motion_of(sphere.x, [](const Vec3& p) { return Vec3(0.6, 0, 0.8).cross(p); });
  EXPECT_LT(energy(modes, spin), 1e-6 * bulk) << "61 nodes are no sphere";
}

TEST(FlowModes, WithTheCentroidsItIsTheWholeFlowsEnergy) {
  // Motions that keep the volume: the flow of one that does not is not defined.
  const Surface pear(test::pear(61));
  const PotentialFlow whole = PotentialFlow::inside(pear.skin.stencils, pear.skin.triangles, pear.x, radius);
  Eigen::MatrixXd factor = whole.energy();
  ASSERT_TRUE(cholesky_in_place(factor));
  const FlowModes modes = pear.modes();
  const Mat3 bulk = whole.energy().topLeftCorner<3, 3>();
  Rng rng(3);
  for (int trial = 0; trial < 5; ++trial) {
    const Vec3 shift = test::random_vector(rng, radius), twist = test::random_vector(rng, 1);
    const VecX motion = motion_of(pear.x, [&](const Vec3& p) {
      return Vec3(shift + twist.cross(p) + Vec3(p.y(), 2 * p.x(), 0) + Vec3(p.x(), p.y(), -2 * p.z()));
    });
    const VecX b = whole.flow.transpose() * motion;
    const Vec3 of_centroid = b.head<3>();
    const double both = energy(modes, motion) + 0.5 * of_centroid.dot(bulk.inverse() * of_centroid);
    const double all = 0.5 * b.dot(cholesky_solve(factor, b));
    EXPECT_NEAR(both, all, 1e-3 * all) << "A is symmetric but for the triangles";
    EXPECT_GT(energy(modes, motion), 1e-2 * all);
  }
}

}  // namespace
}  // namespace calot
