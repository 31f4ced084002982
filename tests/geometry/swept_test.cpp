// Organs along a curved axis.

#include "geometry/swept.h"

#include <gtest/gtest.h>

#include <numbers>

#include "base/units.h"

namespace calot {
namespace {

using units::mm;

/// A gallbladder's body, a pouch, and a neck across.
std::vector<SweptStation> pouched() {
  return {{{-15 * mm, 0, 4 * mm}, 3 * mm},
          {{-8 * mm, 0, 6 * mm}, 4 * mm},
          {{0, 0, 16 * mm}, 9 * mm},
          {{0, 0, 32 * mm}, 14 * mm, 2},
          {{0, 0, 70 * mm}, 15 * mm}};
}

TEST(Swept, BetweenStationsItIsNeitherThickerNorThinnerThanThey) {
  const SweptForm form(pouched(), Vec3::UnitY());
  double before = 0;
  for (double z = 0; z <= form.length(); z += 0.5 * mm) {
    EXPECT_GE(form.radius(z), before);  // the stations' radii rise
    EXPECT_LE(form.radius(z), 15 * mm);
    before = form.radius(z);
  }
}

TEST(Swept, AStraightOneIsTheSurfaceOfRevolution) {
  const SweptForm form({{Vec3::Zero(), 8 * mm}, {{0, 0, 50 * mm}, 8 * mm}}, Vec3::UnitX());
  EXPECT_NEAR(form.length(), 50 * mm, 1e-12);
  EXPECT_LT((form.bent({3 * mm, 4 * mm, 20 * mm}) - Vec3(3 * mm, 4 * mm, 20 * mm)).norm(), 1e-12);
  EXPECT_NEAR(form.profile().point(0.5).x(), 8 * mm, 1e-12);
  EXPECT_EQ(form.profile().point(0).x(), 0);
  EXPECT_EQ(form.profile().point(1).x(), 0);
  EXPECT_EQ(form.sharpest().radius_by_curvature, 0);
}

TEST(Swept, ItsAxisGoesThroughItsStationsAndItsSkinLiesAroundIt) {
  const SweptForm form(pouched(), Vec3::UnitY());
  const auto on_axis = [&](double z) { return form.bent({0, 0, z}); };
  for (const SweptStation& station : pouched()) {
    double nearest = 1;
    for (double z = 0; z <= form.length(); z += 0.1 * mm)
      nearest = std::min(nearest, (on_axis(z) - station.at).norm());
    EXPECT_LT(nearest, 0.1 * mm);
  }
  for (double z = 1 * mm; z < form.length(); z += 5 * mm)
    for (double angle : {0.0, 2.0, 4.0}) {
      const Vec3 out(std::cos(angle), std::sin(angle), 0);
      // Frames in small steps are those of the line to a thousandth.
      EXPECT_NEAR((form.bent(form.radius(z) * out + Vec3(0, 0, z)) - on_axis(z)).norm(), form.radius(z),
                  2e-3 * form.radius(z));
    }
}

TEST(Swept, AnArcsSharpestBendIsItsOwn) {
  const double arc = 20 * mm;
  std::vector<SweptStation> stations;
  for (int k = 0; k <= 12; ++k) {
    const double angle = std::numbers::pi * k / 24;
    stations.push_back({arc * Vec3(1 - std::cos(angle), 0, std::sin(angle)), 5 * mm});
  }
  // Of a quarter circle. The spline's ends are straight, so it bends by up to a third more next to them.
  EXPECT_NEAR(SweptForm(stations, Vec3::UnitY()).sharpest().radius_by_curvature, 0.25, 0.08);
}

}  // namespace
}  // namespace calot
