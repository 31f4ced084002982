#include "render/lens.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "render/seen_at.h"

namespace calot {
namespace {

SceneCamera random_camera(Rng& rng) {
  const auto any = [&] { return Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)); };
  SceneCamera camera;
  camera.position = 0.1 * any();
  camera.direction = any().normalized();
  camera.up = any();
  camera.field_of_view = rng.uniform(1.0, 1.5);
  return camera;
}

TEST(Lens, AxesAreARightHandedFrame) {
  Rng rng(1);
  for (int i = 0; i < 50; ++i) {
    const SceneCamera camera = random_camera(rng);
    const Mat3 axes = camera_axes(camera);
    EXPECT_LT((axes * axes.transpose() - Mat3::Identity()).norm(), 1e-12);  // rounding
    EXPECT_LT((axes * camera.direction - Vec3::UnitZ()).norm(), 1e-12);
    EXPECT_GT((axes * camera.up).y(), 0);
    // right x up points back at the viewer
    EXPECT_LT((axes.row(0).cross(axes.row(1)) + axes.row(2)).norm(), 1e-12);
  }
}

TEST(Lens, TheFieldsEdgeIsSeenAtHalfTheFieldOfView) {
  Rng rng(2);
  const Lens lens;
  for (int i = 0; i < 50; ++i) {
    const SceneCamera camera = random_camera(rng);
    const double turn = rng.uniform(0, 6.28), half = 0.5 * camera.field_of_view;
    const Vec3 local(std::sin(half) * std::cos(turn), std::sin(half) * std::sin(turn), std::cos(half));
    const Vec3 point = camera.position + 0.07 * (camera_axes(camera).transpose() * local);
    const Vec2 seen = test::seen_at(camera, lens, 960, 540, point) - Vec2(480, 270);
    EXPECT_NEAR(seen.norm(), lens.field_radius(540), 1e-6);  // Newton's remainder
    EXPECT_NEAR(std::remainder(std::atan2(-seen.y(), seen.x()) - turn, 2 * 3.14159265358979), 0, 1e-9);
  }
}

TEST(Lens, TheMiddleIsMagnifiedAndOrderKept) {
  // Barrel distortion: equal steps of the tangent shrink towards the edge and never turn back.
  const Lens lens;
  SceneCamera camera;
  double last = 480, last_step = 1e9;
  for (int i = 1; i <= 10; ++i) {
    const double tangent = std::tan(0.5 * camera.field_of_view) * i / 10;
    const Vec3 point = camera.direction + camera_axes(camera).transpose() * Vec3(tangent, 0, 0);
    const double x = test::seen_at(camera, lens, 960, 540, point).x();
    EXPECT_GT(x, last);
    EXPECT_LT(x - last, last_step);
    last_step = x - last;
    last = x;
  }
}

}  // namespace
}  // namespace calot
