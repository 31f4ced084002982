#include "view/laparoscope.h"

#include "base/rng.h"
#include "base/units.h"
#include "render/lens.h"

namespace calot {
namespace {

SceneCamera camera_of(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target) {
  return laparoscope_camera(scope, {{}, laparoscope_pose(scope, port, target), scope.distance});
}

Vec3 random_target(Rng& rng) {
  return {rng.uniform(-0.1, 0.1), rng.uniform(0.12, 0.2), rng.uniform(-0.15, -0.03)};
}

TEST(Laparoscope, LooksAtItsTargetFromItsDistance) {
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    LaparoscopeDefinition scope;
    scope.angle = (i % 2) * 30 * units::deg;
    scope.distance = rng.uniform(0.04, 0.1);
    const Vec3 target = random_target(rng);
    const SceneCamera camera = camera_of(scope, Vec3(0.01, -0.01, 0), target);
    // rounding of lengths below a metre
    EXPECT_LT((camera.position + scope.distance * camera.direction - target).norm(), 1e-14);
    EXPECT_NEAR(camera.direction.norm(), 1, 1e-14);
  }
}

TEST(Laparoscope, APictureIsAsBrightAsLightTimesExposure) {
  const auto intensity = [](const LaparoscopeDefinition& scope) {
    return camera_of(scope, Vec3::Zero(), Vec3(0, 0.15, -0.08)).light_intensity;
  };
  LaparoscopeDefinition scope;
  const double usual = intensity(scope);
  scope.light = 0.5, scope.exposure = 3;
  EXPECT_DOUBLE_EQ(intensity(scope), 1.5 * usual);
  EXPECT_DOUBLE_EQ(camera_of(scope, Vec3::Zero(), Vec3(0, 0.15, -0.08)).compensation, 1.5)
      << "the camera leaves that as it is";
}

TEST(Laparoscope, TheShaftRunsThroughThePortAtTheOpticsAngleAboveTheView) {
  Rng rng(2);
  for (int i = 0; i < 100; ++i) {
    LaparoscopeDefinition scope;
    scope.angle = (i % 3) * 15 * units::deg;
    const Vec3 port(0.01, -0.01, 0), target = random_target(rng);
    const SceneCamera camera = camera_of(scope, port, target);
    const Vec3 shaft = (camera.position - port).normalized();
    EXPECT_GT((camera.position - port).dot(camera.direction), 0);  // it reaches into the abdomen
    // The tip is at least 30 mm from the port here: 1e-12 is rounding over that length.
    EXPECT_NEAR(std::atan2(shaft.cross(camera.direction).norm(), shaft.dot(camera.direction)), scope.angle,
                1e-12);
    EXPECT_GE(shaft.z(), camera.direction.z() - 1e-12);  // it looks down, if anywhere
    const Vec3 across = (target - port).cross(Vec3::UnitZ());
    EXPECT_LT(std::abs(shaft.dot(across.normalized())), 1e-12);  // port, tip and target in one vertical plane
  }
}

TEST(Laparoscope, TheHorizonIsLevelAndThePatientsLeftIsOnTheRight) {
  Rng rng(3);
  for (int i = 0; i < 100; ++i) {
    const SceneCamera camera = camera_of({}, Vec3::Zero(), random_target(rng));
    const Mat3 axes = camera_axes(camera);
    EXPECT_LT(std::abs(axes(0, 2)), 1e-12);
    EXPECT_GT(axes(0, 0), 0.5);
    EXPECT_GT(axes(1, 2), 0);
  }
}

TEST(Laparoscope, ATooNearPortStillShowsTheTarget) {
  LaparoscopeDefinition scope;  // 90 mm from what it looks at
  for (const double reach : {0.02, 0.06, 0.0899}) {
    const Vec3 target(0, 0.6 * reach, -0.8 * reach);
    const SceneCamera camera = camera_of(scope, Vec3::Zero(), target);
    EXPECT_LT((camera.position + scope.distance * camera.direction - target).norm(), 1e-14);
    EXPECT_LT(camera.direction.cross(target).norm(), 1e-14);
  }
}

TEST(Laparoscope, StraightDownIsNoSpecialCase) {
  const SceneCamera camera = camera_of({}, Vec3::Zero(), Vec3(0, 0, -0.15));
  EXPECT_TRUE(camera_axes(camera).allFinite());
  EXPECT_TRUE(camera.direction.allFinite());
}

TEST(Laparoscope, WhatIsLookedAtIsEquallyLitAtAnyDistance) {
  LaparoscopeDefinition near, far;
  near.distance = 0.05, far.distance = 0.1;
  const double a = camera_of(near, Vec3::Zero(), Vec3(0, 0.2, 0)).light_intensity;
  const double b = camera_of(far, Vec3::Zero(), Vec3(0, 0.2, 0)).light_intensity;
  EXPECT_NEAR(b / a, 4, 1e-12);  // the light falls with the square of the distance
}

}  // namespace
}  // namespace calot
