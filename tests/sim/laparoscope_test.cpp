#include "sim/laparoscope.h"

#include <gtest/gtest.h>

#include "rig.h"

namespace calot {
namespace {

/// A ball of 20 mm radius about (-80, 70, -130) mm on a level table, an electrode above it, and an eye on the ball's level.
struct Seen {
  World world;
  Vec3 middle{-80e-3, 70e-3, -130e-3}, eye{-80e-3, -30e-3, -130e-3};

  Seen() : world(World::create(scene()).value()) {}
  static SceneDefinition scene() {
    SceneDefinition scene = test::ball_scene();
    scene.instruments[0].type = InstrumentType::bipolar_electrode;
    return scene;
  }
  /// Of a triangle in a plane across the line of sight, `behind` m behind the ball's middle, from `left` m to 30 mm right
  /// of it, 30 mm high.
  std::array<Vec3, 3> screen(double behind, double left) const {
    const Vec3 at = middle + Vec3(0, behind, 0);
    return {at + Vec3(left, 0, -15e-3), at + Vec3(left, 0, 15e-3), at + Vec3(30e-3, 0, 0)};
  }
  double of(const std::array<Vec3, 3>& corners) const { return seen_area(world.field(), eye, corners, 2e-3); }
};

double area(const std::array<Vec3, 3>& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

TEST(SeenArea, WhatNothingHidesIsSeenWholeBeforeAnOrganAndNotBehindIt) {
  const Seen seen;
  const std::array<Vec3, 3> before = seen.screen(-40e-3, -5e-3), behind = seen.screen(40e-3, -5e-3);
  // 60 mm off, it is seen at up to 27 degrees.
  EXPECT_GT(seen.of(before), std::cos(27 * units::deg) * area(before));
  EXPECT_LT(seen.of(before), area(before));
  // The ball's shadow there is 28.6 mm wide on either side: all that remains is the last tip.
  EXPECT_LT(seen.of(behind), 0.02 * area(behind));
  EXPECT_GT(seen.of(seen.screen(40e-3, 28e-3)), 0);
}

TEST(SeenArea, ATriangleIsSeenFromItsEdgeAsNone) {
  const Seen seen;
  const Vec3 at = seen.middle - Vec3(0, 60e-3, 0);
  EXPECT_NEAR(seen.of({at, at + Vec3(10e-3, 0, 0), at + Vec3(0, -10e-3, 0)}), 0, 1e-12);
  const std::array<Vec3, 3> tilted{at, at + Vec3(1e-3, 1e-3, 0), at + Vec3(0, 0, 1e-3)};  // by 45 degrees
  EXPECT_NEAR(seen.of(tilted) / area(tilted), std::sqrt(0.5), 0.02);
}

TEST(SeenArea, AShaftHidesWhatIsBehindIt) {
  Seen seen;
  const std::array<Vec3, 3> before = seen.screen(-40e-3, -5e-3);
  const double whole = seen.of(before);
  test::Driver driver(seen.world);
  ASSERT_TRUE(driver.go(seen.middle + Vec3(0, -60e-3, -10e-3), 0, 60)) << driver.why();
  EXPECT_LT(seen.of(before), 0.9 * whole);
  EXPECT_GT(seen.of(before), 0.3 * whole);
}

TEST(SeenArea, WhatStandsWithinTheMarginBeforeItHidesNothing) {
  const Seen seen;
  const Vec3 front = seen.middle - Vec3(0, 20e-3, 0);  // of the ball
  const auto touching = [&](double deep) {
    const Vec3 at = front + Vec3(0, deep, 0);
    return std::array<Vec3, 3>{at, at + Vec3(1e-3, 0, 0), at + Vec3(0, 0, 1e-3)};
  };
  EXPECT_GT(seen.of(touching(1e-3)), 0.9 * area(touching(1e-3)));
  EXPECT_EQ(seen.of(touching(4e-3)), 0);
}

}  // namespace
}  // namespace calot
