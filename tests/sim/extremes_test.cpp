// What no exercise should ask for, and trainees do: it is followed, or ended with a message, never wrong.

#include <gtest/gtest.h>

#include "field/field_state.h"
#include "field_rig.h"
#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

/// The ball's fundus in the jaws of one grasper and its side in those of another.
struct TwoGraspers : test::FundusField {
  Vec3 side;

  TwoGraspers() : FundusField(test::ball_scene()) {
    side = fundus + Vec3(20e-3, 0, -20e-3);
    test::add_grasper(field, side + Vec3(90e-3, 0, 40e-3));
    field.tools[1].definition = field.tools[0].definition;
    field.tools[1].definition.name = "right";
  }
  /// The tip of one of them, along the way to its trocar from what it holds, in even parts. The failure's text.
  std::string move(std::size_t tool, double height, double jaw, int parts) {
    const Vec3 place = tool == 0 ? fundus : side, trocar = field.tools[tool].trocar;
    const Vec3 tip = place + height * (trocar - place).normalized();
    return turn_to(tool, pose_reaching(trocar, tip, 0, jaw), parts);
  }
  std::string turn_to(std::size_t tool, const InstrumentPose& to, int parts) {
    const InstrumentPose from = field.tools[tool].pose;
    for (int k = 1; k <= parts; ++k) {
      std::vector<InstrumentPose> poses = present_poses(field);
      poses[tool] = interpolate(from, to, static_cast<double>(k) / parts);
      SolveStatistics statistics;
      const auto events = advance(field, poses, statistics);
      if (!events) return to_text(events.failure());
      for (const WorldEvent& event : events.value()) slips += event.kind == EventKind::slip;
    }
    return {};
  }
  std::string take(std::size_t tool) {
    for (const auto& [height, jaw] :
         {std::pair{15e-3, test::open_jaw}, {-4e-3, test::open_jaw}, {-4e-3, 0.0}})
      if (const std::string why = move(tool, height, jaw, 4); !why.empty()) return why;
    return field.tools[tool].jaw_stopped ? "" : "the jaws are empty";
  }
  /// N, of all that acts on the ball from outside; none in equilibrium.
  Vec3 unbalanced() const {
    const Organ& ball = field.organs[0];
    Vec3 sum = test::bed_force(ball) - test::bile_weight(ball) * Vec3::UnitZ();
    for (const ToolLoad& load : tool_loads(field)) sum -= load.force;
    return sum;
  }
  int slips = 0;
};

TEST(Extremes, TwoGraspersThatFightOverAnOrganAreAnsweredInBalanceUntilAFoldSlips) {
  CALOT_SLOW_WHEN_SANITIZED("two folds pulled out of the jaws");
  TwoGraspers both;
  const double volume = both.field.organs[0].state.volume;
  ASSERT_EQ(both.take(0), "");
  ASSERT_EQ(both.take(1), "");
  double largest = 0;
  for (double way : {6e-3, 14e-3})
    for (std::size_t tool : {0, 1}) {
      ASSERT_EQ(both.move(tool, way, 0, 3), "") << way;
      const double pull = tool_loads(both.field)[tool].force.norm();
      largest = std::max(largest, pull);
      EXPECT_LT(both.unbalanced().norm(), 1e-4 * std::max(1.0, pull)) << way;
      EXPECT_NEAR(both.field.organs[0].state.volume, volume, 1e-9 * volume);
      EXPECT_LT(deepest_penetration(both.field), 0.1e-3);
    }
  EXPECT_GT(largest, 1.0) << "else they hardly fought";
}

TEST(Extremes, AFoldTurnedByAWholeTurnIsFollowedOrSaysWhyNot) {
  CALOT_SLOW_WHEN_SANITIZED("a fold turned by a whole turn");
  TwoGraspers one;
  ASSERT_EQ(one.take(0), "");
  const InstrumentPose held = one.field.tools[0].pose;
  std::string why;
  double turned = 0;
  for (int k = 1; k <= 6 && why.empty(); ++k) {
    const FieldState before = field_state(one.field);
    InstrumentPose to = held;
    to.roll = held.roll + k * 60 * units::deg;
    why = one.turn_to(0, to, 4);
    if (!why.empty()) break;
    turned = 60.0 * k;
    EXPECT_LT(one.unbalanced().norm(), 1e-4) << turned;
    EXPECT_LT(deepest_penetration(one.field), 0.1e-3) << turned;
  }
  RecordProperty("turned_deg", static_cast<int>(turned));
  EXPECT_GE(turned, 120) << "a hand turns that far: " << why;
  EXPECT_TRUE(why.empty() || why.find("move more slowly or less far") != std::string::npos) << why;
}

TEST(Extremes, AStonePressedOnTheGroundSlipsAsideOrSaysThatItCannotAndIsNeverEntered) {
  constexpr double radius = 6e-3, floor = -120e-3;
  SceneDefinition scene = test::scene_with(InstrumentType::bipolar_electrode);
  OrganDefinition stone;
  stone.name = "stone";
  stone.shape = RigidShape{.rounding = radius, .centre = Vec3(-80e-3, 70e-3, floor + radius)};
  scene.anatomy = {};
  scene.anatomy.organs = {stone};
  scene.anatomy.table_head_up = scene.anatomy.table_left_down = 0;
  scene.anatomy.ground = {{.name = "floor", .point = Vec3(0, 0, floor), .friction = 0.2}};
  scene.laparoscope.look_at = "stone.centre";
  scene.solver.motion = SolverMotion::dynamics;
  Result<World> made = World::create(scene);
  ASSERT_TRUE(made) << to_text(made.failure());
  World& world = made.value();
  const Vec3 begin = world.landmark("stone.centre");
  test::Driver driver(world);
  const Vec3 top(-80e-3, 70e-3, floor + 2 * radius);
  double largest = 0;
  bool stayed_behind = false;
  driver.watch = [&](const StepReport& report) {
    largest = std::max(largest, report.instruments[0].force.norm());
    stayed_behind |= !report.balanced;
    EXPECT_LT(world.deepest_penetration(), 0.1e-3);
  };
  ASSERT_TRUE(driver.go(top + 2e-3 * Vec3::UnitZ(), 0, 4)) << driver.why();
  // 3 mm down, of which 1 mm is into the stone: nothing of the three gives way.
  const bool followed = driver.go(top - 1e-3 * Vec3::UnitZ(), 0, 30);
  // Twenty times its weight. Pressed on its top it lies as on a needle's point: it slips as soon as a solver looks aside.
  EXPECT_GT(largest, 0.3) << "else nothing was pressed";
  const Vec3 now = world.landmark("stone.centre");
  EXPECT_GT(now.z(), floor - 0.1e-3) << "a place on the stone's skin";
  if (followed) {
    EXPECT_TRUE(stayed_behind || std::hypot(now.x() - begin.x(), now.y() - begin.y()) > 1e-3)
        << "it slipped aside, or steps said that they ended before the electrode was where it was to be";
  } else {
    EXPECT_NE(driver.why().find("move more slowly or less far"), std::string::npos) << driver.why();
  }
}

}  // namespace
}  // namespace calot
