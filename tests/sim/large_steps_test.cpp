// Fast instruments: the motion is cut into parts the elements allow, so speed changes neither where the organ
// ends up nor who is outside of whom.

#include <gtest/gtest.h>

#include "base/rng.h"
#include "geometry/winding.h"
#include "milestone.h"
#include "rig.h"
#include "support/bodies.h"
#include "support/long_run.h"

namespace calot {
namespace {

TEST(LargeSteps, AYankEndsWhereASlowPullEnds) {
  CALOT_SLOW_WHEN_SANITIZED("fast motions in many parts");
  // Jaws that tissue stops end where they press with their pinch to pinch_tolerance; those that a fold fills stand still.
  test::FundusPath path(test::with_strong_jaws(test::ball_scene()));
  ASSERT_TRUE(path.grasp()) << path.driver.why();
  const test::Milestone grasped(path);
  const auto pulled = [&](int steps) {
    grasped.go_back();
    EXPECT_TRUE(path.lift(steps)) << path.driver.why();
    EXPECT_EQ(path.driver.count(EventKind::slip), 0);
    return path.world.skin_positions(OrganIndex(0));
  };
  // 8 mm: 400 mm/s in one step, 20 mm/s in twenty.
  const std::vector<Vec3> yanked = pulled(1), slow = pulled(20);
  double furthest = 0;
  for (std::size_t i = 0; i < slow.size(); ++i) furthest = std::max(furthest, (yanked[i] - slow[i]).norm());
  EXPECT_LT(furthest, 1e-6) << "m; equilibrium is met to 1e-6 of the nodal forces";
}

TEST(LargeSteps, ATipAt500MillimetresASecondNeverGoesThroughTheWall) {
  CALOT_SLOW_WHEN_SANITIZED("fast motions in many parts");
  SceneDefinition scene = test::ball_scene();
  const World rest = World::create(scene).value();
  const std::vector<Vec3> skin = rest.skin_positions(OrganIndex(0)),
                          normals = rest.skin_normals(OrganIndex(0));
  Rng rng(5);
  int dented = 0;
  for (int poke = 0; poke < 6; ++poke) {
    const auto p = static_cast<std::size_t>(rng.uniform(0, static_cast<double>(skin.size())));
    const Vec3 place = skin[p], out = (normals[p] + 0.5 * test::random_vector(rng, 1.0)).normalized();
    scene.ports = {{"umbilical", Vec3::Zero()}, {"right_subcostal", place + 150e-3 * out}};
    World world = World::create(scene).value();
    test::Driver driver(world, rng.uniform(-3, 3));
    driver.watch = [&](const StepReport& report) {
      const InstrumentState& tool = report.instruments[0];
      const Vec3 back = (driver.trocar() - tool.tip).normalized();
      for (double along : {0.5e-3, 5e-3, 15e-3, 30e-3})
        EXPECT_LT(std::abs(winding_number(tool.tip + along * back, world.skin_positions(OrganIndex(0)),
                                          world.skin(OrganIndex(0)).triangles)),
                  0.01)
            << "poke " << poke << ", " << 1e3 * along << " mm behind the tip";
      EXPECT_LT(world.deepest_penetration(), 0.1e-3);
    };
    ASSERT_TRUE(driver.go(place + 8e-3 * out, 0.0, 3)) << driver.why();
    // 10 mm a step at 50 Hz, until the tip stands 12 mm deeper than the wall was.
    const bool followed = driver.go(place - 12e-3 * out, 0.0, 2);
    if (!followed) {
      EXPECT_EQ(driver.failure->kind, FailureKind::simulation) << driver.why();
    }
    dented += followed && world.report().instruments[0].touching;
  }
  EXPECT_GE(dented, 4);
}

}  // namespace
}  // namespace calot
