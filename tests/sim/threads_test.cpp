// Several threads that share a world's work: no bit depends on how many there are.

#include <gtest/gtest.h>

#include "sim/rig.h"
#include "sim/triangle_rig.h"
#include "support/long_run.h"
#include "world/critical_view.h"
#include "world/sight.h"

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

/// Steps of a grasp in a field with strands and a lobe, and what is seen of its triangle then.
std::vector<StepReport> grasped(int threads, CriticalView& seen) {
  SceneDefinition scene = test::triangle_scene();
  scene.anatomy.organs[1] = test::lobe_behind();
  scene.solver.motion = SolverMotion::dynamics;
  test::FundusPath path(scene, threads);
  std::vector<StepReport> out;
  path.driver.watch = [&](const StepReport& report) { out.push_back(report); };
  EXPECT_TRUE(path.grasp(3) && path.lift(3)) << path.driver.why();
  seen = critical_view(
      path.world.field(),
      {test::beside_neck(2, 0, -3), test::beside_neck(37, 0, -19), test::beside_neck(37, 0, -3)},
      Sight(path.world.field(), test::beside_neck(22, -100, 0)), {});
  return out;
}

TEST(Threads, SameBitsAndReportsOfAFieldWithStrandsAndALobe) {
  CALOT_SLOW_WHEN_SANITIZED("a field at three numbers of threads");
  CriticalView by_one, by_more;
  const std::vector<StepReport> one = grasped(1, by_one);
  ASSERT_GT(one.size(), 5u);
  EXPECT_GT(by_one.front.open, 0);
  for (int threads : {2, 3}) {
    const std::vector<StepReport> more = grasped(threads, by_more);
    ASSERT_EQ(more.size(), one.size());
    for (std::size_t k = 0; k < one.size(); ++k) {
      EXPECT_EQ(more[k].state_hash, one[k].state_hash);
      for (std::size_t organ = 0; organ < one[k].organs.size(); ++organ) {
        EXPECT_EQ(more[k].organs[organ].energy, one[k].organs[organ].energy);
        EXPECT_EQ(more[k].organs[organ].max_stretch, one[k].organs[organ].max_stretch);
      }
    }
    EXPECT_EQ(by_more.front.open, by_one.front.open);
    EXPECT_EQ(by_more.front.cleared, by_one.front.cleared);
    EXPECT_EQ(by_more.back.cleared, by_one.back.cleared);
    EXPECT_EQ(by_more.points(), by_one.points());
  }
}

}  // namespace
}  // namespace calot
