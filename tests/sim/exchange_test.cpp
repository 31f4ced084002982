// Instruments that share a port, one after the other.

#include "acts/exchange.h"

#include <gtest/gtest.h>

#include "act_rig.h"
#include "field/field_state.h"
#include "rig.h"

namespace calot {
namespace {

using test::about;
using test::tube_depth;

/// A duct under a port that a grasper, a clip applier and scissors share; the grasper is in it.
SceneDefinition one_port() {
  SceneDefinition scene = test::across(InstrumentType::atraumatic_grasper);
  for (const InstrumentType type : {InstrumentType::clip_applier, InstrumentType::scissors}) {
    scene.instruments.push_back(default_instrument(type));
    scene.instruments.back().port = scene.instruments[0].port;
    scene.instruments.back().waits = true;
  }
  scene.instruments[1].name = "applier";
  scene.instruments[2].name = "blades";
  return scene;
}

/// Moves the one that is in the port; the others stay where the world has them.
struct Exchanging {
  World world;
  std::vector<WorldEvent> events = {};

  explicit Exchanging(const SceneDefinition& scene = one_port()) : world(World::create(scene).value()) {}

  std::size_t in_port() const {
    std::size_t there = 0;
    while (world.report().instruments[there].waits) ++there;
    return there;
  }
  testing::AssertionResult go(const InstrumentPose& to, int steps) {
    const InstrumentPose from = world.report().instruments[in_port()].pose;
    for (int k = 1; k <= steps; ++k)
      if (auto gone = step(interpolate(from, to, static_cast<double>(k) / steps)); !gone) return gone;
    return testing::AssertionSuccess();
  }
  testing::AssertionResult step(const InstrumentPose& pose, std::vector<InstrumentAction> actions = {}) {
    StepInput input;
    for (const InstrumentState& state : world.report().instruments) input.instruments.push_back(state.pose);
    input.instruments[in_port()] = pose;
    input.actions = std::move(actions);
    const Result<StepReport> done = world.step(input);
    if (!done) return testing::AssertionFailure() << to_text(done.failure());
    events.insert(events.end(), done->events.begin(), done->events.end());
    return testing::AssertionSuccess();
  }
  /// The action of one of them for a step.
  testing::AssertionResult act(std::size_t tool, InstrumentAction action) {
    std::vector<InstrumentAction> actions(world.report().instruments.size(), InstrumentAction::none);
    actions[tool] = action;
    const InstrumentPose here = world.report().instruments[in_port()].pose;
    if (auto done = step(here, actions); !done) return done;
    return step(world.report().instruments[in_port()].pose);
  }
  std::string last_text(EventKind kind) const {
    std::string text = "none";
    for (const WorldEvent& event : events)
      if (event.kind == kind) text = event.instrument + ": " + event.text;
    return text;
  }
};

TEST(Exchange, OneInstrumentIsInAPortAndTheOthersCannotMove) {
  Exchanging rig;
  EXPECT_EQ(rig.in_port(), 0u);
  EXPECT_TRUE(rig.world.report().instruments[1].waits && rig.world.report().instruments[2].waits);
  StepInput input;
  for (const InstrumentState& state : rig.world.report().instruments) input.instruments.push_back(state.pose);
  input.instruments[2].insertion += 1e-3;
  const Result<StepReport> moved = rig.world.step(input);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.failure().kind, FailureKind::scenario);
  EXPECT_NE(
      to_text(moved.failure()).find("'blades' cannot move: it waits outside, and 'right' is in the port"),
      std::string::npos)
      << to_text(moved.failure());
}

TEST(Exchange, WhatWaitsDoesNotAct) {
  Exchanging rig;
  const testing::AssertionResult fired = rig.act(1, InstrumentAction::fire);
  EXPECT_FALSE(fired);
  EXPECT_NE(std::string(fired.message()).find("'applier' cannot act: it waits outside"), std::string::npos)
      << fired.message();
}

TEST(Exchange, WhatWaitsIsNotInTheField) {
  Exchanging rig;
  ASSERT_TRUE(rig.go({0, 0.6, port_depth, 0, 0}, 10));  // clear of the others' straight way in
  OrganDefinition tube = test::tube_across("band");
  for (Vec3& point : std::get<TubeShape>(tube.shape).points) point.z() = -0.8 * port_depth;
  const Result<OrganIndex> band = rig.world.add(tube);
  ASSERT_TRUE(band) << to_text(band.failure());
  ASSERT_TRUE(rig.go({0, 0.6, port_depth, 0, 0}, 5));
  EXPECT_EQ(rig.last_text(EventKind::contact), "none");
  ASSERT_TRUE(rig.go({0, 0, port_depth, 0, 0}, 10));
  EXPECT_NE(rig.last_text(EventKind::contact), "none") << "else nothing was there";
}

TEST(Exchange, WhatComesInGoesOnWhereTheOtherOneWasDrawnBackTo) {
  Exchanging rig;
  ASSERT_TRUE(rig.go({0.1, 0.05, port_depth, 0.4, 0.3}, 10));
  ASSERT_TRUE(rig.act(1, InstrumentAction::exchange));
  EXPECT_EQ(rig.last_text(EventKind::exchange), "applier: right");
  const std::vector<InstrumentState>& now = rig.world.report().instruments;
  EXPECT_FALSE(now[1].waits);
  EXPECT_TRUE(now[0].waits && now[2].waits);
  EXPECT_EQ(now[1].pose, (InstrumentPose{0.1, 0.05, port_depth, 0, 0}));
  // It does what its kind does: a clip on the duct.
  ASSERT_TRUE(rig.go(about(0.5, tube_depth - 20e-3), 4) && rig.go(about(0.5, tube_depth + 6e-3), 8));
  ASSERT_TRUE(rig.act(1, InstrumentAction::fire));
  ASSERT_EQ(rig.world.report().organs[0].clips.size(), 1u);
  // And what was drawn out comes in again.
  ASSERT_TRUE(rig.go(about(0.5, port_depth), 6) && rig.act(0, InstrumentAction::exchange));
  EXPECT_EQ(rig.in_port(), 0u);
}

TEST(Exchange, IsBlockedByWhatIsInTheFieldOrIsThereAlready) {
  Exchanging rig;
  ASSERT_TRUE(rig.go(about(0.3, 50e-3), 4) && rig.act(1, InstrumentAction::exchange));
  EXPECT_EQ(rig.last_text(EventKind::blocked_exchange),
            "applier: right is 50 mm in: no more than 30 mm are out of the field");
  ASSERT_TRUE(rig.act(0, InstrumentAction::exchange));
  EXPECT_EQ(rig.last_text(EventKind::blocked_exchange), "right: it is in its port");
  EXPECT_EQ(rig.last_text(EventKind::exchange), "none");
  EXPECT_EQ(rig.in_port(), 0u);
}

TEST(Exchange, IsBlockedWhereSomethingIsHeldUntilItIsLetGo) {
  SceneDefinition scene = test::ball_scene();
  scene.instruments.push_back(default_instrument(InstrumentType::scissors));
  scene.instruments.back().name = "blades";
  scene.instruments.back().port = scene.instruments[0].port;
  scene.instruments.back().waits = true;
  Exchanging rig(scene);
  const Vec3 trocar = rig.world.port_position(scene.instruments[0].port);
  const Vec3 top = rig.world.landmark("ball.fundus"), out = (trocar - top).normalized();
  const auto at = [&](double above, double jaw) { return pose_reaching(trocar, top + above * out, 0, jaw); };
  ASSERT_TRUE(rig.go(at(15e-3, test::open_jaw), 5) && rig.go(at(-4e-3, test::open_jaw), 8) &&
              rig.go(at(-4e-3, 0), 10));
  ASSERT_EQ(rig.world.report().instruments[0].holds, "ball");
  ASSERT_TRUE(rig.act(1, InstrumentAction::exchange));
  EXPECT_EQ(rig.last_text(EventKind::blocked_exchange), "blades: left holds ball");
  ASSERT_TRUE(rig.go(at(5e-3, test::open_jaw), 4) && rig.go(at((trocar - top).norm() - 20e-3, 0), 10) &&
              rig.act(1, InstrumentAction::exchange));
  EXPECT_EQ(rig.in_port(), 1u);
}

TEST(Exchange, WhatWasDrawnOutComesInAsOneThatHasDoneNothing) {
  Exchanging rig;
  Field field = rig.world.field();
  Tool& tool = field.tools[0];
  const auto knows = [&] {
    return std::array{tool.jaw_stopped, tool.pressing, tool.lost, tool.beside, tool.slipping, tool.has_cut};
  };
  const auto at_the_start = knows();
  tool.pressing = tool.lost = tool.beside = tool.slipping = tool.has_cut = true;
  std::vector<WorldEvent> events;
  exchange_tools(field, {InstrumentAction::none, InstrumentAction::exchange, InstrumentAction::none}, events);
  ASSERT_TRUE(tool.waits);
  exchange_tools(field, {InstrumentAction::exchange, InstrumentAction::none, InstrumentAction::none}, events);
  ASSERT_FALSE(tool.waits);
  EXPECT_EQ(knows(), at_the_start);
}

TEST(Exchange, IsUndoneByGivingBackTheStateOfBefore) {
  Exchanging rig;
  const FieldState before = rig.world.state();
  const std::uint64_t hash = rig.world.state_hash();
  ASSERT_TRUE(rig.act(2, InstrumentAction::exchange));
  EXPECT_EQ(rig.in_port(), 2u);
  EXPECT_NE(rig.world.state_hash(), hash);
  ASSERT_TRUE(rig.world.restore(before));
  EXPECT_EQ(rig.in_port(), 0u);
  EXPECT_EQ(rig.world.state_hash(), hash);
}

}  // namespace
}  // namespace calot
