// Jaws that close on a duct or a vessel hold it, pressed flat, between both pads.

#include "act_rig.h"
#include "acts/grip_slip.h"
#include "base/units.h"

namespace calot {
namespace {

using test::about;
using test::across;
using test::Acting;
using test::tube_depth;

testing::AssertionResult close_on_tube(Acting& acting) {
  const testing::AssertionResult there = acting.reach(0.5);
  return there ? acting.go(about(0), 30) : there;
}
/// Its tip, drawn back along the shaft.
InstrumentPose lifted(double way) { return about(0, tube_depth + 6e-3 - way); }

SceneDefinition grasped_tube(double radius, double wall) {
  SceneDefinition scene = across(InstrumentType::atraumatic_grasper);
  std::get<TubeShape>(scene.anatomy.organs[0].shape).radius = radius;
  scene.anatomy.organs[0].wall.thickness = wall;
  return scene;
}

/// N, by which a tube resists jaws that draw its middle aside by `way`, m, were it a string from them to its held ends.
double string_force(const SceneDefinition& scene, double way) {
  const OrganDefinition& tube = scene.anatomy.organs[0];
  const double outer = std::get<TubeShape>(tube.shape).radius, inner = outer - tube.wall.thickness;
  const double stiffness =
      3 * tube.wall.shear_modulus * std::numbers::pi * (outer * outer - inner * inner);  // N
  const double pads = instrument_row(scene.instruments[0].type).geometry.jaw_width;
  const double span = 15e-3 - tube.held[0].radius - 0.5 * pads, taut = std::hypot(span, way);
  return 2 * stiffness * (taut / span - 1) * way / taut;
}

TEST(TubeGrasp, ADuctOrAnArteryIsHeldByBothPadsAndGoesWithThem) {
  for (const auto& [radius, wall] : {std::pair{1.8e-3, 0.8e-3}, {0.8e-3, 0.4e-3}, {3.5e-3, 1e-3}}) {
    SCOPED_TRACE(radius);
    SceneDefinition scene = grasped_tube(radius, wall);
    // Its ends give way by 0.3 mm at most.
    for (HeldRegion& held : scene.anatomy.organs[0].held) held.stiffness = 1e8;
    Acting acting(scene);
    const Vec3 rest = acting.world.landmark("duct.middle");
    ASSERT_TRUE(close_on_tube(acting));
    EXPECT_EQ(acting.count(EventKind::grasp), 1);
    EXPECT_EQ(acting.count(EventKind::empty_grasp), 0);
    EXPECT_EQ(acting.world.report().instruments[0].holds, "duct");
    int held[2] = {0, 0};
    for (const GripPoint& grip : acting.world.field().organs[0].grips) ++held[grip.jaw];
    EXPECT_GT(held[0], 0);
    EXPECT_EQ(held[0], held[1]);
    const Vec3 closed = acting.world.landmark("duct.middle");
    ASSERT_TRUE(acting.go(lifted(8e-3), 20));
    EXPECT_NEAR(acting.world.landmark("duct.middle").z() - closed.z(), 8e-3, 0.1e-3);
    const double expected = string_force(scene, 8e-3);
    EXPECT_NEAR(acting.world.report().instruments[0].force.z(), -expected, 0.2 * expected)
        << "a thick tube resists being bent, too";
    ASSERT_TRUE(acting.go({0, 0, lifted(8e-3).insertion, 0, 0.5}, 10));
    EXPECT_EQ(acting.count(EventKind::release), 1);
    ASSERT_TRUE(acting.go(about(0.5, tube_depth - 30e-3), 10) &&
                acting.go(about(0.5, tube_depth - 30e-3), 50));
    EXPECT_LT((acting.world.landmark("duct.middle") - rest).norm(), 0.05e-3);
  }
}

TEST(TubeGrasp, PulledHarderThanThePadsHoldItSlides) {
  SceneDefinition scene = grasped_tube(1.8e-3, 0.8e-3);
  scene.instruments[0].pinch_force = 0.06;
  Acting acting(scene);
  ASSERT_TRUE(close_on_tube(acting));
  const double limit = holding_limit(acting.world.field().tools[0]);
  double largest = 0;
  for (int k = 1; k <= 14 && acting.count(EventKind::slip) == 0; ++k) {
    ASSERT_TRUE(acting.go(lifted(k * 1e-3), 2));
    const Field& field = acting.world.field();
    largest = std::max(largest, asked_of_friction(field.tools[0], pad_load(field, ToolIndex(0)).pull).norm());
  }
  EXPECT_EQ(acting.count(EventKind::slip), 1);
  EXPECT_GT(largest, 0.9 * limit);
  EXPECT_LT(largest, 1.01 * limit);
}

TEST(TubeGrasp, AStumpIsGraspedAndDrawnAlongItself) {
  Acting acting(across(InstrumentType::atraumatic_grasper));
  ASSERT_TRUE(acting.world.divide("duct", 0.75));
  ASSERT_TRUE(close_on_tube(acting));
  ASSERT_EQ(acting.world.report().instruments[0].holds, "duct.patient");
  ASSERT_TRUE(acting.go(lifted(5e-3), 20));
  EXPECT_EQ(acting.world.report().instruments[0].holds, "duct.patient");
  EXPECT_LT(acting.world.report().instruments[0].force.z(), -1e-3);
}

TEST(TubeGrasp, BladesAndAppliersHoldNothingOfIt) {
  for (const InstrumentType type : {InstrumentType::scissors, InstrumentType::clip_applier})
    for (const double past : {4e-3, 7e-3, 10e-3}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(type) << " reaches " << past * 1e3 << " mm past");
      Acting acting(across(type));
      ASSERT_TRUE(acting.go(about(0.45, tube_depth - 20e-3), 2));
      ASSERT_TRUE(acting.go(about(0.45, tube_depth + past), 12));
      ASSERT_TRUE(acting.go(about(0, tube_depth + past), 40));
      EXPECT_GE(acting.count(EventKind::contact), 1) << "else it met nothing";
      EXPECT_EQ(acting.count(EventKind::grasp), 0);
      EXPECT_EQ(acting.count(EventKind::empty_grasp), 0);
      EXPECT_EQ(acting.count(EventKind::perforation), 0);
      EXPECT_EQ(acting.world.report().instruments[0].grip_points, 0);
      EXPECT_EQ(acting.count(EventKind::cut), type == InstrumentType::scissors ? 1 : 0);
    }
}

}  // namespace
}  // namespace calot
