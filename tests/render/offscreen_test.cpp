#include "render/offscreen.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <limits>

#include "render/gl_objects.h"
#include "render/image_compare.h"
#include "render/osmesa_context.h"
#include "render/png.h"
#include "render/seen_at.h"
#include "support/mock_organ.h"

namespace calot::offscreen_test {
namespace {

/// A flat tissue plate across the view at `depth`, its normal towards the camera.
SceneMesh plate(Material material, double depth, double half, double shift = 0) {
  SceneMesh mesh;
  mesh.material = material;
  for (const Vec2& corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
    mesh.positions.emplace_back(half * corner.x() + shift, depth, half * corner.y());
    mesh.normals.push_back(-Vec3::UnitY());
  }
  mesh.rest_positions = mesh.positions;
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// A pear with a tent before a liver-coloured plate; the camera looks along +y with +z up.
Scene pear_scene() {
  Pose frame = Pose::Identity();
  frame.translation() = Vec3(0, 90e-3, -40e-3);
  Scene scene;
  scene.meshes.push_back(test::mock_pear(frame, Vec3(0, -12e-3, 70e-3), Vec3(4e-3, -8e-3, 10e-3)));
  scene.meshes.push_back(plate(Material::steel, 70e-3, 4e-3, 25e-3));
  scene.meshes.push_back(plate(Material::liver, 125e-3, 300e-3));
  return scene;
}

OffscreenRenderer make(int width = 240, int height = 200) {
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(width, height);
  if (!renderer) {
    ADD_FAILURE() << to_text(renderer.failure());
    std::abort();
  }
  return std::move(renderer).value();
}

Image draw(OffscreenRenderer& renderer, const Scene& scene) {
  Result<Image> image = renderer.render(scene);
  if (!image) {
    ADD_FAILURE() << to_text(image.failure());
    std::abort();
  }
  return std::move(image).value();
}

ImageDifference difference(const Image& a, const Image& b, const CompareTolerance& tolerance = {}) {
  return compare(a, b, tolerance).value();
}

int brightness(const Image& image, int x, int y) {
  const unsigned char* p = &image.rgb[3 * (y * image.width + x)];
  return p[0] + p[1] + p[2];
}

/// Mean brightness over a square of (2 half + 1) pixels.
double brightness_around(const Image& image, const Vec2& at, int half) {
  double sum = 0;
  for (int dy = -half; dy <= half; ++dy)
    for (int dx = -half; dx <= half; ++dx)
      sum += brightness(image, static_cast<int>(at.x()) + dx, static_cast<int>(at.y()) + dy);
  return sum / ((2 * half + 1) * (2 * half + 1));
}

/// Centre of the pixels brighter than `above`.
Vec2 bright_centre(const Image& image, int above) {
  Vec2 sum = Vec2::Zero();
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (brightness(image, x, y) > above) sum += Vec2(x + 0.5, y + 0.5), ++count;
  EXPECT_GT(count, 0);
  return sum / std::max(count, 1);
}

TEST(Offscreen, SameSceneSameBytes) {
  OffscreenRenderer first = make(), second = make();
  const Image a = draw(first, pear_scene());
  EXPECT_EQ(a.rgb, draw(first, pear_scene()).rgb);
  EXPECT_EQ(a.rgb, draw(second, pear_scene()).rgb);
  Scene other = pear_scene();
  other.camera.light_intensity = 0.3;
  draw(first, other);  // nothing may linger from frame to frame
  EXPECT_EQ(a.rgb, draw(first, pear_scene()).rgb);
}

TEST(OffscreenDeathTest, SameBytesAtAnyThreadCount) {
  // The thread count is read once a process: each picture is drawn by a process of its own.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string path = ::testing::TempDir() + "calot_threads_";
  for (const char* threads : {"1", "2"}) {
    setenv("LP_NUM_THREADS", threads, 1);
    EXPECT_EXIT(
        {
          OffscreenRenderer renderer = make();
          std::exit(write_png(path + threads + ".png", draw(renderer, pear_scene())) ? 0 : 1);
        },
        ::testing::ExitedWithCode(0), "");
  }
  unsetenv("LP_NUM_THREADS");
  const Result<Image> one = read_png(path + "1.png"), two = read_png(path + "2.png");
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one.value().rgb, two.value().rgb);
  OffscreenRenderer renderer = make();
  EXPECT_EQ(one.value().rgb, draw(renderer, pear_scene()).rgb);
}

TEST(Offscreen, EveryMutationShows) {
  OffscreenRenderer renderer = make();
  const Scene scene = pear_scene();
  const Image image = draw(renderer, scene);

  Scene light_moved = scene;  // by 2% of its distance
  light_moved.camera.light_offset += Vec3(0.02 * 90e-3, 0, 0);
  EXPECT_FALSE(difference(image, draw(renderer, light_moved)).within);

  Scene brighter = scene;
  brighter.camera.light_intensity *= 1.02;
  EXPECT_FALSE(difference(image, draw(renderer, brighter)).within);

  Scene shifted = scene;  // by about one pixel at the pear
  const double pixel = 90e-3 * std::tan(0.5 * scene.camera.field_of_view) / renderer.lens().field_radius(200);
  shifted.camera.position.x() += pixel;
  EXPECT_GT(difference(image, draw(renderer, shifted)).differing_pixels, 1000);

  for (std::size_t missing = 0; missing < scene.meshes.size(); ++missing) {
    Scene without = scene;
    without.meshes.erase(without.meshes.begin() + static_cast<long>(missing));
    EXPECT_GT(difference(image, draw(renderer, without), {0, 0, 20, 0}).largest_blob, 50)
        << "mesh " << missing;
  }

  Scene repainted = scene;
  repainted.meshes[0].material = Material::fat;
  EXPECT_GT(difference(image, draw(renderer, repainted), {0, 0, 20, 0}).largest_blob, 500);
}

TEST(Offscreen, AnEmptySceneIsBlackAndNothingElseIs) {
  OffscreenRenderer renderer = make();
  const Image blank = draw(renderer, Scene{});
  EXPECT_EQ(*std::max_element(blank.rgb.begin(), blank.rgb.end()), 0);
  EXPECT_FALSE(difference(blank, draw(renderer, pear_scene())).within);
}

TEST(Offscreen, TheFieldIsRoundAndBlackOutside) {
  OffscreenRenderer renderer = make(320, 200);
  const Image image = draw(renderer, pear_scene());
  const double radius = renderer.lens().field_radius(200);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 320; ++x) {
      const double r = std::hypot(x + 0.5 - 160, y + 0.5 - 100);
      const bool lit = brightness(image, x, y) > 0;
      ASSERT_FALSE(r > radius && lit) << x << ", " << y;
      ASSERT_FALSE(r < 0.9 * radius && !lit) << x << ", " << y;
    }
}

TEST(Offscreen, TurningTheCameraAboutItsViewTurnsThePicture) {
  OffscreenRenderer renderer = make(240, 240);
  Scene scene = pear_scene();
  scene.camera.light_offset = Vec3::Zero();  // the light turns with the camera: off the axis it would move
  const Image upright = draw(renderer, scene);
  scene.camera.up = -Vec3::UnitX();  // a quarter turn: what was left is now above
  const Image turned = draw(renderer, scene);
  Image back = turned;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 240; ++x)
      for (int c = 0; c < 3; ++c) back.rgb[3 * (y * 240 + x) + c] = turned.rgb[3 * (x * 240 + 239 - y) + c];
  // Sample places and occlusion taps do not turn along: outlines and highlights may change, not more.
  const int changed_by_turning = difference(upright, back, {25, 0, 255, 0}).differing_pixels;
  EXPECT_LT(changed_by_turning, 240 * 240 / 50);
  EXPECT_GT(difference(upright, turned, {25, 0, 255, 0}).differing_pixels, 240 * 240 / 10);
}

TEST(Offscreen, ThingsAreDrawnWhereTheLensSaysTheyAreSeen) {
  OffscreenRenderer renderer = make(400, 300);
  for (const Vec2& place : {Vec2(0, 0), Vec2(0.03, 0.02), Vec2(-0.045, 0.01), Vec2(0.01, -0.04)}) {
    Scene scene;
    scene.camera.light_offset = Vec3::Zero();
    SceneMesh mark = plate(Material::fat, 90e-3, 2.5e-3);
    for (Vec3& p : mark.positions) p += Vec3(place.x(), 0, place.y());
    scene.meshes.push_back(mark);
    const Vec2 expected =
        test::seen_at(scene.camera, renderer.lens(), 400, 300, Vec3(place.x(), 90e-3, place.y()));
    // The mark is some 11 px wide and unevenly lit: its bright part centres within a pixel or so.
    EXPECT_LT((bright_centre(draw(renderer, scene), 60) - expected).norm(), 1.2) << place.transpose();
  }
}

TEST(Offscreen, FartherIsDarker) {
  OffscreenRenderer renderer = make(200, 200);
  double last = 1e9;
  for (const double depth : {60e-3, 90e-3, 130e-3, 200e-3}) {
    Scene scene;
    scene.meshes.push_back(plate(Material::peritoneum, depth, 400e-3));
    const double now = brightness_around(draw(renderer, scene), Vec2(100, 100), 60);
    EXPECT_LT(now, 0.95 * last) << depth;
    last = now;
  }
}

/// A plate of fat lit so, beside where it mirrors the lamp: its mean red, green and blue.
std::array<double, 3> fat_lit(OffscreenRenderer& renderer, double intensity, double compensation) {
  Scene scene;
  scene.meshes.push_back(plate(Material::fat, 90e-3, 400e-3));
  scene.camera.light_intensity = intensity;
  scene.camera.compensation = compensation;
  const Image image = draw(renderer, scene);
  std::array<double, 3> mean{};
  for (int y = 130; y < 150; ++y)
    for (int x = 110; x < 130; ++x)
      for (std::size_t c = 0; c < 3; ++c) mean[c] += image.rgb[3 * (y * image.width + x) + c] / 400.0;
  return mean;
}

TEST(Exposure, InTenTimesTheUsualLightYellowIsStillYellow) {
  OffscreenRenderer renderer = make();
  const auto usual = fat_lit(renderer, 1, 1), glaring = fat_lit(renderer, 10, 1);
  EXPECT_GT(glaring[0], usual[0]) << "it is brighter all the same";
  EXPECT_LT(glaring[2], 0.8 * glaring[0]) << "and not white";
  EXPECT_LT(glaring[1], 245);
}

TEST(Exposure, LiftsWhatIsDarkByNoMoreThanItsLimit) {
  OffscreenRenderer renderer = make();
  const auto dim = fat_lit(renderer, 0.1, 1), darker = fat_lit(renderer, 0.05, 1);
  EXPECT_LT(darker[0], 0.75 * dim[0]) << "half of the light is not made up for";
}

TEST(Exposure, LeavesWhatWasAskedFor) {
  OffscreenRenderer renderer = make();
  const double usual = fat_lit(renderer, 1, 1)[1], adapted = fat_lit(renderer, 2, 1)[1];
  const double asked = fat_lit(renderer, 2, 2)[1];
  EXPECT_LT(adapted, 1.08 * usual) << "twice the light is taken back for the most part";
  EXPECT_GT(asked, 1.1 * usual) << "twice the exposure is not";
}

TEST(Offscreen, HighlightsFollowTheLight) {
  OffscreenRenderer renderer = make(300, 300);
  Scene scene = pear_scene();
  scene.meshes.resize(1);
  Vec2 centre[2];
  for (const int side : {0, 1}) {
    scene.camera.light_offset = Vec3(side ? 12e-3 : -12e-3, 0, 0);
    centre[side] = bright_centre(draw(renderer, scene), 690);
  }
  // On a ball of radius 17 mm at 75 mm a highlight moves by about R / (2 d) of the light's shift: 2.7 mm, 9
  // px.
  EXPECT_GT(centre[1].x() - centre[0].x(), 3);
}

TEST(Offscreen, ALobeThatFacesTheLightHasAFewHighlightsAndNoGlareAllOver) {
  OffscreenRenderer renderer = make();
  const auto glaring = [&](Material material) {
    Scene scene;
    scene.meshes.push_back(plate(material, 105e-3, 40e-3));
    const Image image = draw(renderer, scene);
    int bright = 0;
    for (int y = 60; y < 140; ++y)
      for (int x = 80; x < 160; ++x) bright += brightness(image, x, y) > 450 ? 1 : 0;
    return bright / 6400.0;
  };
  EXPECT_GT(glaring(Material::capsule), 0);
  EXPECT_LT(glaring(Material::capsule), 0.1);
  EXPECT_GT(glaring(Material::liver), 0.2);  // that of the scenery, which is seen from the side
}

TEST(Offscreen, AShadowFallsOnTheSideAwayFromTheLight) {
  OffscreenRenderer renderer = make(300, 300);
  Scene scene;
  scene.meshes.push_back(plate(Material::steel, 60e-3, 5e-3));
  scene.meshes.push_back(plate(Material::peritoneum, 90e-3, 300e-3));
  scene.camera.light_offset = Vec3(15e-3, 0, 0);
  const Image image = draw(renderer, scene);
  // Edge of the plate seen at +-5/60; its shadow on the wall reaches from -15 mm to 0, seen to -15/90.
  const auto wall_at = [&](double x) {
    return test::seen_at(scene.camera, renderer.lens(), 300, 300, Vec3(x, 90e-3, 0));
  };
  const double shaded = brightness_around(image, wall_at(-11.5e-3), 3);
  EXPECT_LT(shaded, 0.7 * brightness_around(image, wall_at(11.5e-3), 3));
  EXPECT_LT(shaded, 0.7 * brightness_around(image, wall_at(-22e-3), 3));
}

TEST(Offscreen, PatternsStayWithTheTissue) {
  // The same skin carried elsewhere keeps its texture: two pictures that differ only by a common shift of
  // tissue and camera are the same, though the pattern is bound to rest positions.
  OffscreenRenderer renderer = make();
  Scene scene = pear_scene();
  const Image before = draw(renderer, scene);
  const Vec3 shift(0.25, -0.5, 0.125);  // exact in floating point
  for (SceneMesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p += shift;
  scene.camera.position += shift;
  // Positions lose a few bits of 1e-17 m: nothing but single roundings may show.
  EXPECT_TRUE(difference(before, draw(renderer, scene), {2, 20, 8, 4}).within);
  for (Vec3& p : scene.meshes[0].rest_positions) p += Vec3(10e-3, 0, 0);
  EXPECT_GT(difference(before, draw(renderer, scene), {2, 20, 8, 4}).differing_pixels, 500);
}

TEST(Offscreen, VesselsShow) {
  OffscreenRenderer renderer = make();
  Scene scene = pear_scene();
  const Image bare = draw(renderer, scene);
  auto map = std::make_shared<VesselMap>();
  map->lower = Vec3(-20e-3, -20e-3, 0);
  map->voxel = 40e-3;
  map->size = {1, 1, 2};
  map->share = {255, 255};
  scene.meshes[0].vessels = map;
  EXPECT_GT(difference(bare, draw(renderer, scene), {4, 0, 15, 0}).largest_blob, 500);
  scene.meshes[0].vessels = nullptr;
  EXPECT_EQ(bare.rgb, draw(renderer, scene).rgb);
}

TEST(Offscreen, WhatCannotBeDrawnIsRefusedWithItsReason) {
  EXPECT_FALSE(OffscreenRenderer::create(0, 100));
  EXPECT_FALSE(OffscreenRenderer::create(100, 100000));
  OffscreenRenderer renderer = make();
  const auto reason = [&](const Scene& scene) {
    const Result<Image> image = renderer.render(scene);
    return image ? std::string("drawn") : to_text(image.failure());
  };
  Scene scene = pear_scene();
  scene.meshes[1].normals.pop_back();
  EXPECT_THAT(reason(scene), ::testing::HasSubstr("mesh 1"));
  scene = pear_scene();
  scene.meshes[0].positions[17].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(reason(scene), ::testing::HasSubstr("point 17 is not finite"));
  scene = pear_scene();
  scene.meshes[2].triangles[0][1] = 4;
  EXPECT_THAT(reason(scene), ::testing::HasSubstr("names point 4 of 4"));
  scene = pear_scene();
  scene.meshes[0].vessels = std::make_shared<VesselMap>();
  EXPECT_THAT(reason(scene), ::testing::HasSubstr("vessel map"));
  scene = pear_scene();
  scene.camera.field_of_view = 0;
  EXPECT_THAT(reason(scene), ::testing::HasSubstr("camera"));
  scene = pear_scene();
  scene.camera.position.z() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(reason(scene), ::testing::HasSubstr("camera"));
}

TEST(GlObjects, AShaderThatDoesNotCompileIsAFailureWithItsLog) {
  Result<OsmesaContext> context = OsmesaContext::create();
  ASSERT_TRUE(context);
  const Result<GlFunctions> gl = load_gl(&OsmesaContext::function);
  ASSERT_TRUE(gl);
  const std::string fine = "#version 330 core\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n";
  const std::string vertex = "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }\n";
  EXPECT_TRUE(build_program(gl.value(), "fine", vertex, fine));

  const Result<GLuint> broken =
      build_program(gl.value(), "lamp", vertex, "#version 330 core\nvoid main() { lamb = 1; }\n");
  ASSERT_FALSE(broken);
  EXPECT_THAT(to_text(broken.failure()),
              ::testing::AllOf(::testing::HasSubstr("lamp"), ::testing::HasSubstr("lamb")));

  const std::string gives =
      "#version 330 core\nout vec2 bile;\nvoid main() { bile = vec2(0.0); gl_Position = vec4(0.0); }\n";
  const std::string wants =
      "#version 330 core\nin vec3 bile;\nout vec4 c;\nvoid main() { c = vec4(bile, 1.0); }\n";
  const Result<GLuint> unlinked = build_program(gl.value(), "duct", gives, wants);
  ASSERT_FALSE(unlinked);
  EXPECT_THAT(to_text(unlinked.failure()),
              ::testing::AllOf(::testing::HasSubstr("duct"), ::testing::HasSubstr("bile")));
}

TEST(GlFunctions, MissingFunctionsAreNamed) {
  const Result<GlFunctions> gl = load_gl([](const char* name) -> void (*)() {
    return std::string(name) == "glDrawElements" ? nullptr : +[] {};
  });
  ASSERT_FALSE(gl);
  EXPECT_THAT(to_text(gl.failure()), ::testing::HasSubstr("glDrawElements"));
}

}  // namespace
}  // namespace calot::offscreen_test
