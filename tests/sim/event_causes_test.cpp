// Events say where they happened and what did it; what an instructor calls an injury is the anatomy's.

#include <gtest/gtest.h>

#include "act_rig.h"
#include "base/units.h"
#include "body/rod_body.h"
#include "field/field_state.h"
#include "rig.h"

namespace calot {
namespace {

using test::about;
using test::across;
using test::Acting;
using test::tube_depth;

/// The only one of its kind.
WorldEvent only(const Acting& scene, EventKind kind) {
  EXPECT_EQ(scene.count(kind), 1) << to_text(kind);
  for (const WorldEvent& event : scene.events)
    if (event.kind == kind) return event;
  return {};
}

SceneDefinition kept(InstrumentType type) {
  SceneDefinition scene = across(type);
  scene.anatomy.organs[0].injury = {"class E", "class E too", "class D", "class A"};
  return scene;
}

void expect_near_the_tube(const WorldEvent& event) {
  ASSERT_TRUE(event.place) << to_text(event.kind);
  EXPECT_LT((*event.place - Vec3(0, 0, -tube_depth)).norm(), 4e-3) << to_text(event.kind);
}

TEST(EventCauses, ACutOfWhatShouldBeKeptIsAnInjuryWithItsClassPlaceAndCause) {
  Acting scene(kept(InstrumentType::scissors));
  ASSERT_TRUE(scene.reach() && scene.go(about(0), 12));
  std::vector<std::string> classes;
  for (const WorldEvent& event : scene.events) {
    if (event.kind == EventKind::injury) classes.push_back(event.text);
    if (event.kind != EventKind::injury && event.kind != EventKind::cut &&
        event.kind != EventKind::cut_unclipped)
      continue;
    EXPECT_EQ(event.cause, EventCause::blades);
    expect_near_the_tube(event);
  }
  EXPECT_EQ(classes, (std::vector<std::string>{"class E", "class A"}));
}

TEST(EventCauses, AClipOnWhatShouldBeKeptIsAnInjuryWhetherItShutsItOrNot) {
  for (const auto& [past, called] : {std::pair{5e-3, "class E too"}, {0.6e-3, "class D"}}) {
    Acting scene(kept(InstrumentType::clip_applier));
    ASSERT_TRUE(scene.go(about(0.5, tube_depth - 20e-3), 2));
    // The tip's depth is what matters: open jaws reach less far.
    const double insertion = tube_depth + past + 18e-3 * (1 - std::cos(0.25));
    ASSERT_TRUE(scene.go(about(0.5, insertion), 8) && scene.fire());
    const WorldEvent injury = only(scene, EventKind::injury);
    EXPECT_EQ(injury.text, called);
    EXPECT_EQ(injury.cause, EventCause::clip);
    expect_near_the_tube(injury);
    expect_near_the_tube(only(scene, EventKind::clip));
  }
}

TEST(EventCauses, WhatIsCutOrClosedNearATubesStartHasAClassOfItsOwn) {
  // The tube is 30 mm long, and cut and clipped in its middle.
  for (const auto& [near, called] : {std::pair{16e-3, "class E2"}, {14e-3, "class E"}}) {
    SceneDefinition scene = kept(InstrumentType::scissors);
    InjuryDefinition& injury = scene.anatomy.organs[0].injury;
    injury.unclipped.clear();
    injury.near_start = {{near, "class E2"}};
    Acting cutting(scene);
    ASSERT_TRUE(cutting.reach() && cutting.go(about(0), 12));
    EXPECT_EQ(only(cutting, EventKind::injury).text, called);
    injury.closed = "class E";
    scene.instruments[0] = kept(InstrumentType::clip_applier).instruments[0];
    Acting clipping(scene);
    ASSERT_TRUE(clipping.go(about(0.5, tube_depth - 20e-3), 2) &&
                clipping.go(about(0.5, tube_depth + 5e-3 + 18e-3 * (1 - std::cos(0.25))), 8) &&
                clipping.fire());
    EXPECT_EQ(only(clipping, EventKind::injury).text, called);
  }
}

TEST(EventCauses, NearATubesStartStaysThereWhenTheTubeHasBeenDivided) {
  SceneDefinition scene = kept(InstrumentType::clip_applier);
  InjuryDefinition& injury = scene.anatomy.organs[0].injury;
  injury.closed = "class E";
  injury.near_start = {{16e-3, "class E2"}};
  Acting clipping(scene);
  ASSERT_TRUE(clipping.world.divide("duct", 0.5));
  // 4 mm from the cut, 19 mm from the start.
  const double y = 4e-3, far = std::hypot(y, tube_depth) + 5e-3 + 18e-3 * (1 - std::cos(0.25));
  InstrumentPose there = about(0.5, far - 25e-3);
  there.pitch = std::atan2(y, tube_depth);
  ASSERT_TRUE(clipping.go(there, 4));
  there.insertion = far;
  ASSERT_TRUE(clipping.go(there, 8) && clipping.fire());
  EXPECT_EQ(only(clipping, EventKind::injury).text, "class E");
}

TEST(EventCauses, WhatMayBeCutIsNoInjury) {
  Acting scene(across(InstrumentType::scissors));
  ASSERT_TRUE(scene.reach() && scene.go(about(0), 12));
  EXPECT_EQ(scene.count(EventKind::injury), 0);
}

/// The electrode beside or on the tube, without touching more than it must.
struct Heating {
  Acting scene;
  explicit Heating(SceneDefinition definition) : scene(std::move(definition)) {}
  testing::AssertionResult heat(double insertion, int steps) {
    const testing::AssertionResult there = scene.go(about(0, insertion), 6);
    if (!there) return there;
    const StepInput input{{scene.world.report().instruments[0].pose}, {InstrumentAction::activate}};
    for (int k = 0; k < steps; ++k) {
      const Result<StepReport> step = scene.world.step(input);
      if (!step) return testing::AssertionFailure() << to_text(step.failure());
      scene.events.insert(scene.events.end(), step->events.begin(), step->events.end());
    }
    return testing::AssertionSuccess();
  }
};

TEST(EventCauses, CurrentNearerThanItShouldBeIsSaidOnceWithTheDistance) {
  SceneDefinition definition = across(InstrumentType::bipolar_electrode, SolverMotion::statics);
  definition.anatomy.organs[0].keep_clear = 5e-3;
  const double skin = tube_depth - 1.8e-3;  // m below the port
  Heating near(definition), far(definition);
  ASSERT_TRUE(near.heat(skin - 3e-3, 5));
  const WorldEvent event = only(near.scene, EventKind::activation_beside);
  const Organ& duct = near.scene.world.field().organs[0];
  const double middle = 0.5 * static_cast<double>(duct.body->skin_rest().size() - 1);
  const double sags = -tube_depth - duct.body->as_tube()->place_at(middle, duct.state.x).z();
  EXPECT_NEAR(event.value, 3 + sags / units::mm, 0.02) << "mm; between looks along the tube";
  EXPECT_EQ(event.organ, "duct");
  EXPECT_EQ(event.cause, EventCause::current);
  ASSERT_TRUE(far.heat(skin - 6e-3, 5));
  EXPECT_EQ(far.scene.count(EventKind::activation_beside), 0);
  EXPECT_EQ(far.scene.count(EventKind::activation), 1);
}

TEST(EventCauses, CurrentBesideAWallIsSaidAsBesideADuct) {
  SceneDefinition definition = across(InstrumentType::bipolar_electrode, SolverMotion::statics);
  OrganDefinition ball = test::bedded_ball();
  ball.keep_clear = 5e-3;
  const double below = tube_depth + 10e-3;  // m, its top
  ball.fundus = Vec3(0, 0, -below);
  ball.neck = ball.fundus - Vec3(0, 0, 40e-3);
  definition.anatomy.organs = {ball};
  definition.laparoscope.look_at = "ball.fundus";
  Heating near(definition);
  ASSERT_TRUE(near.heat(below - 3e-3, 5));
  const WorldEvent event = only(near.scene, EventKind::activation_beside);
  EXPECT_EQ(event.organ, "ball");
  EXPECT_NEAR(event.value, 3, 0.5) << "mm, but for what the ball sags and its skin lies inside its sphere";
}

TEST(EventCauses, CurrentThatStaysOnAWallGoesThroughItOnceAndBrieflyDoesNot) {
  SceneDefinition definition = across(InstrumentType::bipolar_electrode, SolverMotion::statics);
  definition.anatomy.organs[0].injury.partly = "class D";
  definition.instruments[0].power = 50;  // 1 J a step
  definition.anatomy.organs[0].wall.burn_energy = 5.5;
  Heating burns(definition), spares(definition);
  ASSERT_TRUE(burns.heat(tube_depth - 1.8e-3 + 0.5e-3, 20));
  const WorldEvent event = only(burns.scene, EventKind::injury);
  EXPECT_EQ(event.text, "class D");
  EXPECT_EQ(event.cause, EventCause::current);
  EXPECT_NEAR(event.time, only(burns.scene, EventKind::activation).time + 5 * 0.02, 1e-9);
  ASSERT_TRUE(spares.heat(tube_depth - 1.8e-3 + 0.5e-3, 5));
  EXPECT_EQ(spares.scene.count(EventKind::injury), 0);
  // What flowed in leaves a mark where it did, with all its energy.
  double marked = 0;
  const Organ& tube = burns.scene.world.field().organs[0];
  const std::vector<Vec3> drawn = tube.body->drawn_positions(tube.state.x);
  for (const Burn& burn : tube.burns) {
    const Vec3& now = drawn.at(nearest_of(tube.body->drawn_rest(), burn.at));
    EXPECT_LT((now - burns.scene.world.report().instruments[0].tip).norm(), 4e-3);
    marked += burn.energy;
  }
  EXPECT_NEAR(marked, 20, 1e-9) << "1 J in each of 20 steps";
  const FieldState marks = burns.scene.world.state();
  FieldState without = marks;
  without.group.organs[0].burns.clear();
  const std::uint64_t hash = burns.scene.world.state_hash();
  ASSERT_TRUE(burns.scene.world.restore(without));
  EXPECT_NE(burns.scene.world.state_hash(), hash);
  ASSERT_TRUE(burns.scene.world.restore(marks));
  EXPECT_EQ(burns.scene.world.state_hash(), hash);
}

TEST(EventCauses, CurrentOnAClipIsSaid) {
  SceneDefinition definition = across(InstrumentType::clip_applier);
  InstrumentDefinition electrode = default_instrument(InstrumentType::bipolar_electrode);
  electrode.name = "heat";
  electrode.port = "beside";
  definition.ports.push_back({"beside", Vec3(15e-3, 0, 0)});
  definition.instruments.push_back(electrode);
  Result<World> made = World::create(definition);
  ASSERT_TRUE(made) << to_text(made.failure());
  World& world = made.value();
  const auto step = [&](const InstrumentPose& applier, const InstrumentPose& heat, InstrumentAction one,
                        InstrumentAction other) {
    const Result<StepReport> done = world.step({{applier, heat}, {one, other}});
    EXPECT_TRUE(done) << to_text(done.failure());
    return done ? done->events : std::vector<WorldEvent>{};
  };
  using enum InstrumentAction;
  const InstrumentPose away = world.report().instruments[1].pose;
  const InstrumentPose start = world.report().instruments[0].pose;
  for (int k = 1; k <= 12; ++k) step(interpolate(start, about(0.6), k / 12.0), away, none, none);
  step(about(0.6), away, fire, none);
  ASSERT_EQ(world.report().organs[0].clips.size(), 1u);
  for (int k = 1; k <= 6; ++k)
    step(interpolate(about(0.6), about(0.6, tube_depth - 40e-3), k / 6.0), away, none, none);
  const InstrumentPose there = pose_reaching(definition.ports.back().position, {0, 0, 2.3e-3 - tube_depth}, 0,
                                             0, instrument_geometry(InstrumentType::bipolar_electrode));
  for (int k = 1; k <= 6; ++k)
    step(about(0.6, tube_depth - 40e-3), interpolate(away, there, k / 6.0), none, none);
  int said = 0;
  for (int k = 0; k < 3; ++k)
    for (const WorldEvent& event : step(about(0.6, tube_depth - 40e-3), there, none, activate))
      said += event.kind == EventKind::activation_on_clip && event.organ == "duct" ? 1 : 0;
  EXPECT_EQ(said, 1) << world.report().instruments[1].tip.transpose();
}

TEST(EventCauses, AWallThatIsPinchedOrStretchedTooFarIsOpenedAndSaysByWhat) {
  for (const double pinch : {6.8, 16.0}) {
    SceneDefinition definition = test::ball_scene();
    definition.instruments[0].pinch_force = pinch;
    definition.anatomy.organs[0].wall.perforation_stretch = pinch > 10 ? 20 : 1.05;
    definition.anatomy.organs[0].wall.overstretch = 10;
    test::FundusPath path(definition);
    ASSERT_TRUE(path.grasp()) << path.driver.why();
    EXPECT_EQ(path.driver.count(EventKind::grasp), 1);
    ASSERT_EQ(path.driver.count(EventKind::perforation), 1);
    for (const WorldEvent& event : path.driver.events) {
      if (event.kind != EventKind::perforation) continue;
      EXPECT_EQ(event.organ, "ball");
      EXPECT_EQ(event.cause, pinch > 10 ? EventCause::pinch : EventCause::stretch);
      EXPECT_EQ(event.place.has_value(), pinch > 10) << "where a wall gives way is not known";
    }
    EXPECT_EQ(path.world.field().organs[0].openings.size(), pinch > 10 ? 1u : 0u) << "that leak";
  }
}

}  // namespace
}  // namespace calot
