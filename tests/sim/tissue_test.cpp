// Tissue between the organs of a scene.

#include "organs/tissue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "field/field_state.h"
#include "organs/strand_places.h"
#include "rig.h"

namespace calot {
namespace {

/// A stone that hangs below a stiff duct, held at its ends, by strands of this strength, Pa.
SceneDefinition hanging_stone(double strength, SolverMotion motion = SolverMotion::dynamics) {
  SceneDefinition scene = test::ball_scene();
  OrganDefinition duct;
  duct.name = "duct";
  duct.shape =
      TubeShape{.points = {Vec3(-100e-3, 70e-3, -100e-3), Vec3(-60e-3, 70e-3, -100e-3)}, .radius = 3e-3};
  duct.wall.thickness = 3e-3;
  duct.wall.shear_modulus = 2e6;
  duct.held = {{"start", "start", 5e-3, 1e7}, {"end", "end", 5e-3, 1e7}};
  OrganDefinition stone;
  stone.name = "stone";
  stone.shape = RigidShape{Vec3(24e-3, 4e-3, 2e-3), 4e-3, Vec3(-80e-3, 70e-3, -110e-3), 1500};
  scene.anatomy.organs = {duct, stone};
  TissueDefinition tissue;
  tissue.name = "stalk";
  tissue.from = "duct";
  tissue.to = "stone";
  tissue.within = 5e-3;
  tissue.start = 0.3;
  tissue.stop = 0.7;
  tissue.strands = 40;
  tissue.slack = 0;  // else nothing holds the stone where it begins
  tissue.stiffness = strength;
  tissue.strength = strength;
  tissue.break_energy = 10e-3 * strength;
  scene.anatomy.tissue = {tissue};
  scene.solver.motion = motion;
  scene.solver.rate = 400;
  scene.laparoscope.look_at = "duct.middle";
  return scene;
}

World world_of(const SceneDefinition& scene) {
  Result<World> world = World::create(scene);
  EXPECT_TRUE(world) << to_text(world.failure());
  return std::move(world).value();
}

std::vector<WorldEvent> wait(World& world, int steps) {
  std::vector<WorldEvent> events;
  for (int k = 0; k < steps; ++k) {
    const Result<StepReport> report = world.step({{world.report().instruments[0].pose}});
    EXPECT_TRUE(report) << to_text(report.failure());
    if (!report) break;
    events.insert(events.end(), report->events.begin(), report->events.end());
  }
  return events;
}

double height(const World& world) { return world.landmark("stone.centre").z(); }

TEST(Tissue, AStoneHangsByIt) {
  for (SolverMotion motion : {SolverMotion::statics, SolverMotion::dynamics}) {
    World world = world_of(hanging_stone(20e3, motion));
    const double begin = height(world);
    EXPECT_TRUE(wait(world, 10).empty());
    ASSERT_EQ(world.report().tissues.size(), 1u);
    EXPECT_EQ(world.report().tissues[0].name, "stalk");
    EXPECT_EQ(world.report().tissues[0].strands, 40);
    EXPECT_EQ(world.report().tissues[0].torn, 0);
    EXPECT_NEAR(height(world), begin, 0.1e-3) << "it was at rest";
    EXPECT_LT(height(world), -110.1e-3) << "its strands are stretched: it is drawn at -110 mm";
  }
}

/// The stone with this speed downwards, m/s.
void push(World& world, double speed) {
  FieldState state = world.state();
  MotionPart& motion = state.group.organs[1].state.motion;
  motion.begin.x = state.group.organs[1].state.x - Vec3(0, 0, -speed * motion.duration).replicate(4, 1);
  ASSERT_TRUE(world.restore(state));
}

TEST(Tissue, AStoneTearsOffWhereItsEnergyIsMoreThanTheTissueTakes) {
  for (double speed : {0.5, 1.2}) {
    World world = world_of(hanging_stone(4e3));
    wait(world, 1);
    const double begin = height(world);
    // Of the area, in J, and of the stone.
    const Field& field = world.field();
    double break_energy = 0;
    for (const PlacedStrand& strand : field.tissues[0].strands->strands())
      break_energy += strand.strand.law.setup().break_energy;
    const double mass = -field.organs[1].body->kept_load().sum() / units::standard_gravity;
    const double energy =
        0.5 * mass * speed * speed + mass * units::standard_gravity * 18e-3;  // and of its fall
    push(world, speed);
    std::vector<WorldEvent> events;
    int torn = 0;
    for (int k = 0; k < 40; ++k) {
      for (const WorldEvent& event : wait(world, 1)) events.push_back(event);
      EXPECT_GE(world.report().tissues[0].torn, torn) << "what is torn stays torn";
      torn = world.report().tissues[0].torn;
    }
    if (energy < 0.8 * break_energy) {
      EXPECT_EQ(torn, 0);
      EXPECT_TRUE(events.empty());
      continue;
    }
    ASSERT_GT(energy, 1.5 * break_energy);
    EXPECT_EQ(torn, 40);
    EXPECT_LT(height(world), begin - 0.05);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[0].kind, EventKind::tear);
    EXPECT_EQ(events[0].organ, "stalk");
    EXPECT_EQ(events[1].kind, EventKind::parted);
  }
}

TEST(Tissue, RestoredWhileItTearsTheSameStepsHaveTheSameBits) {
  World world = world_of(hanging_stone(4e3));
  wait(world, 1);
  push(world, 1.2);
  while (world.field().tissues[0].now.opened[0] == 0) wait(world, 1);
  ASSERT_EQ(world.report().tissues[0].torn, 0) << "on its way";
  const FieldState state = world.state();
  wait(world, 5);
  EXPECT_GT(world.field().tissues[0].now.opened[0], state.group.tissues[0].opened[0]);
  const std::uint64_t hash = world.report().state_hash;
  ASSERT_TRUE(world.restore(state));
  wait(world, 5);
  EXPECT_EQ(world.report().state_hash, hash);
  // Each of these is in the hash.
  const auto differs = [&](const char* what, const std::function<void(TissueMotion&)>& change) {
    FieldState other = state;
    change(other.group.tissues[0]);
    ASSERT_TRUE(world.restore(other));
    const std::uint64_t changed = world.state_hash();
    ASSERT_TRUE(world.restore(state));
    EXPECT_NE(world.state_hash(), changed) << what;
  };
  differs("x", [](TissueMotion& now) { now.state.x[0] += 1e-15; });
  differs("opened", [](TissueMotion& now) { now.opened[0] += 1e-9; });
  differs("heated", [](TissueMotion& now) { now.heated[0] += 1e-9; });
  differs("velocity", [](TissueMotion& now) { now.state.motion.begin.velocity[0] += 1e-9; });
  differs("tearing", [](TissueMotion& now) { now.tearing = !now.tearing; });
}

TEST(Tissue, AnOrganThatGoesTakesItAlong) {
  for (const char* gone : {"stone", "duct"}) {
    World world = world_of(hanging_stone(20e3));
    wait(world, 2);
    const FieldState before = world.state();
    ASSERT_TRUE(world.remove(gone, "taken out"));
    EXPECT_TRUE(world.report().tissues.empty());
    wait(world, 3);
    ASSERT_TRUE(world.restore(before));
    EXPECT_EQ(world.field().tissues.size(), 1u);
    wait(world, 2);
    EXPECT_EQ(world.report().tissues[0].torn, 0);
  }
}

TEST(Tissue, OfADuctLiesWhereItsSharesSayAndStandsForAllOfTheArea) {
  const World world = world_of(hanging_stone(20e3));
  const std::vector<Organ>& organs = world.field().organs;
  const Result<std::vector<StrandPlace>> places =
      strand_places(world.scene().anatomy.tissue[0], organs[0], organs[1]);
  ASSERT_TRUE(places);
  EXPECT_EQ(places->size(), 40u);
  double area = 0, first = 1, last = -1;
  for (const StrandPlace& place : places.value()) {
    area += place.area;
    first = std::min(first, place.from.x());
    last = std::max(last, place.from.x());
    EXPECT_GT(place.area, 0);
    EXPECT_NEAR(place.way, place.gap + 3e-3, 1e-9) << "from the duct's middle line";
    EXPECT_NEAR((place.from - place.to).norm(), place.way, 1e-9);
  }
  EXPECT_NEAR(first, -88e-3, 1e-3);
  EXPECT_NEAR(last, -72e-3, 1e-3);
  double all = 0;
  for (double of_point : organs[0].body->skin_areas()) all += of_point;
  EXPECT_NEAR(area, 0.4 * all, 0.05 * all);
}

TEST(Tissue, OfADividedDuctGoesWithItsHalves) {
  World world = world_of(hanging_stone(20e3));
  wait(world, 2);
  const Field& field = world.field();
  const VecX& x = field.tissues[0].now.state.x;
  const double mass = field.tissues[0].body->kept_load().norm();
  ASSERT_GT(x.norm(), 0);
  ASSERT_TRUE(world.divide("duct", 0.4));
  ASSERT_EQ(field.tissues.size(), 2u);
  EXPECT_EQ(field.tissues[0].strands->bodies(), (std::array{1, 2}));
  EXPECT_EQ(field.tissues[1].strands->bodies(), (std::array{0, 2}));
  ASSERT_EQ(world.report().tissues.size(), 1u) << "of one name, reported as one";
  EXPECT_EQ(world.report().tissues[0].strands, 40);
  EXPECT_GT(field.tissues[0].now.opened.size(), 5u);
  EXPECT_GT(field.tissues[1].now.opened.size(), 5u);
  EXPECT_NEAR(field.tissues[0].body->kept_load().sum() + field.tissues[1].body->kept_load().sum(),
              -mass * std::sqrt(40.0), 0.2 * mass * std::sqrt(40.0));
  wait(world, 3);
  ASSERT_TRUE(world.remove("duct.specimen", "taken out"));
  EXPECT_EQ(field.tissues.size(), 1u);
  wait(world, 3);
}

TEST(Tissue, HoldsAnOrganWhereItWasFilled) {
  SceneDefinition scene = test::ball_scene();
  OrganDefinition& ball = scene.anatomy.organs[0];
  ball.wall.density = 1050;
  ball.held = {{"top", "fundus", 22e-3, 1e6, true}};
  OrganDefinition rail = ball;
  rail.name = "rail";
  rail.shape = TubeShape{.points = {ball.fundus + Vec3(-30e-3, 0, 5e-3), ball.fundus + Vec3(30e-3, 0, 5e-3)},
                         .radius = 3e-3};
  rail.bile = {};
  rail.wall.thickness = 3e-3;
  rail.wall.shear_modulus = 2e6;
  rail.held = {{"start", "start", 5e-3, 1e7}, {"end", "end", 5e-3, 1e7}};
  scene.anatomy.organs.push_back(rail);
  scene.solver.motion = SolverMotion::dynamics;
  TissueDefinition tissue;
  tissue.from = "ball";
  tissue.to = "rail";
  tissue.within = 8e-3;
  tissue.slack = 0;
  tissue.stiffness = 100e3;
  tissue.break_energy = 500;
  scene.anatomy.tissue = {tissue};
  World world = world_of(scene);
  EXPECT_TRUE(world.field().organs[0].body->as_shell()->foundation().row.empty());
  const Vec3 begin = world.landmark("ball.fundus");
  wait(world, 3);
  EXPECT_LT((world.landmark("ball.fundus") - begin).norm(), 0.5e-3) << "at rest on its strands";
}

TEST(Tissue, WhatCannotBeMadeIsSaidWithItsPlace) {
  SceneDefinition scene = hanging_stone(20e3);
  std::get<RigidShape>(scene.anatomy.organs[1].shape).centre.z() -= 78e-3;
  Result<World> apart = World::create(scene);
  ASSERT_FALSE(apart);
  EXPECT_THAT(to_text(apart.failure()), testing::HasSubstr("scene.anatomy.tissue[1].within"));
  EXPECT_THAT(to_text(apart.failure()), testing::HasSubstr("80 mm apart"));
  scene = hanging_stone(20e3);
  scene.anatomy.tissue[0].break_energy = 1;
  Result<World> brittle = World::create(scene);
  ASSERT_FALSE(brittle);
  EXPECT_THAT(to_text(brittle.failure()), testing::HasSubstr("scene.anatomy.tissue[1].break_energy"));
}

}  // namespace
}  // namespace calot
