// A grip holds by friction: two pads hold twice friction times the pinch, and a fold pulled harder slips
// (Coulomb). Measured where it matters, at the tool.

#include <gtest/gtest.h>

#include <utility>

#include "field_rig.h"
#include "rig.h"
#include "sim/grip_slip.h"
#include "support/long_run.h"

namespace calot {
namespace {

SceneDefinition scene_with(double pinch, double friction, int nodes = 120) {
  SceneDefinition scene = test::grasper_scene(nodes);
  scene.instruments[0].pinch_force = pinch;
  scene.instruments[0].pad_friction = friction;
  return scene;
}

/// What is seen at the tool while a grasped fundus is pulled out by 24 mm.
struct Pull {
  double first_slip = 0;  ///< N, 0: never
  double largest = 0;     ///< N, along the way out, at the end of any step
  int slips = 0, releases = 0;
  std::string why;
};

Pull pull(const SceneDefinition& scene, int steps = 24) {
  test::FundusPath path(scene);
  Pull out;
  EXPECT_TRUE(path.grasp()) << path.driver.why();
  path.driver.watch = [&](const StepReport& report) {
    out.largest = std::max(out.largest, -report.instruments[0].tip_force.dot(path.out));
  };
  if (!path.driver.go(path.fundus + 20e-3 * path.out, 0.0, steps)) out.why = path.driver.why();
  for (const WorldEvent& event : path.driver.events)
    if (event.kind == EventKind::slip && out.first_slip == 0) out.first_slip = event.value;
  out.slips = path.driver.count(EventKind::slip);
  out.releases = path.driver.count(EventKind::release);
  return out;
}

TEST(Slip, BeginsWhereThePullExceedsTwiceFrictionTimesPinch) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  const Pull firm = pull(scene_with(100, 0.8));
  EXPECT_EQ(firm.slips, 0) << firm.why;
  EXPECT_GT(firm.largest, 2.0) << "24 mm of traction";
  for (const auto& [pinch, friction] : {std::pair{0.5, 0.8}, {1.0, 0.4}, {1.0, 0.7}}) {
    const double limit = 2 * friction * pinch;
    const Pull weak = pull(scene_with(pinch, friction));
    EXPECT_EQ(weak.why, "");
    EXPECT_GE(weak.slips, 1) << limit << " N";
    EXPECT_GT(weak.first_slip, limit);
    // The jaws stand within some 10 deg of the way out, and what presses on them from there is not held.
    EXPECT_LT(weak.largest, 1.05 * limit) << limit << " N";
  }
}

TEST(Slip, TheLimitDoesNotDependOnTheMesh) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  const double limit = 2 * 0.8 * 0.5;
  for (int nodes : {120, 180}) {
    test::FundusField grasped(scene_with(0.5, 0.8, nodes));
    ASSERT_EQ(grasped.grasp(), "");
    const Field& field = grasped.field;
    int sliding = 0, held = grip_count(field.organs[0], 0);
    for (int k = 1; k <= 60 && field.tools[0].jaw_stopped; ++k) {
      ASSERT_EQ(grasped.reach((0.2 * k - 4) * 1e-3, 0.0, 1), "");
      const double force = pad_pull(field, 0).norm();
      EXPECT_LE(force, 1.001 * limit) << nodes << " nodes: the friction cone is never left";
      const int before = std::exchange(held, grip_count(field.organs[0], 0));
      if (!field.tools[0].slipping || !field.tools[0].jaw_stopped) continue;
      ++sliding;
      // Skin that has slid off the pads took its share of the pull with it.
      EXPECT_GT(force, 0.8 * limit * held / before) << nodes << " nodes: sliding friction holds on";
    }
    EXPECT_GT(sliding, 2) << nodes;
  }
}

/// A fold of the fundus in weak jaws, taken hold of the same way whatever happens to it then.
struct WeakGrip : test::FundusField {
  WeakGrip() : FundusField(scene_with(0.5, 0.8)) { EXPECT_EQ(grasp(), ""); }
  /// Out to `way` (m) beyond the fundus.
  std::string pull(double way, int steps) { return reach(way, 0.0, steps); }
};

TEST(Slip, EndsAtTheSamePlaceWhateverTheRateOfTheSteps) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  WeakGrip fast, slow;
  const std::size_t held = fast.field.organs[0].grips.size();
  // 4.2 mm at 30 mm/s: 7 steps at 50 Hz, 28 at 200 Hz.
  ASSERT_EQ(fast.pull(0.2e-3, 7), "");
  ASSERT_EQ(slow.pull(0.2e-3, 28), "");
  const std::vector<GripPoint>&a = fast.field.organs[0].grips, &b = slow.field.organs[0].grips;
  EXPECT_LT(a.size(), held) << "it slips, and some of it leaves the pads";
  // Slides stop between 95 and 100% of what the pads hold, some 20 N/m away from each other a fold's way.
  constexpr double apart = 0.05e-3;
  const InstrumentGeometry& g = fast.field.tools[0].geometry;
  const auto same_or_at_the_edge = [&](const std::vector<GripPoint>& some,
                                       const std::vector<GripPoint>& others) {
    int same = 0;
    for (const GripPoint& grip : some) {
      const auto found = std::find_if(others.begin(), others.end(),
                                      [&](const GripPoint& o) { return o.skin_point == grip.skin_point; });
      if (found != others.end()) {
        ++same;
        EXPECT_LT((found->local - grip.local).norm(), apart);
        continue;
      }
      const Vec3 at = grip.local;
      const double to_edge =
          std::min({0.5 * g.jaw_width - std::abs(at.y()), at.z() - g.jaw_rounding, g.jaw_length - at.z()});
      EXPECT_LT(to_edge, apart)
          << "only what lies at a pad's edge may have left it in one and not in the other";
    }
    return same;
  };
  EXPECT_GT(same_or_at_the_edge(a, b), 20);
  EXPECT_GT(same_or_at_the_edge(b, a), 20);
  const double limit = 2 * 0.5 * 0.8;
  EXPECT_NEAR(pad_pull(fast.field, 0).norm() / limit, pad_pull(slow.field, 0).norm() / limit, 0.05);
}

TEST(Slip, AFailedSlipOrReleaseLeavesTheGripAsItWas) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  for (bool slips : {true, false}) {
    WeakGrip grip;
    ASSERT_EQ(grip.pull(-1.0e-3, 4), "");
    Field& field = grip.field;
    const VecX x = field.organs[0].state.x;
    const std::vector<GripPoint> held = field.organs[0].grips;
    field.tools[0].definition.pinch_force = 0.05;
    field.tolerance = 1e-30;  // no equilibrium is as good as that
    SolveStatistics statistics;
    std::string why;
    if (slips) {
      const Result<double> slipped = slip(field, 0, statistics);
      ASSERT_FALSE(slipped);
      why = to_text(slipped.failure());
    } else {
      const Result<bool> released = release(field, 0, statistics);
      ASSERT_FALSE(released);
      why = to_text(released.failure());
    }
    EXPECT_NE(why.find("gallbladder"), std::string::npos) << why;
    EXPECT_EQ(field.organs[0].state.x, x);
    ASSERT_EQ(field.organs[0].grips.size(), held.size());
    for (std::size_t i = 0; i < held.size(); ++i) {
      EXPECT_EQ(field.organs[0].grips[i].skin_point, held[i].skin_point);
      EXPECT_EQ(field.organs[0].grips[i].local, held[i].local);
      EXPECT_EQ(field.organs[0].grips[i].stiffness, held[i].stiffness);
    }
    field.tolerance = 1e-6;
    EXPECT_TRUE(release(field, 0, statistics)) << "and can still be let go";
    EXPECT_TRUE(field.organs[0].grips.empty());
  }
}

TEST(Slip, AFoldPulledOutOfTheJawsIsReleasedAndTheOrganReturnsToItsRest) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  test::FundusPath path(scene_with(0.3, 0.8));
  const double energy = path.world.report().organs[0].energy;
  ASSERT_TRUE(path.grasp()) << path.driver.why();
  ASSERT_TRUE(path.driver.go(path.fundus + 35e-3 * path.out, 0.0, 30)) << path.driver.why();
  EXPECT_GE(path.driver.count(EventKind::slip), 1);
  EXPECT_EQ(path.driver.count(EventKind::release), 1);
  EXPECT_EQ(path.world.report().instruments[0].holds, "");
  EXPECT_EQ(path.world.report().instruments[0].tip_force, Vec3::Zero());
  EXPECT_NEAR(path.world.report().organs[0].energy / energy, 1, 1e-5);
}

}  // namespace
}  // namespace calot
