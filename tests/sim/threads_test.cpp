// Several threads that share a world's work: no bit depends on how many there are.

#include <gtest/gtest.h>

#include "sim/rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

/// Hashes of the steps of a grasp that is lifted, let go and left.
std::vector<std::uint64_t> hashes(const SceneDefinition& scene, int threads) {
  test::FundusPath path(scene, threads);
  std::vector<std::uint64_t> out = {path.world.state_hash()};
  path.driver.watch = [&](const StepReport& report) { out.push_back(report.state_hash); };
  EXPECT_TRUE(path.grasp(3) && path.lift(3) && path.release(2) && path.withdraw(2)) << path.driver.why();
  EXPECT_EQ(path.driver.count(EventKind::grasp), 1);
  return out;
}

TEST(Threads, SameBitsInEachStepOfAGraspWithExtensionsAndFriction) {
  CALOT_SLOW_WHEN_SANITIZED("a grasp at three numbers of threads");
  SceneDefinition scene = test::ball_scene();
  scene.solver.extension_levels = 1;
  scene.instruments[0].friction = 0.2;
  const std::vector<std::uint64_t> one = hashes(scene, 1);
  EXPECT_EQ(hashes(scene, 2), one);
  EXPECT_EQ(hashes(scene, 3), one);
}

TEST(Threads, SameBitsOfAGroupOfBodiesLargeAndSmall) {
  SceneDefinition scene = test::ball_scene();
  for (int k = 0; k < 3; ++k) {
    OrganDefinition tube;
    tube.name = "tube" + std::to_string(k);
    const Vec3 from(-140e-3 + 15e-3 * k, 70e-3, -150e-3);
    tube.shape = TubeShape{.points = {from, from + Vec3(0, 20e-3, 5e-3), from + Vec3(0, 40e-3, 0)}};
    tube.held = {{"end", "start", 10e-3, 1e6}};
    scene.anatomy.organs.push_back(tube);
  }
  const std::vector<std::uint64_t> one = hashes(scene, 1);
  EXPECT_EQ(hashes(scene, 2), one);
}

}  // namespace
}  // namespace calot
