// Laws of a grasp from first touch to release.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "field/grip.h"
#include "field_rig.h"
#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

TEST(Grasp, VolumeIsKeptPressureRisesAndForcePullsBackWhileLifted) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  SceneDefinition scene = test::grasper_scene();
  scene.instruments[0].port_friction = 0;  // the tissue's force alone is felt
  test::FundusPath path(scene);
  const OrganState rest = path.world.report().organs[0];
  double worst = 0;
  path.driver.watch = [&](const StepReport& report) {
    worst = std::max(worst, std::abs(report.organs[0].volume / rest.volume - 1));
  };
  ASSERT_TRUE(path.grasp()) << path.driver.why();
  const InstrumentState held = path.world.report().instruments[0];
  ASSERT_TRUE(path.lift()) << path.driver.why();
  const InstrumentState lifted = path.world.report().instruments[0];
  EXPECT_EQ(lifted.holds, "gallbladder");
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(path.world.report().organs[0].pressure, rest.pressure);
  // Lifting along `out` does work on the organ: the tissue pulls the tool against it, more than before.
  EXPECT_LT((lifted.force - held.force).dot(path.out), -0.1);
  // The fold lies between the pads, up to a jaw's length behind the tip: a lever shorter by at most a fifth
  // here.
  const Vec3 at_tip = handle_force(path.driver.trocar(), lifted.pose, {}, lifted.force);
  EXPECT_LT(lifted.handle_force.norm(), at_tip.norm());
  EXPECT_LT((lifted.handle_force - at_tip).norm(), 0.2 * at_tip.norm());
}

TEST(Grasp, GraspedSkinStaysWithTheJaw) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  test::FundusField grasped(test::grasper_scene());
  ASSERT_EQ(grasped.grasp(), "");
  auto& [field, fundus, out] = grasped;
  const Organ& organ = field.organs[0];
  const auto in_the_jaws = [&organ, &tool = field.tools[0]] {
    std::map<int, Vec3> local;  // by skin point
    const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
    for (const GripPoint& grip : organ.grips)
      local[grip.skin_point] =
          jaw_frame(tool.trocar, tool.pose, tool.geometry, grip.jaw).inverse() * skin[grip.skin_point];
    return local;
  };
  const std::map<int, Vec3> before = in_the_jaws();
  ASSERT_GT(before.size(), 5u);
  const Vec3 across = out.unitOrthogonal();
  for (const Vec3& tip : {Vec3(fundus + 6e-3 * out), Vec3(fundus + 6e-3 * out + 5e-3 * across)}) {
    ASSERT_EQ(test::move_tip(field, tip, 0.0), "");
    const std::map<int, Vec3> now = in_the_jaws();
    EXPECT_GT(now.size(), 0.9 * static_cast<double>(before.size())) << "but for what is drawn off the pads";
    for (const auto& [point, at] : now)
      EXPECT_LT((at - before.at(point)).tail<2>().norm(), 0.07e-3)
          << "along the pads, by what its springs give";
  }
}

TEST(Grasp, ReleasedOrganReturnsToItsRest) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  test::FundusPath path(test::grasper_scene());
  const OrganState rest = path.world.report().organs[0];
  const std::vector<Vec3> skin = path.world.skin_positions(OrganIndex(0));
  ASSERT_TRUE(path.grasp() && path.lift() && path.release() && path.withdraw()) << path.driver.why();
  const OrganState after = path.world.report().organs[0];
  EXPECT_EQ(path.driver.count(EventKind::release), 1);
  EXPECT_EQ(path.world.report().instruments[0].grip_points, 0);
  EXPECT_EQ(path.world.report().instruments[0].force, Vec3::Zero());
  // Equilibrium is found to 1e-6 of the nodal forces: the energy follows to second order, but for the bile's
  // share, which is linear in a volume kept to 1e-10.
  EXPECT_NEAR(after.energy / rest.energy, 1.0, 1e-6);
  EXPECT_NEAR(after.pressure / rest.pressure, 1.0, 1e-6);
  double away = 0;
  const std::vector<Vec3> now = path.world.skin_positions(OrganIndex(0));
  for (std::size_t i = 0; i < skin.size(); ++i) away = std::max(away, (now[i] - skin[i]).norm());
  EXPECT_LT(away, 1e-6 * 80e-3);  // of the organ's size
}

TEST(Grasp, JawsHoldNothingWhenTheyCloseOnAir) {
  test::FundusPath path(test::grasper_scene(80));
  ASSERT_TRUE(path.driver.go(path.fundus + 15e-3 * path.out, test::open_jaw, 2));
  ASSERT_TRUE(path.driver.go(path.fundus + 15e-3 * path.out, 0.0, 2));
  EXPECT_EQ(path.world.report().instruments[0].holds, "");
  EXPECT_EQ(path.world.report().instruments[0].grip_points, 0);
  ASSERT_EQ(path.driver.events.size(), 1u);
  EXPECT_EQ(path.driver.events[0].kind, EventKind::empty_grasp);
}

TEST(Statistics, SayWhichBodyWasFurthestFromBalanceInEachNewtonStepAndWhoseJawsWereTried) {
  CALOT_SLOW_WHEN_SANITIZED("a whole grasp");
  test::FundusPath path(test::grasper_scene());
  int trials = 0, newton_steps = 0;
  path.driver.watch = [&](const StepReport& report) {
    const SolveStatistics& found = report.statistics;
    int furthest = 0;
    for (const auto& [name, count] : found.furthest) {
      EXPECT_EQ(name, report.organs[0].name);
      furthest += count;
    }
    EXPECT_EQ(furthest, found.newton_iterations);
    EXPECT_LE(found.shifts, found.factorisations);
    EXPECT_LE(found.friction_rounds, found.solves);
    for (const auto& [name, count] : found.jaw_trials) {
      EXPECT_EQ(name, "left");
      trials += count;
    }
    newton_steps += found.newton_iterations;
  };
  ASSERT_TRUE(path.grasp()) << path.driver.why();
  EXPECT_GT(newton_steps, 0);
  EXPECT_GT(trials, 1) << "its pinch is found by trying";
}

/// What the conditions of events were at a step.
struct Conditions {
  bool contact = false, grasp = false, overforce = false, overstretch = false;
};

TEST(Events, AreRaisedOnceWhenTheirConditionBegins) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  SceneDefinition scene = test::grasper_scene();
  scene.instruments[0].force_limit = 1.0;
  scene.anatomy.organs[0].wall.overstretch = 1.3;
  test::FundusPath path(scene);
  Conditions before;
  path.driver.watch = [&](const StepReport& report) {
    const InstrumentState& tool = report.instruments[0];
    const Conditions now{tool.touching, !tool.holds.empty(), tool.load_on(ToolPart::jaws).force.norm() > 1.0,
                         report.organs[0].max_stretch > 1.3};
    const auto expect = [&](EventKind kind, bool begins) {
      const auto is_kind = [&](const WorldEvent& e) { return e.kind == kind; };
      EXPECT_EQ(std::count_if(report.events.begin(), report.events.end(), is_kind), begins)
          << to_text(kind) << " at " << report.time;
    };
    expect(EventKind::contact, now.contact && !before.contact);
    expect(EventKind::grasp, now.grasp && !before.grasp);
    expect(EventKind::release, !now.grasp && before.grasp);
    expect(EventKind::overforce, now.overforce && !before.overforce);
    expect(EventKind::overstretch, now.overstretch && !before.overstretch);
    for (const WorldEvent& event : report.events) {
      EXPECT_EQ(event.time, report.time);
      EXPECT_EQ(event.instrument, event.kind == EventKind::overstretch ? "" : "left");
      const double value = event.kind == EventKind::overforce     ? tool.load_on(ToolPart::jaws).force.norm()
                           : event.kind == EventKind::overstretch ? report.organs[0].max_stretch
                                                                  : 0.0;
      EXPECT_EQ(event.value, value);
    }
    before = now;
  };
  // Twice lifted, so that the force passes its limit twice.
  ASSERT_TRUE(path.grasp() && path.lift() && path.lower() && path.lift() && path.release() && path.withdraw())
      << path.driver.why();
  for (const EventKind kind :
       {EventKind::contact, EventKind::grasp, EventKind::release, EventKind::overstretch})
    EXPECT_EQ(path.driver.count(kind), 1) << to_text(kind);
  EXPECT_EQ(path.driver.count(EventKind::empty_grasp), 0);
  EXPECT_EQ(path.driver.count(EventKind::overforce), 2);
}

TEST(Grasp, PadsPressTheirPinchOnTheAreaThatTheyHold) {
  for (const double deep : {2e-3, 4e-3, 7e-3}) {
    SCOPED_TRACE(deep);
    test::FundusPath path(test::ball_scene());
    const Vec3 there = path.fundus - deep * path.out;
    ASSERT_TRUE(path.driver.go(path.fundus + 4e-3 * path.out, test::open_jaw, 4) &&
                path.driver.go(there, test::open_jaw, 8) && path.driver.go(there, 0, 10))
        << path.driver.why();
    const InstrumentState& tool = path.world.report().instruments[0];
    ASSERT_EQ(tool.holds, "ball");
    const double pinch = path.world.scene().instruments[0].pinch_force;
    EXPECT_NEAR(tool.pad_pressure * held_area(path.world.field(), ToolIndex(0)), pinch, 1e-9);
    ASSERT_TRUE(path.release());
    EXPECT_EQ(tool.pad_pressure, 0);
  }
}

}  // namespace
}  // namespace calot
