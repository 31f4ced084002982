#include "view/spill_mesh.h"

#include <algorithm>

#include "render/image_compare.h"
#include "render/offscreen.h"
#include "view/build_scene.h"

namespace calot {
namespace {

/// A ball on a table, and an artery beside it that is cut open over the table.
World bleeding_world() {
  SceneDefinition scene;
  OrganDefinition ball;
  ball.name = "ball";
  ball.shape = SphereShape{};
  ball.nodes = 61;
  ball.neck = Vec3(-60e-3, 110e-3, -100e-3);
  ball.fundus = ball.neck + Vec3(0, 0, 40e-3);
  ball.held.push_back({"base", "neck", 12e-3, 2e6});
  OrganDefinition artery;
  artery.name = "artery";
  artery.shape = TubeShape{.points = {Vec3(-30e-3, 100e-3, -85e-3), Vec3(-30e-3, 130e-3, -85e-3)},
                           .radius = 0.8e-3,
                           .patient_end = PatientEnd::start,
                           .carries = Carries::blood};
  artery.wall.thickness = 0.4e-3;
  artery.held = {{"first", "start", 5e-3, 1e6}, {"second", "end", 5e-3, 1e6}};
  scene.anatomy.organs = {ball, artery};
  scene.anatomy.support = SupportDefinition{ball.neck - Vec3(0, 0, 0.5e-3), Vec3::UnitZ()};
  scene.laparoscope.look_at = "artery.middle";
  World world = World::create(scene).value();
  EXPECT_TRUE(world.divide("artery", 0.5));
  return world;
}

bool is_blood(const SceneMesh& mesh) { return mesh.material == Material::blood; }

TEST(SpillMesh, BloodIsSeenAsDropsAndAsAFilmWhereItLies) {
  World world = bleeding_world();
  const SceneBuilder builder(world);
  EXPECT_TRUE(spill_meshes(world).empty());
  for (int k = 0; k < 12; ++k) ASSERT_TRUE(world.step({}));
  ASSERT_FALSE(world.field().spill.films.empty());
  const std::uint64_t hash = world.state_hash();
  Scene scene = builder.build(world);
  EXPECT_EQ(std::count_if(scene.meshes.begin(), scene.meshes.end(), is_blood), 1);
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(240, 160);
  ASSERT_TRUE(renderer);
  const Result<Image> seen = renderer->render(scene);
  std::erase_if(scene.meshes, is_blood);
  const Result<Image> without = renderer->render(scene);
  ASSERT_TRUE(seen && without);
  const ImageDifference difference = compare(seen.value(), without.value(), {20, 0, 20, 0}).value();
  EXPECT_GT(difference.differing_pixels, 60);
  EXPECT_GT(difference.largest_blob, 30) << "the film";
  EXPECT_EQ(world.state_hash(), hash) << "looking changes nothing";
}

TEST(SpillMesh, AFilmLiesOnItsSkinAndEndsBelowIt) {
  World world = bleeding_world();
  for (int k = 0; k < 12; ++k) ASSERT_TRUE(world.step({}));
  const double table = world.scene().anatomy.support->point.z();
  double highest = -1, lowest = 1;
  int on_table = 0;
  for (const SceneMesh& mesh : spill_meshes(world))
    for (const Vec3& p : mesh.positions) {
      const double over = p.z() - table;
      if (std::abs(over) > 3e-3) continue;  // a drop that falls
      ++on_table;
      highest = std::max(highest, over);
      lowest = std::min(lowest, over);
    }
  EXPECT_GT(on_table, 20);
  EXPECT_GT(highest, 0.1e-3);
  EXPECT_LT(lowest, 0) << "its rim";
}

}  // namespace
}  // namespace calot
