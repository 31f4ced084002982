// Rods whose radius is a list along them: laws of truncated cones.

#include <gtest/gtest.h>

#include <numbers>

#include "group_rig.h"

namespace calot {
namespace {

using std::numbers::pi;

/// Wide, narrow, wide: a solid thread of 60 mm on 24 spans, so that its radii stand at knots.
RodBody::Setup hourglass() {
  RodBody::Setup setup;
  setup.points = {Vec3::Zero(), Vec3(0, 0, 20e-3), Vec3(0, 0, 35e-3), Vec3(0, 0, 60e-3)};
  setup.radii = {3e-3, 1e-3, 1e-3, 2e-3};
  setup.wall = 5e-3;
  setup.density = 1000;
  setup.nodes = 27;
  return setup;
}

double mass(const RodBody& rod) {
  double sum = 0;
  for (int row = 0; row < rod.rod().stencils().rows(); ++row) sum += rod.row_mass(row);
  return sum;
}

TEST(TaperedRod, IsAsThickAsItsListSaysWholeAndDivided) {
  const RodBody rod = RodBody::create(hourglass()).value();
  const int last = static_cast<int>(rod.last_point());
  for (int point = 0; point <= last; ++point) {
    const double z = rod.skin_rest()[point].z();
    const double expected = z < 20e-3   ? 3e-3 - 2e-3 * z / 20e-3
                            : z < 35e-3 ? 1e-3
                                        : 1e-3 + 1e-3 * (z - 35e-3) / 25e-3;
    EXPECT_NEAR(rod.outer_radius(point), expected, 1e-12) << z;
    EXPECT_EQ(rod.skin_radii()[point], rod.outer_radius(point));
  }
  const int cut = rod.point_to_divide_at(0.7);
  for (const auto& [first, end] : {std::pair{0, cut}, {cut, last}}) {
    const RodBody part = rod.part(first, end).value();
    for (int point = first; point <= end; ++point)
      EXPECT_NEAR(part.outer_radius(point - first), rod.outer_radius(point), 1e-12);
  }
}

TEST(TaperedRod, WeighsAsManyTruncatedCones) {
  const RodBody rod = RodBody::create(hourglass()).value();
  const auto cone = [](double length, double a, double b) {
    return pi * length / 3 * (a * a + a * b + b * b);
  };
  const double volume = cone(20e-3, 3e-3, 1e-3) + cone(15e-3, 1e-3, 1e-3) + cone(25e-3, 1e-3, 2e-3);
  EXPECT_NEAR(mass(rod), 1000 * volume, 1e-9 * 1000 * volume);
}

TEST(TaperedRod, StretchesAsConesInARow) {
  RodBody::Setup setup = hourglass();
  setup.density = 0;
  const auto rod = std::make_shared<const RodBody>(RodBody::create(setup).value());
  test::GroupRig rig({rod});
  constexpr double stiffness = 100;  // N/m, of the spring that pulls
  const int last = static_cast<int>(rod->last_point());
  const Vec3 start = rod->skin_rest().front(), target = rod->skin_rest().back() + Vec3(0, 0, 1e-3);
  rig.hold(0, 0, start, 1e9);
  rig.hold(0, last, target, stiffness);
  ASSERT_TRUE(rig.settle().converged());
  const Vec3 end = rod->skin_positions(rig.bodies[0].state.x)[last];
  const double force = stiffness * (target - end).z(), young = 3 * setup.shear_modulus;
  double compliance = 0;
  const std::array<double, 3> lengths{20e-3, 15e-3, 25e-3};
  for (std::size_t k = 0; k < lengths.size(); ++k)
    compliance += lengths[k] / (pi * young * setup.radii[k] * setup.radii[k + 1]);
  const double longer = (end - rod->skin_rest().back()).z();
  // Its strain, which is 7 % where it is thinnest, is not quite small.
  EXPECT_NEAR(longer, force * compliance, 0.03 * longer);
}

}  // namespace
}  // namespace calot
