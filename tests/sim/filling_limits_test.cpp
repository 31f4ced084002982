// What building a world may take: time that ends, memory that fits.

#include <gmock/gmock.h>

#include "organs/body_kinds.h"
#include "rig.h"
#include "world/world.h"

namespace calot {
namespace {

/// A ball whose filling takes tens of Newton iterations.
OrganDefinition swollen_ball() {
  OrganDefinition organ = test::grasper_scene(61).anatomy.organs.front();
  organ.bile.fill_volume = 60e-6;  // m^3
  return organ;
}

Result<RestedOrgan> filled(FillingLimits& limits) {
  return make_organ(swollen_ball(), {}, Vec3::UnitZ(), 1e-6, 0, &limits);
}

TEST(FillingLimits, FillingEndsWhereItsIterationsAreUsedUpAndNamesTheBile) {
  FillingLimits plenty;
  const std::int64_t given = plenty.node_iterations;
  ASSERT_TRUE(filled(plenty));
  const std::int64_t needed = given - plenty.node_iterations;
  EXPECT_GT(needed, 10 * 61);
  FillingLimits enough{nullptr, needed + 1}, scarce{nullptr, needed};
  EXPECT_TRUE(filled(enough));
  const Result<RestedOrgan> ended = filled(scarce);
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.failure().kind, FailureKind::resource);
  EXPECT_EQ(ended.failure().problems.at(0).place.path, ".bile");
  EXPECT_THAT(to_text(ended.failure()), ::testing::HasSubstr("fewer nodes"));
}

TEST(FillingLimits, AWorldThatIsStoppedWhileItFillsSaysSo) {
  const std::atomic<bool> stop = true;
  const Result<World> world = World::create(test::grasper_scene(61), &stop);
  ASSERT_FALSE(world);
  EXPECT_EQ(world.failure().kind, FailureKind::interrupted);
  EXPECT_THAT(to_text(world.failure()), ::testing::HasSubstr("interrupted while organ"));
}

TEST(FillingLimits, LevelsThatWouldNotFitIntoMemoryAreNamed) {
  SceneDefinition scene = test::grasper_scene(1000);
  scene.solver.extension_levels = 3;
  EXPECT_TRUE(mesh_problems(scene).empty());
  scene.solver.extension_levels = 4;
  const std::vector<Problem> problems = mesh_problems(scene);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].place.path, "scene.solver.extensions.levels");
  EXPECT_THAT(problems[0].message, ::testing::HasSubstr("1000 nodes are 256000 nodes"));
  scene.anatomy.organs[0].extensions = false;
  EXPECT_TRUE(mesh_problems(scene).empty()) << "an organ without extensions has no finer levels";
}

}  // namespace
}  // namespace calot
