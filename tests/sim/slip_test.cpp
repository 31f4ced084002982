// A grip holds by friction (Coulomb): two pads at half their angle a hold 2 pinch (friction cos a - sin a) of a fold
// that fills them, and one that is pulled harder slips. Measured where it matters, at the tool.

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "acts/grip_slip.h"
#include "field/field_state.h"
#include "field_rig.h"
#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

SceneDefinition scene_with(double pinch, double friction, int nodes = 61) {
  SceneDefinition scene = test::ball_scene();
  scene.anatomy.organs[0].nodes = nodes;
  scene.instruments[0].pinch_force = pinch;
  scene.instruments[0].pad_friction = friction;
  return scene;
}

/// A fold of the fundus in the jaws: taken hold of once, and as it was then for whoever asks.
struct HeldFold : test::FundusField {
  FieldState taken;

  explicit HeldFold(int nodes = 61) : FundusField(scene_with(100, 0.8, nodes)) {
    EXPECT_EQ(grasp(), "") << "by jaws that are strong enough to close until it fills them";
    field.tools[0].definition.pinch_force = 0.5;
    // What was wound up by jaws so strong turns between such weak ones.
    EXPECT_EQ(reach(-4e-3, 0.0, 1), "");
    taken = field_state(field);
  }
  /// Out to `way` (m) beyond the fundus.
  std::string pull(double way, int steps) { return reach(way, 0.0, steps); }
};

HeldFold& held_fold(double pinch = 0.5, double friction = 0.8) {
  static HeldFold fold;
  restore(fold.field, fold.taken);
  fold.field.step_time = 0;
  fold.field.tools[0].definition.pinch_force = pinch;
  fold.field.tools[0].definition.pad_friction = friction;
  return fold;
}

/// What is seen at the tool while a grasped fundus is pulled out by 24 mm, or off the pads.
struct Pull {
  double first_slip = 0;  ///< N, 0: never
  double largest = 0;     ///< N, along the way out, at the end of any step
  int slips = 0;
};

Pull pull(double pinch, double friction, int steps) {
  HeldFold& fold = held_fold(pinch, friction);
  Pull out;
  for (int k = 1; k <= steps && fold.field.tools[0].jaw_stopped; ++k) {
    const Vec3 tip = fold.fundus + (24e-3 * k / steps - 4e-3) * fold.out;
    SolveStatistics statistics;
    const auto events =
        advance(fold.field, {pose_reaching(fold.field.tools[0].trocar, tip, 0, 0)}, statistics);
    if (!events) {
      ADD_FAILURE() << to_text(events.failure());
      break;
    }
    out.largest = std::max(out.largest, -test::tool_force(fold.field).dot(fold.out));
    for (const WorldEvent& event : events.value()) {
      if (event.kind != EventKind::slip) continue;
      if (out.slips++ == 0) out.first_slip = event.value;
    }
  }
  return out;
}

TEST(Slip, BeginsWhereThePullExceedsWhatTwoPadsHoldOfAWedge) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  const Pull firm = pull(100, 0.8, 6);
  EXPECT_EQ(firm.slips, 0);
  EXPECT_GT(firm.largest, 2.0) << "24 mm of traction";
  for (const auto& [pinch, friction] : {std::pair{0.5, 0.8}, {1.0, 0.4}, {1.0, 0.7}}) {
    const Pull weak = pull(pinch, friction, 24);
    const double a = 0.5 * held_fold().field.tools[0].pose.jaw;
    EXPECT_GT(a, 2 * units::deg) << "else what the pads press out counts for nothing";
    const double limit = 2 * pinch * (friction * std::cos(a) - std::sin(a));
    EXPECT_GE(weak.slips, 1) << limit << " N";
    EXPECT_GT(weak.first_slip, limit);
    // The jaws stand within some 10 deg of the way out, and what presses on them from there is not held.
    EXPECT_LT(weak.largest, 1.05 * limit) << limit << " N";
  }
}

TEST(Slip, TheLimitDoesNotDependOnTheMesh) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  const double limit = 2 * 0.8 * 0.5;
  for (int nodes : {61, 120}) {
    std::optional<HeldFold> fine;
    if (nodes != 61) fine.emplace(nodes);
    test::FundusField& grasped = fine ? *fine : held_fold();
    const Field& field = grasped.field;
    int sliding = 0, held = grip_count(field.organs[0], ToolIndex(0));
    for (int k = 1; k <= 60 && field.tools[0].jaw_stopped; ++k) {
      ASSERT_EQ(grasped.reach((0.2 * k - 4) * 1e-3, 0.0, 1), "");
      const double force = asked_of_friction(field.tools[0], pad_load(field, ToolIndex(0)).pull).norm();
      EXPECT_LE(force, 1.001 * limit) << nodes << " nodes: the friction cone is never left";
      const int before = std::exchange(held, grip_count(field.organs[0], ToolIndex(0)));
      if (!field.tools[0].slipping || !field.tools[0].jaw_stopped) continue;
      ++sliding;
      // Skin that has slid off the pads took its share of the pull with it.
      EXPECT_GT(force, 0.8 * limit * held / before) << nodes << " nodes: sliding friction holds on";
    }
    EXPECT_GT(sliding, 2) << nodes;
  }
}

/// What is seen of a fold that its jaws turn about their shaft, in steps of 2 degrees.
struct Turned {
  double largest = 0, adhering = 0;  ///< N m of couple; N that a pad is drawn off by, summed over its points
  double drawn_off = 0;              ///< m, of the point furthest off its pad
  int slips = 0, turns = 0, releases = 0, grasps = 0;
};

Turned turned(HeldFold& fold, int degrees) {
  Turned out;
  InstrumentPose pose = fold.field.tools[0].pose;
  for (int k = 0; k < degrees / 2; ++k) {
    pose.roll += 2 * units::deg;
    pose.jaw = 0;  // the hand goes on closing
    SolveStatistics statistics;
    const auto events = advance(fold.field, {pose}, statistics);
    if (!events) {
      ADD_FAILURE() << to_text(events.failure());
      break;
    }
    for (const WorldEvent& event : events.value()) {
      out.slips += event.kind == EventKind::slip;
      out.turns += event.kind == EventKind::turn;
      out.releases += event.kind == EventKind::release;
      out.grasps += event.kind == EventKind::grasp;
    }
    out.largest = std::max(out.largest, std::abs(pad_load(fold.field, ToolIndex(0)).couple));
    const Organ& organ = fold.field.organs[0];
    const GripSprings springs = grip_springs(organ, fold.field.tools, present_poses(fold.field));
    double adhering = 0;
    for (std::size_t i = 0; i < springs.row.size(); ++i) {
      const Vec3 at = organ.body->skin_point(springs.row[i], organ.state.x);
      adhering -= std::min(0.0, springs.sample(i, at).gradient.dot(springs.pad[i]));
      out.drawn_off = std::max(out.drawn_off, springs.pad[i].dot(springs.target[i] - at));
    }
    out.adhering = std::max(out.adhering, adhering);
  }
  return out;
}

TEST(Slip, NothingAdheresToThePadsAndWhatIsDrawnOffLeavesThem) {
  CALOT_SLOW_WHEN_SANITIZED("a fold turned");
  HeldFold& fold = held_fold(100);
  const int held = grip_count(fold.field.organs[0], ToolIndex(0));
  const Turned seen = turned(fold, 80);
  EXPECT_LT(seen.adhering, 1e-9);
  EXPECT_GT(seen.drawn_off, 0.05e-3) << "else nothing asks for it";
  EXPECT_LT(seen.drawn_off, 1.01 * pad_reach);
  EXPECT_LT(grip_count(fold.field.organs[0], ToolIndex(0)), held);
  EXPECT_TRUE(both_pads_hold(fold.field, ToolIndex(0)));
}

TEST(Slip, AFoldTurnsBetweenThePadsBeyondTheirCoupleAndIsLostByAWholeTurn) {
  CALOT_SLOW_WHEN_SANITIZED("a fold turned");
  HeldFold& fold = held_fold(6.8);
  const double limit = couple_limit(fold.field.tools[0]);
  const Turned seen = turned(fold, 360);
  EXPECT_GE(seen.turns, 1);
  EXPECT_EQ(seen.slips, 0) << "none before the jaws lose it";
  EXPECT_GT(seen.largest, 0.9 * limit) << "it is turned until they hold no more";
  EXPECT_LT(seen.largest, 1.001 * limit);
  EXPECT_EQ(seen.releases, 1);
  EXPECT_EQ(seen.grasps, 0) << "closed jaws do not catch again what they lost";
}

/// What the same fold, turned until the pads hold it just so, does when they hold a little less.
TEST(Slip, WhereMassesCountAFoldTurnsByOneSlideAStep) {
  CALOT_SLOW_WHEN_SANITIZED("a fold turned");
  HeldFold& fold = held_fold(100);
  turned(fold, 40);
  Field& field = fold.field;
  const double share = asked_of_pads(field, ToolIndex(0)).share;
  ASSERT_TRUE(asked_of_pads(field, ToolIndex(0)).turns);
  field.tools[0].definition.pinch_force *= share / 1.02;
  field.step_time = 0.04;
  SolveStatistics statistics;
  const Result<Slipped> slipped = slip(field, ToolIndex(0), statistics);
  ASSERT_TRUE(slipped);
  EXPECT_TRUE(slipped->turned);
  EXPECT_EQ(statistics.solves, 1);
  EXPECT_FALSE(statistics.cut_short);
  EXPECT_LT(asked_of_pads(field, ToolIndex(0)).share, 1.001);
  EXPECT_GT(asked_of_pads(field, ToolIndex(0)).share, turning_share);
}

TEST(Slip, WhereMassesCountWhatIsDrawnOffItsPadLeavesWithoutASolve) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  for (double step_time : {0.0, 0.04}) {
    HeldFold& fold = held_fold(100);
    Field& field = fold.field;
    field.organs[0].grips[0].local.x() += 2 * pad_reach + field.tools[0].geometry.jaw_width;
    const int held = grip_count(field.organs[0], ToolIndex(0));
    field.step_time = step_time;
    SolveStatistics statistics;
    ASSERT_TRUE(leave_pads(field, ToolIndex(0), statistics));
    let_left_go(field);
    EXPECT_EQ(grip_count(field.organs[0], ToolIndex(0)), held - 1) << step_time;
    EXPECT_EQ(statistics.solves == 0, step_time > 0) << "else it goes along equilibria";
  }
}

TEST(Slip, EndsAtTheSamePlaceWhateverTheRateOfTheSteps) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  constexpr double pinch = 1.5, friction = 0.3;  // N: what it is wound up by is held
  const std::size_t held = held_fold(pinch, friction).field.organs[0].grips.size();
  const auto pulled = [&](int steps, std::vector<GripPoint>& grips) {
    HeldFold& fold = held_fold(pinch, friction);
    EXPECT_EQ(fold.pull(0.2e-3, steps), "");
    grips = fold.field.organs[0].grips;
    return pad_load(fold.field, ToolIndex(0)).pull.norm();
  };
  // 4.2 mm at 30 mm/s: 7 steps at 50 Hz, 28 at 200 Hz.
  std::vector<GripPoint> a, b;
  const double fast = pulled(7, a), slow = pulled(28, b);
  EXPECT_LT(a.size(), held) << "it slips, and some of it leaves the pads";
  // Slides stop between 95 and 100% of what the pads hold, some 20 N/m away from each other a fold's way.
  constexpr double apart = 0.05e-3;
  const InstrumentGeometry& g = held_fold().field.tools[0].geometry;
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
  const double limit = 2 * pinch * friction;
  EXPECT_NEAR(fast / limit, slow / limit, 0.05);
}

TEST(Slip, AFailedSlipOrReleaseLeavesTheGripAsItWas) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  for (bool slips : {true, false}) {
    HeldFold& fold = held_fold();
    ASSERT_EQ(fold.pull(-1.0e-3, 2), "");
    Field& field = fold.field;
    const VecX x = field.organs[0].state.x;
    const std::vector<GripPoint> held = field.organs[0].grips;
    field.tools[0].definition.pinch_force = 0.05;
    field.tolerance = 1e-30;  // no equilibrium is as good as that
    SolveStatistics statistics;
    std::string why;
    if (slips) {
      const Result<Slipped> slipped = slip(field, ToolIndex(0), statistics);
      ASSERT_FALSE(slipped);
      why = to_text(slipped.failure());
    } else {
      const Result<bool> released = release(field, ToolIndex(0), statistics);
      ASSERT_FALSE(released);
      why = to_text(released.failure());
    }
    EXPECT_NE(why.find("ball"), std::string::npos) << why;
    EXPECT_EQ(field.organs[0].state.x, x);
    ASSERT_EQ(field.organs[0].grips.size(), held.size());
    for (std::size_t i = 0; i < held.size(); ++i) {
      EXPECT_EQ(field.organs[0].grips[i].skin_point, held[i].skin_point);
      EXPECT_EQ(field.organs[0].grips[i].local, held[i].local);
      EXPECT_EQ(field.organs[0].grips[i].stiffness, held[i].stiffness);
    }
    field.tolerance = 1e-6;
    EXPECT_TRUE(release(field, ToolIndex(0), statistics)) << "and can still be let go";
    EXPECT_TRUE(field.organs[0].grips.empty());
  }
}

TEST(Slip, WhereNothingIsHeldAReleaseSolvesNothing) {
  Field field = test::FundusField(test::ball_scene()).field;
  SolveStatistics statistics;
  ASSERT_TRUE(release(field, ToolIndex(0), statistics));
  EXPECT_EQ(statistics.solves, 0);
}

TEST(Slip, AFoldPulledOutOfTheJawsIsReleasedAndTheOrganReturnsToItsRest) {
  CALOT_SLOW_WHEN_SANITIZED("folds pulled through the jaws");
  SceneDefinition scene = test::grasper_scene();
  scene.instruments[0].pinch_force = 0.3;
  scene.instruments[0].pad_friction = 0.8;
  test::FundusPath path(scene);
  const double energy = path.world.report().organs[0].energy;
  ASSERT_TRUE(path.grasp()) << path.driver.why();
  ASSERT_TRUE(path.driver.go(path.fundus + 35e-3 * path.out, 0.0, 12)) << path.driver.why();
  EXPECT_GE(path.driver.count(EventKind::slip), 1);
  EXPECT_EQ(path.driver.count(EventKind::release), 1);
  EXPECT_EQ(path.world.report().instruments[0].holds, "");
  EXPECT_EQ(path.world.report().instruments[0].force, Vec3::Zero());
  EXPECT_NEAR(path.world.report().organs[0].energy / energy, 1, 1e-5);
}

}  // namespace
}  // namespace calot
