// Hands that give way: a tool is where it is commanded to be until the tissue or another tool presses it with more than its
// hand holds.

#include "acts/hands.h"

#include <gtest/gtest.h>

#include "field/field_state.h"
#include "rig.h"

namespace calot {
namespace {

TEST(Hands, ATipIsPressedWithNoMoreThanItsHandHoldsAndComesBackToItsCommand) {
  constexpr double strength = 0.5;  // N
  SceneDefinition scene = test::ball_scene();
  scene.instruments[0].hand_force = strength;
  World world = World::create(scene).value();
  const Vec3 top = world.landmark("ball.fundus"), out = world.landmark_normal("ball.fundus");
  test::Driver driver(world);
  ASSERT_TRUE(driver.go(top + 3e-3 * out, 0, 4)) << driver.why();
  double largest = 0, lag = 0, tight = 0;
  driver.watch = [&](const StepReport& report) {
    const InstrumentState& tool = report.instruments[0];
    largest = std::max(largest, tool.at_tip.norm());
    lag = std::max(lag, tool.lag);
    if (tool.lag > 0.1e-3) tight = std::max(tight, std::abs(tool.at_tip.norm() - strength));
  };
  ASSERT_TRUE(driver.go(top - 10e-3 * out, 0, 40)) << driver.why();
  EXPECT_GT(lag, 2e-3) << "else the hand had nothing to give way to";
  // By the secant of the step before: the force grows with the square of the way here, of which a step is a thirtieth.
  EXPECT_LT(largest, 1.1 * strength);
  EXPECT_LT(tight, 0.15);
  const double deep = world.report().instruments[0].lag;
  ASSERT_TRUE(driver.stay(20)) << driver.why();
  EXPECT_NEAR(world.report().instruments[0].at_tip.norm(), strength, 0.01);
  EXPECT_NEAR(world.report().instruments[0].lag, deep, 0.5e-3);
  driver.watch = [](const StepReport&) {};
  ASSERT_TRUE(driver.go(top + 3e-3 * out, 0, 40)) << driver.why();
  EXPECT_EQ(world.report().instruments[0].lag, 0) << "it is exactly where it is commanded to be";
}

TEST(Hands, WhatIsHeldIsPulledWithNoMoreThanItsHandHolds) {
  constexpr double strength = 2;  // N
  SceneDefinition scene = test::ball_scene();
  scene.instruments[0].hand_force = strength;
  OrganDefinition other = test::bedded_ball();
  other.name = "other";
  for (Vec3* pole : {&other.neck, &other.fundus}) pole->x() += 60e-3;
  scene.anatomy.organs.push_back(other);
  World world = World::create(scene).value();
  const Vec3 top = world.landmark("ball.fundus"), out = world.landmark_normal("ball.fundus");
  test::Driver driver(world);
  ASSERT_TRUE(driver.go(top + 3e-3 * out, test::open_jaw, 4) &&
              driver.go(top - 4e-3 * out, test::open_jaw, 8) && driver.go(top - 4e-3 * out, 0, 10))
      << driver.why();
  const InstrumentState& tool = world.report().instruments[0];
  ASSERT_EQ(tool.holds, "ball");
  EXPECT_EQ(tool.lag, 0) << "jaws that rest on a fold are no lag";
  ASSERT_TRUE(driver.go(top + 15e-3 * out, 0, 40) && driver.stay(20)) << driver.why();
  ASSERT_EQ(tool.holds, "ball");
  EXPECT_GT(tool.lag, 2e-3) << "else the hand had nothing to give way to";
  EXPECT_NEAR(tool.at_tip.norm(), strength, 1e-3);
  // What pulled at the hand is gone from one step to the next.
  ASSERT_TRUE(world.remove("ball", "taken out"));
  ASSERT_TRUE(driver.stay(1)) << driver.why();
  EXPECT_EQ(tool.lag, 0);
  EXPECT_TRUE(tool.tip.allFinite());
}

TEST(Hands, NoForceOfAStepOutOfBalanceThrowsAToolAside) {
  const World world = World::create(test::ball_scene()).value();
  Field field = world.field();
  Tool& tool = field.tools[0];
  InstrumentState last = world.report().instruments[0];
  const Vec3 away = Vec3(1, 2, 2) / 3;
  last.at_tip = 5e3 * away;
  last.roll_torque = 40;  // N m
  tool.tissue_stiffness = 100;
  tool.roll_stiffness = 1e-3;
  const InstrumentPose to = bring_tools(field, {tool.pose}, {last})[0];
  const Vec3 way = tip_position(tool.trocar, to, tool.geometry) - last.tip;
  EXPECT_NEAR(way.dot(away), 10e-3, 1e-6) << "m, not 50";
  EXPECT_NEAR(std::abs(to.roll - tool.pose.roll), 0.35, 1e-9) << "rad, not 40000";
}

TEST(Hands, AFoldIsTwistedWithNoMoreThanItsHandHoldsAboutTheShaft) {
  SceneDefinition scene = test::ball_scene();
  scene.instruments[0].hand_force = 1;  // N: 10 mN m
  test::FundusPath path(scene);
  ASSERT_TRUE(path.grasp()) << path.driver.why();
  const InstrumentState& tool = path.world.report().instruments[0];
  ASSERT_EQ(tool.holds, "ball");
  StepInput input{{path.world.field().tools[0].command}};
  double torque = 0, lag = 0;
  const auto roll_to = [&](double roll) {
    const int steps = 72;
    const double from = input.instruments[0].roll;
    for (int k = 1; k <= steps; ++k) {
      input.instruments[0].roll = from + k * (roll - from) / steps;
      const Result<StepReport> done = path.world.step(input);
      ASSERT_TRUE(done) << to_text(done.failure());
      torque = std::max(torque, std::abs(tool.roll_torque));
      lag = std::max(lag, tool.roll_lag);
    }
  };
  roll_to(2 * std::numbers::pi);
  EXPECT_EQ(tool.holds, "ball");
  EXPECT_LT(torque, 1.1 * 10e-3);
  EXPECT_GT(lag, 1) << "else the hand had nothing to give way to";
  roll_to(0);
  EXPECT_EQ(tool.roll_lag, 0) << "it is exactly where it is commanded to be";
}

TEST(Hands, APortsSealResistsAShaftThatSlidesThroughItWhicheverWay) {
  SceneDefinition scene = test::ball_scene();
  scene.instruments[0].port_friction = 0.7;
  World world = World::create(scene).value();
  const Vec3 trocar = world.port_position(scene.instruments[0].port);
  const InstrumentPose start = world.report().instruments[0].pose;
  StepInput input;
  const auto felt_at = [&](double insertion) {
    InstrumentPose pose = start;
    pose.insertion = insertion;
    input.instruments = {pose};
    const StepReport report = world.step(input).value();
    return report.instruments[0].handle_force.dot((report.instruments[0].tip - trocar).normalized());
  };
  // At 50 Hz 0.2 mm a step are 10 mm/s, beyond which the seal's force grows no more; 0.05 mm are half of the full one.
  EXPECT_NEAR(felt_at(start.insertion + 0.2e-3), -0.7, 1e-9);
  EXPECT_NEAR(felt_at(start.insertion + 0.25e-3), -0.35, 1e-9);
  EXPECT_EQ(felt_at(start.insertion + 0.25e-3), 0);
  EXPECT_NEAR(felt_at(start.insertion - 1e-3), 0.7, 1e-9);
}

TEST(Hands, APortsSealIsFeltAsBeforeWhenAnOrganHasGoneAfterTheStep) {
  SceneDefinition scene = test::ball_scene();
  scene.instruments[0].port_friction = 0.7;
  OrganDefinition other = test::bedded_ball();
  other.name = "other";
  for (Vec3* pole : {&other.neck, &other.fundus}) pole->x() += 60e-3;
  scene.anatomy.organs.push_back(other);
  World world = World::create(scene).value();
  StepInput input{{world.report().instruments[0].pose}};
  input.instruments[0].insertion += 0.2e-3;
  ASSERT_TRUE(world.step(input));
  const Vec3 felt = world.report().instruments[0].handle_force;
  EXPECT_NEAR(felt.norm(), 0.7, 1e-9);
  const FieldState before = world.state();
  ASSERT_TRUE(world.remove("other", "taken out"));
  EXPECT_EQ(world.report().instruments[0].handle_force, felt);
  ASSERT_TRUE(world.step(input));
  EXPECT_EQ(world.report().instruments[0].handle_force.norm(), 0);
  ASSERT_TRUE(world.restore(before) && world.remove("ball", "taken out"));
  EXPECT_EQ(world.report().instruments[0].handle_force, felt);
}

/// Two graspers whose shafts cross where one of them is led through the other.
struct Crossed {
  World world;
  StepInput input;
  std::vector<WorldEvent> events = {};
  Vec3 down, across;  ///< trocars

  static SceneDefinition scene(double hand_force) {
    SceneDefinition scene = test::ball_scene();
    scene.ports = default_ports();
    scene.ports.push_back({"above", Vec3(0, 0, 0)});
    scene.ports.push_back({"aside", Vec3(0.12, 0.01, 0.02)});
    scene.instruments[0].port = "above";
    scene.instruments.push_back(scene.instruments[0]);
    scene.instruments[1].name = "right";
    scene.instruments[1].port = "aside";
    for (InstrumentDefinition& tool : scene.instruments) tool.hand_force = hand_force;
    return scene;
  }
  explicit Crossed(const SceneDefinition& defined = scene(20))
      : world(World::create(defined).value()), down(0, 0, 0), across(0.12, 0.01, 0.02) {
    input.instruments = {world.report().instruments[0].pose, world.report().instruments[1].pose};
  }
  InstrumentPose straight() const { return {.pitch = 0.02, .insertion = 0.16, .jaw = 0.0}; }
  InstrumentPose reaching(double y) const {
    return pose_reaching(across, {-0.02, y, -0.11}, 0, 0, world_geometry());
  }
  InstrumentGeometry world_geometry() const {
    return instrument_geometry(InstrumentType::atraumatic_grasper);
  }
  std::string lead(const std::array<InstrumentPose, 2>& to, int steps) {
    const std::vector<InstrumentPose> from = input.instruments;
    for (int k = 1; k <= steps; ++k) {
      for (std::size_t i = 0; i < 2; ++i)
        input.instruments[i] = interpolate(from[i], to[i], static_cast<double>(k) / steps);
      const Result<StepReport> done = world.step(input);
      if (!done) return to_text(done.failure());
      events.insert(events.end(), done->events.begin(), done->events.end());
    }
    return {};
  }
  const InstrumentState& tool(std::size_t i) const { return world.report().instruments[i]; }
};

TEST(Hands, ToolsLedThroughEachOtherStopEachOtherAndSayWhenTheyMeet) {
  Crossed crossed;
  ASSERT_EQ(crossed.lead({crossed.straight(), crossed.reaching(0.03)}, 20), "");
  for (std::size_t i : {0u, 1u}) {
    EXPECT_EQ(crossed.tool(i).lag, 0);
    EXPECT_EQ(crossed.tool(i).meets, "");
  }
  // 60 mm in 0.12 s: 500 mm/s.
  ASSERT_EQ(crossed.lead({crossed.straight(), crossed.reaching(-0.03)}, 6), "");
  EXPECT_EQ(crossed.tool(0).meets, "right");
  EXPECT_EQ(crossed.tool(1).meets, "left");
  EXPECT_GT(crossed.tool(1).lag + crossed.tool(0).lag, 10e-3) << "it did not come through";
  EXPECT_GT(crossed.tool(1).meeting_force, 10);
  // A hand knows its tip's way to first order about the command, which is 50 mm away.
  EXPECT_LE(crossed.tool(1).meeting_force, 20 * 1.03);
  EXPECT_GT(crossed.tool(1).handle_force.norm(), 1);
  int clashes = 0;
  for (const WorldEvent& event : crossed.events) clashes += event.kind == EventKind::clash;
  EXPECT_EQ(clashes, 2) << "one of each, once";
  ASSERT_EQ(crossed.lead({crossed.straight(), crossed.reaching(0.03)}, 20), "");
  for (std::size_t i : {0u, 1u}) EXPECT_EQ(crossed.tool(i).lag, 0);
}

TEST(Hands, OfTwoThatMeetTheWeakerGivesWay) {
  SceneDefinition scene = Crossed::scene(20);
  scene.instruments[1].hand_force = 5;
  Crossed crossed(scene);
  ASSERT_EQ(crossed.lead({crossed.straight(), crossed.reaching(0.03)}, 20), "");
  ASSERT_EQ(crossed.lead({crossed.straight(), crossed.reaching(-0.03)}, 20), "");
  EXPECT_LT(crossed.tool(0).lag, 1e-3);
  EXPECT_GT(crossed.tool(1).lag, 10e-3);
  EXPECT_NEAR(crossed.tool(1).meeting_force, 5, 0.1);
}

TEST(Hands, ToolsThatMeetInTheirTrocarsAreRefused) {
  SceneDefinition scene = Crossed::scene(20);
  scene.ports.back().position = Vec3(0, 3e-3, 0);  // of shafts that are 5 mm thick
  const Result<World> made = World::create(scene);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.failure().kind, FailureKind::scenario);
  EXPECT_EQ(made.failure().problems.front().place.path, "scene.instruments.left.port");
  EXPECT_NE(to_text(made.failure()).find("meets 'right'"), std::string::npos) << to_text(made.failure());
}

TEST(Hands, WhatWouldComeInWhereAnotherOneIsDoesNot) {
  SceneDefinition scene = Crossed::scene(20);
  scene.instruments[1].port = "above";
  scene.instruments[1].waits = true;
  scene.instruments[1].type = InstrumentType::clip_applier;  // of 10 mm
  scene.instruments.push_back(scene.instruments[0]);
  scene.instruments[2].name = "third";
  scene.instruments[2].port = "near";
  scene.ports.push_back({"near", Vec3(0, 7e-3, 0)});
  World world = World::create(scene).value();
  StepInput input;
  for (const InstrumentState& state : world.report().instruments) input.instruments.push_back(state.pose);
  input.actions = {InstrumentAction::none, InstrumentAction::exchange, InstrumentAction::none};
  const Result<StepReport> done = world.step(input);
  ASSERT_TRUE(done) << to_text(done.failure());
  ASSERT_EQ(done->events.size(), 1u);
  EXPECT_EQ(done->events[0].kind, EventKind::blocked_exchange);
  EXPECT_EQ(done->events[0].text, "third is in the way");
  EXPECT_TRUE(done->instruments[1].waits);
  EXPECT_EQ(done->instruments[1].pose, input.instruments[1]);
}

TEST(Hands, TheSameBitsFollowFromAStateThatIsGivenBackWhileToolsPress) {
  Crossed crossed;
  ASSERT_EQ(crossed.lead({crossed.straight(), crossed.reaching(0.03)}, 20), "");
  ASSERT_EQ(crossed.lead({crossed.straight(), crossed.reaching(0.0)}, 10), "");
  ASSERT_EQ(crossed.tool(0).meets, "right");
  const FieldState pressed = crossed.world.state();
  const StepInput there = crossed.input;
  const auto go_on = [&] {
    EXPECT_EQ(crossed.lead({crossed.straight(), crossed.reaching(-0.03)}, 5), "");
    return crossed.world.state_hash();
  };
  const std::uint64_t first = go_on();
  ASSERT_TRUE(crossed.world.restore(pressed));
  crossed.input = there;
  EXPECT_EQ(go_on(), first);
}

}  // namespace
}  // namespace calot
