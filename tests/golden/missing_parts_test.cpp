// What an operation leaves in the picture, taken out of it one at a time: a golden notices each, where it was drawn and on
// another machine. The fields are the smallest that have it, seen from as far away as an operator looks.

#include <gtest/gtest.h>

#include "field/field.h"
#include "golden/stored_goldens.h"
#include "sim/act_rig.h"
#include "sim/rail_rig.h"
#include "sim/rig.h"
#include "view/build_scene.h"
#include "view/clip_mesh.h"

namespace calot {
namespace {

constexpr double operating_distance = 95e-3;  // m, as in the shipped operations

/// A picture of a world, accepted as golden, is held against one without what `take_out` takes.
void expect_missed(const World& world, const std::string& what, const std::function<void(Scene&)>& take_out) {
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(960, 540);
  ASSERT_TRUE(renderer) << to_text(renderer.failure());
  const SceneBuilder builder(world);
  const auto drawn = [&](const std::string& name, const Scene& scene) {
    const Result<Image> image = renderer->render(scene);
    EXPECT_TRUE(image) << to_text(image.failure());
    Frame frame;
    frame.name = name;
    frame.state_hash = world.state_hash();
    frame.renderer = renderer->description();
    if (image) frame.image = image.value();
    return make_golden(frame);
  };
  const test::Stored stored{"missing parts", what, drawn(what, builder.build(world))};
  EXPECT_TRUE(judge(stored.golden, drawn(what, builder.build(world))).passed) << "nothing is missing yet";
  Scene without = builder.build(world);
  take_out(without);
  test::expect_caught(stored, drawn(what, without).image, what);
}

/// Of meshes of a material, the triangles that lie wholly where `there` says; returns how many of how many.
std::pair<std::size_t, std::size_t> take_triangles(Scene& scene, Material material,
                                                   const std::function<bool(const Vec3&)>& there) {
  std::size_t taken = 0, of = 0;
  for (SceneMesh& mesh : scene.meshes) {
    if (mesh.material != material) continue;
    of += mesh.triangles.size();
    taken += std::erase_if(mesh.triangles, [&](const Triangle& triangle) {
      return std::all_of(triangle.begin(), triangle.end(),
                         [&](auto corner) { return there(mesh.positions[corner]); });
    });
  }
  return {taken, of};
}

/// A tube across the way of an instrument, seen from beside it.
SceneDefinition tube_from_aside(InstrumentType type) {
  SceneDefinition scene = test::across(type);
  scene.ports.push_back({"aside", Vec3(90e-3, -60e-3, -20e-3)});
  scene.laparoscope.port = "aside";
  scene.laparoscope.distance = operating_distance;
  return scene;
}

/// Two stiff tubes along x, 16 mm apart, with fat between them.
SceneDefinition veiled_tubes() {
  SceneDefinition scene = test::ball_scene();
  scene.anatomy.organs = {test::rail("near", 82e-3), test::rail("far", 98e-3)};
  TissueDefinition fat;
  fat.name = "fat";
  fat.from = "near";
  fat.to = "far";
  fat.within = 13e-3;
  fat.start = 0.3;
  fat.stop = 0.7;
  fat.strands = 24;
  fat.strength = 100e3;
  fat.stiffness = fat.strength / 3;
  fat.break_energy = 60e-3 * fat.strength;
  scene.anatomy.tissue = {fat};
  scene.solver.motion = SolverMotion::dynamics;
  scene.ports = default_ports();
  scene.ports.push_back({"above", Vec3(-80e-3, 90e-3, 100e-3)});
  scene.laparoscope.look_at = "near.middle";
  scene.laparoscope.distance = operating_distance;
  InstrumentDefinition electrode = default_instrument(InstrumentType::bipolar_electrode);
  electrode.name = "left";
  electrode.port = "above";
  electrode.force_limit = 100;
  scene.instruments = {electrode};
  return scene;
}

/// The largest share that a strand has taken of what divides it.
double hottest(const World& world) {
  const Tissue& fat = world.field().tissues[0];
  double most = 0;
  for (std::size_t i = 0; i < fat.now.heated.size(); ++i)
    most =
        std::max(most, fat.now.heated[i] / (fat.definition.divide_energy * fat.strands->strands()[i].area));
  return most;
}

TEST(MissingParts, AGoldenNoticesAMissingClip) {
  test::Acting acting(tube_from_aside(InstrumentType::clip_applier));
  ASSERT_TRUE(acting.go(test::about(0.4, test::tube_depth - 20e-3), 2));
  ASSERT_TRUE(acting.go(test::about(0.4, test::tube_depth + 5e-3), 6));
  ASSERT_TRUE(acting.fire());
  ASSERT_TRUE(acting.go(test::about(0.4, test::tube_depth - 30e-3), 6));
  const std::vector<SceneMesh> clips = clip_meshes(acting.world.field().organs[0]);
  ASSERT_EQ(clips.size(), 1u);
  expect_missed(acting.world, "a missing clip", [&](Scene& seen) {
    EXPECT_EQ(std::erase_if(seen.meshes,
                            [&](const SceneMesh& mesh) { return mesh.positions == clips[0].positions; }),
              1u);
  });
}

TEST(MissingParts, AGoldenNoticesAMissingRowOfStrands) {
  const World world = World::create(veiled_tubes()).value();
  expect_missed(world, "a missing row of strands", [](Scene& seen) {
    const auto [taken, of] =
        take_triangles(seen, Material::fat, [](const Vec3& p) { return std::abs(p.x() + 80e-3) < 1.2e-3; });
    EXPECT_GT(taken, 0u);
    EXPECT_LT(taken, of / 4) << "a row, not the fat";
  });
}

TEST(MissingParts, AGoldenNoticesAMissingFilmOfBile) {
  SceneDefinition scene = tube_from_aside(InstrumentType::bipolar_electrode);
  const double table = -test::tube_depth - 8e-3;
  scene.anatomy.support = SupportDefinition{Vec3(0, 0, table), Vec3::UnitZ()};
  World world = World::create(scene).value();
  ASSERT_TRUE(world.divide("duct", 0.5));
  for (int k = 0; k < 25; ++k) ASSERT_TRUE(world.step({{world.report().instruments[0].pose}}));
  ASSERT_FALSE(world.field().spill.films.empty());
  expect_missed(world, "a missing film of bile", [&](Scene& seen) {
    const auto [taken, of] =
        take_triangles(seen, Material::bile, [&](const Vec3& p) { return p.z() < table + 1e-3; });
    EXPECT_GT(taken, 0u);
  });
}

TEST(MissingParts, AGoldenNoticesAMissingBurn) {
  World world = World::create(veiled_tubes()).value();
  test::Driver driver(world);
  ASSERT_TRUE(driver.go({-95e-3, 90e-3, -106e-3}, 0, 12)) << driver.why();
  for (int k = 0; k < 40 && !world.report().instruments[0].touching; ++k)
    ASSERT_TRUE(driver.go({-95e-3 + 0.5e-3 * k, 90e-3, -106e-3}, 0, 1)) << driver.why();
  ASSERT_TRUE(world.report().instruments[0].touching);
  const StepInput act{{world.report().instruments[0].pose}, {InstrumentAction::activate}};
  for (int k = 0; k < 200 && hottest(world) < 0.7; ++k) ASSERT_TRUE(world.step(act));
  ASSERT_GE(hottest(world), 0.7);
  ASSERT_EQ(world.report().tissues[0].torn, 0) << "it has not parted yet";
  ASSERT_TRUE(driver.go({-105e-3, 90e-3, -106e-3}, 0, 10)) << driver.why();
  expect_missed(world, "a missing burn", [](Scene& seen) {
    double most = 0;
    for (SceneMesh& mesh : seen.meshes) {
      for (const double share : mesh.burnt) most = std::max(most, share);
      mesh.burnt.clear();
    }
    EXPECT_GT(most, 0);
  });
}

}  // namespace
}  // namespace calot
