#include <gtest/gtest.h>

#include "field/field_state.h"
#include "rig.h"
#include "world/sight.h"

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
  double of(const std::array<Vec3, 3>& corners) const {
    return from({eye, Vec3::UnitY(), Vec3::UnitZ()}, corners);
  }
  double from(const LaparoscopePose& lens, const std::array<Vec3, 3>& corners) const {
    return seen_area(Sight(world.field(), lens.position), lens, 75 * units::deg, corners, 2e-3);
  }
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

TEST(SeenArea, WhatLiesOutsideTheRoundFieldIsNotSeen) {
  const Seen seen;
  const std::array<Vec3, 3> before = seen.screen(-40e-3, -5e-3);
  const auto turned = [&](double degrees) {
    const double angle = degrees * units::deg;
    return seen.from({seen.eye, Vec3(std::sin(angle), std::cos(angle), 0), Vec3::UnitZ()}, before);
  };
  EXPECT_EQ(turned(0), seen.of(before));
  // It is from 5 degrees left to 27 right: with the field's edge, 37.5 degrees off, through its middle half of it is seen.
  EXPECT_GT(turned(-27), 0.1 * turned(0));
  EXPECT_LT(turned(-27), 0.9 * turned(0));
  EXPECT_EQ(turned(-50), 0);
  EXPECT_EQ(turned(180), 0);
}

TEST(LaparoscopeInItsPort, StandsAsTheSceneSaysUntilItIsMoved) {
  const LaparoscopeDefinition scope;
  const Vec3 port(0.01, -0.01, 0), target(-0.05, 0.15, -0.09);
  const LaparoscopePose stands = laparoscope_pose(scope, port, target);
  const Laparoscope laparoscope(scope, port, target);
  const InstrumentPose start = laparoscope.start();
  EXPECT_EQ(laparoscope.view(start).direction, stands.direction);
  EXPECT_LT((tip_position(port, start, laparoscope_geometry()) - stands.position).norm(), 1e-12);
  InstrumentPose moved = start;
  moved.insertion += 1e-9;  // no jump where it is moved first
  EXPECT_LT((laparoscope.view(moved).direction - stands.direction).norm(), 1e-9);
  EXPECT_LT((laparoscope.view(moved).up - stands.up).norm(), 1e-9);
}

TEST(LaparoscopeInItsPort, RollTurnsAnAngledOpticAboutTheShaftAndTheHorizonStaysLevel) {
  const Vec3 port(0.01, -0.01, 0), target(-0.05, 0.15, -0.09);
  const Laparoscope laparoscope({}, port, target);
  InstrumentPose pose = laparoscope.start();
  const LaparoscopePose before = laparoscope.view(pose);
  const Vec3 shaft = (before.position - port).normalized();
  pose.roll = 50 * units::deg;
  const LaparoscopePose after = laparoscope.view(pose);
  EXPECT_LT((after.position - before.position).norm(), 1e-12);
  EXPECT_NEAR(shaft.dot(after.direction), std::cos(30 * units::deg), 1e-12);
  const Vec3 across = before.direction - shaft * shaft.dot(before.direction);
  EXPECT_LT(
      (after.direction - (shaft * shaft.dot(before.direction) + Eigen::AngleAxisd(pose.roll, shaft) * across))
          .norm(),
      1e-12);
  EXPECT_NEAR(after.up.cross(after.direction).z(), 0, 1e-12);
}

TEST(LaparoscopeInItsPort, APortNearerThanTheLensIsToBeHasItInsideWhenItIsMoved) {
  const Laparoscope laparoscope({}, Vec3::Zero(), Vec3(0, 0.03, -0.04));
  InstrumentPose pose = laparoscope.start();
  EXPECT_GE(pose.insertion, 0);
  pose.insertion += 1e-3;
  EXPECT_LT(laparoscope.view(pose).position.z(), 0);
}

TEST(LaparoscopeInItsPort, LookingAtAPlaceHasItInTheMiddleFromThatDistanceWithTheOpticDownFromTheShaft) {
  const Vec3 port(0.01, -0.01, 0);
  for (const double angle : {0.0, 30.0})
    for (const Vec3& place : {Vec3(-0.09, 0.12, -0.12), Vec3(0.05, 0.18, -0.06)}) {
      LaparoscopeDefinition scope;
      scope.angle = angle * units::deg;
      scope.horizon = Horizon::held;
      const Laparoscope laparoscope(scope, port, Vec3(-0.05, 0.15, -0.09));
      const LaparoscopePose view = laparoscope.view(laparoscope.looking_at(place, 70e-3).value());
      EXPECT_LT((view.position + 70e-3 * view.direction - place).norm(), 1e-12);
      EXPECT_LT(place_in_picture(view, 75 * units::deg, place)->norm(), 1e-12);
      EXPECT_NEAR(horizon_off_level(view), 0, 1e-12) << "the shaft is turned for that";
      EXPECT_FALSE(laparoscope.looking_at(place, 300e-3)) << "that is outside of the port";
      const Vec3 shaft = (view.position - port).normalized();
      EXPECT_NEAR(shaft.dot(view.direction), std::cos(angle * units::deg), 1e-12);
      EXPECT_NEAR(shaft.cross(view.direction).z(), 0, 1e-12) << "in the vertical plane";
      if (angle > 0) {
        EXPECT_LT(view.direction.z(), shaft.z());
      }
    }
}

TEST(LaparoscopeInItsPort, AHorizonThatIsHeldTurnsByWhatTheShaftIsTurned) {
  LaparoscopeDefinition scope;
  scope.angle = 0;
  scope.horizon = Horizon::held;
  const Laparoscope laparoscope(scope, Vec3(0.01, -0.01, 0), Vec3(-0.05, 0.15, -0.09));
  InstrumentPose pose = laparoscope.start();
  EXPECT_NEAR(horizon_off_level(laparoscope.view(pose)), 0, 1e-12);
  pose.roll = 25 * units::deg;
  EXPECT_NEAR(horizon_off_level(laparoscope.view(pose)), pose.roll, 1e-12);
  pose.roll = -130 * units::deg;
  EXPECT_NEAR(horizon_off_level(laparoscope.view(pose)), pose.roll, 1e-12);
}

TEST(LaparoscopeInItsPort, APlaceIsInThePictureWhereTheViewHasIt) {
  const LaparoscopePose view{Vec3(0.01, 0, 0), Vec3::UnitY(), Vec3::UnitZ()};
  const double field = 70 * units::deg, edge = 0.1 * std::tan(35 * units::deg);
  const auto shown = [&](const Vec3& off) { return place_in_picture(view, field, view.position + off); };
  EXPECT_LT((*shown({edge, 0.1, 0}) - Vec2(1, 0)).norm(), 1e-12) << "the patient's left is right in it";
  EXPECT_LT((*shown({0, 0.1, 0.5 * edge}) - Vec2(0, 0.5)).norm(), 1e-12);
  EXPECT_FALSE(shown({0, -0.1, 0}));
  EXPECT_FALSE(shown({0.1, 0, 0}));
  EXPECT_TRUE(is_in_field(view, field, view.position + Vec3(0.99 * edge, 0.1, 0)));
  EXPECT_FALSE(is_in_field(view, field, view.position + Vec3(1.01 * edge, 0.1, 0)));
}

TEST(LaparoscopeInItsPort, AWorldsLaparoscopeGoesWhereItsInputSaysAndBackWithItsState) {
  Seen seen;
  World& world = seen.world;
  StepInput input;
  input.instruments = {world.report().instruments[0].pose};
  const InstrumentPose start = world.report().laparoscope.pose;
  const FieldState before = world.state();
  ASSERT_TRUE(world.step(input));
  const std::uint64_t still = world.state_hash();
  ASSERT_TRUE(world.restore(before));
  input.laparoscope = start;
  ASSERT_TRUE(world.step(input));
  EXPECT_EQ(world.state_hash(), still) << "where it stood is no motion";
  ASSERT_TRUE(world.restore(before));
  input.laparoscope->yaw += 0.3;
  ASSERT_TRUE(world.step(input));
  EXPECT_NE(world.state_hash(), still);
  EXPECT_EQ(world.report().laparoscope.pose, *input.laparoscope);
  const std::array<Vec3, 3> before_ball = seen.screen(-40e-3, -5e-3);
  const double seen_there = world.seen_area(before_ball);
  ASSERT_TRUE(world.restore(before));
  EXPECT_EQ(world.report().laparoscope.pose, start);
  EXPECT_NE(world.seen_area(before_ball), seen_there);
  input.laparoscope->insertion = 0.31;
  EXPECT_FALSE(world.step(input)) << "its shaft is shorter";
  input.laparoscope.reset();
  EXPECT_TRUE(world.step(input));
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
