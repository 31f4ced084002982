// Scenes of ducts, rigid things and ground: what each kind of body is to the others.

#include <gtest/gtest.h>

#include <limits>

#include "motion/settle_field.h"
#include "rig.h"
#include "support/bodies.h"

namespace calot {
namespace {

OrganDefinition duct(const std::vector<Vec3>& points) {
  OrganDefinition organ;
  organ.name = "duct";
  organ.shape = TubeShape{.points = points, .radius = 3e-3};
  organ.wall.thickness = 1e-3;
  return organ;
}

SceneDefinition scene_of(const std::vector<OrganDefinition>& organs) {
  SceneDefinition scene = test::scene_with(InstrumentType::bipolar_electrode);
  scene.anatomy = {};
  scene.anatomy.organs = organs;
  scene.anatomy.table_head_up = scene.anatomy.table_left_down = 0;
  scene.laparoscope.look_at = landmark_names(organs).front();
  return scene;
}

World made(const SceneDefinition& scene) {
  Result<World> world = World::create(scene);
  EXPECT_TRUE(world) << to_text(world.failure());
  return std::move(world).value();
}

/// Of all ground on an organ, N.
Vec3 ground_force(const World& world, int organ) {
  const Field& field = world.field();
  const Organ& of = field.organs[static_cast<std::size_t>(organ)];
  const ContactLoads now = contact_loads(field, of, present_poses(field));
  Vec3 sum = Vec3::Zero();
  for (const ContactForce& force :
       contact_forces(*of.body, of.state.x, now, gather_pairs(*of.body, of.state.x, now, -contact_margin)))
    sum -= force.on_shape;
  return sum;
}

TEST(Kinds, ADuctHeldAtBothEndsGivesWayToARodAndComesBack) {
  OrganDefinition organ = duct({{-100e-3, 90e-3, -100e-3}, {-60e-3, 90e-3, -100e-3}});
  organ.held = {{"start", "start", 6e-3, 1e6}, {"end", "end", 6e-3, 1e6}};
  World world = made(scene_of({organ}));
  test::Driver driver(world);
  const std::vector<Vec3> before = world.skin_positions(OrganIndex(0));
  const Vec3 middle = world.landmark("duct.middle");
  EXPECT_NEAR((middle - Vec3(-80e-3, 90e-3, -97e-3)).norm(), 0, 1e-9) << "on the tube, above its line";
  ASSERT_TRUE(driver.go(middle + Vec3(0, 0, 5e-3), 0, 4) && driver.go(middle - Vec3(0, 0, 3e-3), 0, 4))
      << driver.why();
  const InstrumentState pressed = world.report().instruments[0];
  EXPECT_GT(pressed.force.z(), 0.02);
  EXPECT_LT(world.landmark("duct.middle").z(), middle.z() - 1e-3);
  EXPECT_LT(world.deepest_penetration(), 1e-9) << "its middle line stays outside";
  ASSERT_TRUE(driver.go(middle + Vec3(0, 0, 10e-3), 0, 4)) << driver.why();
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_LT((world.skin_positions(OrganIndex(0))[k] - before[k]).norm(),
              1e-6);  // m, of 40 mm: the solver's tolerance
}

/// A tool with an upright shaft, its tip below a duct, is drawn across it at 500 mm/s: it takes the duct along, or the step
/// is reported, but never passes.
void draw_across(double radius, double thickness, SolverMotion motion) {
  OrganDefinition organ = duct({{-110e-3, 90e-3, -100e-3}, {-50e-3, 90e-3, -100e-3}});
  std::get<TubeShape>(organ.shape).radius = radius;
  organ.wall.thickness = thickness;
  organ.wall.density = 1050;
  organ.held = {{"start", "start", 6e-3, 1e6}, {"end", "end", 6e-3, 1e6}};
  SceneDefinition scene = scene_of({organ});
  scene.solver.motion = motion;
  scene.ports = {{"umbilical", Vec3::Zero()}, {"right_subcostal", Vec3(-80e-3, 90e-3, 100e-3)}};
  World world = made(scene);
  test::Driver driver(world);
  double carried = 0;
  driver.watch = [&](const StepReport& report) {
    const Vec3 tip = report.instruments[0].tip, up = (driver.trocar() - tip).normalized();
    double ahead = std::numeric_limits<double>::infinity(), nearest = ahead;
    for (const Vec3& p : world.skin_positions(OrganIndex(0))) {
      const Vec3 beside = p - tip - (p - tip).dot(up) * up;
      if (beside.norm() < nearest) nearest = beside.norm(), ahead = beside.y();
      carried = std::max(carried, p.y() - 90e-3);
    }
    EXPECT_GT(ahead, 0) << "the line is before the shaft, tip at " << tip.transpose();
    EXPECT_LT(world.deepest_penetration(), 0.1e-3);
  };
  const double below = -112e-3;
  ASSERT_TRUE(driver.go({-80e-3, 70e-3, below}, 0, 40)) << driver.why();
  const bool followed = driver.go({-80e-3, 110e-3, below}, 0, 4);  // 10 mm a step at 50 Hz
  if (!followed) {
    EXPECT_EQ(driver.failure->kind, FailureKind::simulation) << driver.why();
  }
  EXPECT_GT(carried, 5e-3);
}

TEST(Kinds, AToolDrawnAcrossADuctAt500MillimetresASecondNeverPasses) {
  for (SolverMotion motion : {SolverMotion::statics, SolverMotion::dynamics}) {
    draw_across(3e-3, 1e-3, motion);
    draw_across(0.8e-3, 0.4e-3, motion);  // as thin as an artery
  }
}

TEST(Kinds, WhatLiesLooseOnTheGroundPressesOnItWithItsWeight) {
  OrganDefinition stone;
  stone.name = "stone";
  stone.shape =
      RigidShape{.size = Vec3(8e-3, 4e-3, 0), .rounding = 6e-3, .centre = Vec3(-60e-3, 90e-3, -110e-3)};
  OrganDefinition loose =
      duct({{-100e-3, 60e-3, -110e-3}, {-80e-3, 66e-3, -108e-3}, {-60e-3, 60e-3, -110e-3}});
  loose.wall.density = 1050;
  SceneDefinition scene = scene_of({stone, loose});
  scene.anatomy.ground = {{.name = "floor", .point = Vec3(0, 0, -120e-3), .friction = 0.2}};
  scene.solver.motion = SolverMotion::dynamics;
  World world = made(scene);
  const auto weight = [&](std::size_t organ) {
    const VecX& load = world.field().organs[organ].body->kept_load();
    return test::net_force(load);
  };
  EXPECT_EQ(world.report().instruments[0].force.norm(), 0) << "what rubs on the ground rubs on no tool";
  for (int step = 0; step < 5; ++step)
    ASSERT_TRUE(world.step({.instruments = {world.report().instruments[0].pose}}));
  for (int organ : {0, 1}) {
    const Vec3 down = weight(static_cast<std::size_t>(organ));
    EXPECT_LT(down.z(), -1e-3);
    EXPECT_LT((ground_force(world, organ) + down).norm(), 1e-3 * down.norm()) << organ;
  }
}

TEST(Kinds, AJointHoldsADuctThatNothingElseHolds) {
  OrganDefinition held = duct({{-100e-3, 90e-3, -100e-3}, {-60e-3, 90e-3, -100e-3}});
  held.held = {{"start", "start", 6e-3, 1e6}, {"end", "end", 6e-3, 1e6}};
  OrganDefinition tied = duct({{-80e-3, 90e-3, -100e-3}, {-80e-3, 90e-3, -130e-3}});
  tied.name = "tied";
  tied.wall.shear_modulus = held.wall.shear_modulus = 3e6;  // so that its weight bends it by little
  tied.wall.density = 1050;
  SceneDefinition scene = scene_of({held, tied});
  scene.solver.motion =
      SolverMotion::dynamics;  // unstressed it could swing freely: it sinks to where it hangs
  EXPECT_FALSE(World::create(scene)) << "loose, it falls";
  scene.anatomy.joints = {{.from = "tied.start", .to = "duct.middle", .radius = 4e-3}};
  World world = made(scene);
  const VecX& x = world.field().organs[1].state.x;
  EXPECT_NEAR((x.tail<3>() - Vec3(-80e-3, 90e-3, -130e-3)).norm(), 0, 1e-3) << "it hangs where it was drawn";
  EXPECT_LT(x.tail<3>().z(), -130e-3 - 1e-7) << "by its weight";
}

TEST(Kinds, AllThatAreInEachOtherAreRefusedAtOnceUnlessTheyAreJoinedThere) {
  const auto at = [](const char* name, double y) {
    OrganDefinition organ = duct({{-100e-3, y, -100e-3}, {-60e-3, y, -100e-3}});
    organ.held = {{"start", "start", 6e-3, 1e6}, {"end", "end", 6e-3, 1e6}};
    organ.name = name;
    return organ;
  };
  SceneDefinition scene =
      scene_of({at("one", 90e-3), at("two", 95e-3), at("far", 60e-3), at("three", 99e-3)});
  const Result<World> world = World::create(scene);
  ASSERT_FALSE(world);
  EXPECT_EQ(world.failure().kind, FailureKind::scenario);
  const std::vector<Problem>& problems = world.failure().problems;
  ASSERT_EQ(problems.size(), 2U) << to_text(world.failure());
  EXPECT_EQ(problems[0].place.path, "scene.anatomy.organs[2]");
  EXPECT_EQ(problems[0].message.find("organ 'one' and organ 'two' are 1 mm deep in each other, at (-"), 0U)
      << problems[0].message;
  EXPECT_EQ(problems[1].place.path, "scene.anatomy.organs[4]");
  EXPECT_EQ(problems[1].message.find("organ 'two' and organ 'three' are 2 mm deep in each other"), 0U)
      << problems[1].message;
  EXPECT_NE(problems[1].hint.find("joint"), std::string::npos);

  OrganDefinition branch = duct({{-80e-3, 90e-3, -100e-3}, {-80e-3, 110e-3, -100e-3}});
  branch.name = "branch";
  branch.held = {{"end", "end", 6e-3, 1e6}};
  scene = scene_of({at("one", 90e-3), branch});
  EXPECT_FALSE(World::create(scene));
  scene.anatomy.joints = {{.from = "branch.start", .to = "one.middle", .radius = 4e-3}};
  EXPECT_TRUE(World::create(scene)) << to_text(World::create(scene).failure());
}

TEST(Kinds, AllThatStartInTheGroundAreRefusedAtOnce) {
  OrganDefinition one = duct({{-100e-3, 90e-3, -100e-3}, {-70e-3, 90e-3, -100e-3}}), other = one, above = one;
  other.shape = TubeShape{.points = {{-100e-3, 60e-3, -101e-3}, {-70e-3, 60e-3, -100e-3}}, .radius = 3e-3};
  above.shape = TubeShape{.points = {{-100e-3, 30e-3, -90e-3}, {-70e-3, 30e-3, -90e-3}}, .radius = 3e-3};
  other.name = "other";
  above.name = "above";
  SceneDefinition scene = scene_of({one, above, other});
  scene.anatomy.ground = {{.point = Vec3(0, 0, -101e-3)}};
  const Result<World> world = World::create(scene);
  ASSERT_FALSE(world);
  const std::vector<Problem>& problems = world.failure().problems;
  ASSERT_EQ(problems.size(), 2U) << to_text(world.failure());
  EXPECT_EQ(problems[0].place.path, "scene.anatomy.organs[1]");
  EXPECT_EQ(problems[1].place.path, "scene.anatomy.organs[3]");
  EXPECT_EQ(
      problems[1].message.find("organ 'other' starts 3 mm inside the supporting plane, at (-100, 60, -10"),
      0U)
      << problems[1].message;
}

}  // namespace
}  // namespace calot
