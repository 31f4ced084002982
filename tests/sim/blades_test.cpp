// What scissors do, on one tube that is held at both ends.

#include "acts/blades.h"

#include <gtest/gtest.h>

#include "act_rig.h"
#include "field/field_state.h"
#include "rig.h"

namespace calot {
namespace {

using test::about;
using test::across;
using test::Acting;
using test::tube_depth;

TEST(Scissors, DivideTheTubeThatIsBetweenTheirBladesWhereItIs) {
  for (const SolverMotion motion : {SolverMotion::dynamics, SolverMotion::statics}) {
    Acting scene(across(InstrumentType::scissors, motion));
    ASSERT_TRUE(scene.reach());
    EXPECT_TRUE(scene.has("duct"));
    ASSERT_TRUE(scene.go(about(0), 12));
    ASSERT_TRUE(scene.has("duct.patient"));
    ASSERT_TRUE(scene.has("duct.specimen"));
    EXPECT_EQ(scene.count(EventKind::cut), 1);
    EXPECT_EQ(scene.count(EventKind::cut_unclipped), 1);
    EXPECT_EQ(scene.count(EventKind::empty_cut) + scene.count(EventKind::empty_grasp), 0);
    for (const WorldEvent& event : scene.events)
      if (event.kind == EventKind::cut) {
        EXPECT_EQ(event.instrument + " " + event.organ, "right duct");
        EXPECT_NEAR(event.value, 0.5, 0.05);
      }
    // They open, leave, and are felt again.
    ASSERT_TRUE(scene.go(about(0.7), 6) && scene.go(about(0.7, tube_depth - 25e-3), 12));
    for (const Organ& organ : scene.world.field().organs) EXPECT_TRUE(organ.unfelt.empty());
    EXPECT_EQ(scene.count(EventKind::release), 0);
  }
}

TEST(Scissors, ADividedTubeCarriesNoForceAcross) {
  // What is cut off hangs on a second tube, until it is untied from it.
  SceneDefinition scene = across(InstrumentType::scissors);
  scene.anatomy.organs[0].held.pop_back();
  OrganDefinition wall = test::tube_across("wall");
  std::get<TubeShape>(wall.shape).points = {{-15e-3, 17e-3, -tube_depth}, {15e-3, 17e-3, -tube_depth}};
  scene.anatomy.organs.push_back(wall);
  scene.anatomy.joints = {{"duct.end", "wall.middle", 4e-3, 2e3}};
  Acting cut(scene);
  ASSERT_TRUE(cut.reach() && cut.go(about(0), 12) && cut.go(about(0.7), 6));
  ASSERT_TRUE(cut.has("duct.patient"));
  const Vec3 start = cut.world.landmark("duct.patient.start"), end = cut.world.landmark("duct.specimen.end");
  ASSERT_TRUE(cut.world.untie("duct.specimen", "wall"));
  ASSERT_TRUE(cut.go(about(0.7, tube_depth - 25e-3), 12));
  EXPECT_LT((cut.world.landmark("duct.patient.start") - start).norm(), 0.3e-3);
  EXPECT_GT((cut.world.landmark("duct.specimen.end") - end).norm(), 50e-3);
}

TEST(Scissors, CloseOnAirAndSaySo) {
  Acting scene(across(InstrumentType::scissors));
  ASSERT_TRUE(scene.go(about(0.5, tube_depth - 30e-3), 2) && scene.go(about(0, tube_depth - 30e-3), 4));
  EXPECT_EQ(scene.count(EventKind::empty_cut), 1);
  EXPECT_EQ(scene.count(EventKind::empty_grasp), 0);
  EXPECT_TRUE(scene.has("duct"));
}

TEST(Scissors, DivideAtTheSamePlaceAtEveryRate) {
  std::vector<Vec3> ends;
  for (const double rate : {25.0, 200.0}) {
    SceneDefinition definition = across(InstrumentType::scissors, SolverMotion::statics);
    definition.solver.rate = rate;
    Acting scene(definition);
    const int finer = rate > 100 ? 4 : 1;
    ASSERT_TRUE(scene.reach() && scene.go(about(0), 4 * finer));
    ASSERT_TRUE(scene.has("duct.patient"));
    ends.push_back(scene.world.landmark("duct.patient.end"));
  }
  EXPECT_LT((ends[0] - ends[1]).norm(), 0.02e-3);
}

TEST(Scissors, SetBackToBeforeACutTheSameStepsHaveTheSameBits) {
  Acting scene(across(InstrumentType::scissors));
  ASSERT_TRUE(scene.reach());
  const FieldState before = scene.world.state();
  ASSERT_TRUE(scene.go(about(0), 12));
  const std::uint64_t hash = scene.world.state_hash();
  ASSERT_TRUE(scene.world.restore(before));
  EXPECT_TRUE(scene.has("duct"));
  ASSERT_TRUE(scene.go(about(0), 12));
  EXPECT_EQ(scene.world.state_hash(), hash);
}

/// Strands of the first tissue whose middle lies between the blades of the first tool if these were open by `angle`, rad.
int strands_between(const Field& field, double angle) {
  const Tool& tool = field.tools[0];
  const Pose to_hinge = hinge_frame(tool.trocar, tool.pose, tool.geometry).inverse();
  const VecX& middles = field.tissues[0].now.state.x;
  int count = 0;
  for (Eigen::Index i = 0; i < middles.size(); i += 3) {
    const Vec3 at = to_hinge * Vec3(middles.segment<3>(i));
    count += at.z() < tool.geometry.jaw_length && std::abs(at.x()) < at.z() * std::tan(angle / 2) ? 1 : 0;
  }
  return count;
}

TEST(Scissors, DivideTheStrandsBetweenTheirBladesAndNoOthers) {
  SceneDefinition definition = across(InstrumentType::scissors);
  definition.anatomy.organs[0] = test::tube_across("duct", 0);
  // Two ducts beside each other, to either side of the plane in which the blades open, and a sheet between them.
  definition.anatomy.organs.push_back(test::tube_across("other"));
  for (int k = 0; k < 2; ++k)
    for (Vec3& p : std::get<TubeShape>(definition.anatomy.organs[static_cast<std::size_t>(k)].shape).points) {
      std::swap(p.x(), p.y());
      p.y() = k == 0 ? -6e-3 : 6e-3;
    }
  TissueDefinition sheet;
  sheet.name = "sheet";
  sheet.from = "duct";
  sheet.to = "other";
  sheet.within = 14e-3;
  sheet.strands = 12;
  sheet.stiffness = 4e3;
  sheet.strength = 12e3;
  sheet.break_energy = 300;
  definition.anatomy.tissue = {sheet};
  Acting scene(definition);
  constexpr double opening = 0.6;
  ASSERT_TRUE(scene.reach(opening));
  const int between = strands_between(scene.world.field(), 0.9 * opening);
  ASSERT_GT(between, 1);
  ASSERT_TRUE(scene.go(about(0), 10));
  const TissueState& state = scene.world.report().tissues[0];
  EXPECT_GE(state.torn, between) << "blades push none of them before them";
  EXPECT_LT(state.torn, state.strands);
  EXPECT_EQ(state.blunt, 0);
  EXPECT_GE(scene.count(EventKind::cut), 1);
  EXPECT_EQ(scene.count(EventKind::tear), 0) << "what is cut is not torn";
  EXPECT_EQ(scene.count(EventKind::empty_cut), 0);
  EXPECT_TRUE(scene.has("duct") && scene.has("other"));
}

TEST(Scissors, ClosedOnAWallPerforateItAndGoOn) {
  SceneDefinition definition = test::ball_scene();
  InstrumentDefinition tool = default_instrument(InstrumentType::scissors);
  tool.name = "left";
  tool.port = definition.instruments[0].port;
  definition.instruments = {tool};
  test::FundusPath path(definition);
  ASSERT_TRUE(path.grasp()) << path.driver.why();
  EXPECT_EQ(path.driver.count(EventKind::perforation), 1);
  EXPECT_EQ(path.driver.count(EventKind::grasp), 0);
  ASSERT_TRUE(path.release() && path.withdraw()) << path.driver.why();
  EXPECT_EQ(path.driver.count(EventKind::release), 0);
  // By the hole bile leaves, as the blades made it.
  const std::vector<Opening>& openings = path.world.field().organs[0].openings;
  ASSERT_EQ(openings.size(), 1u);
  EXPECT_GT(openings[0].area, 0.4e-6);
  EXPECT_LT(openings[0].area, 10e-6);
  EXPECT_LT((path.world.field().organs[0].body->skin_rest()[openings[0].point] - path.fundus).norm(), 8e-3);
  EXPECT_EQ(path.driver.count(EventKind::bile_leak), 1);
  for (const WorldEvent& event : path.driver.events) {
    if (event.kind != EventKind::bile_leak) continue;
    EXPECT_EQ(event.instrument + " " + event.organ, "left ball");
  }
  ASSERT_EQ(path.world.report().lost.size(), 1u);
  EXPECT_GT(path.world.report().lost[0].bile, 1e-9);
}

TEST(Scissors, ClosedOnARigidThingCutNothing) {
  SceneDefinition definition = test::ball_scene();
  InstrumentDefinition tool = default_instrument(InstrumentType::scissors);
  tool.name = "left";
  tool.port = definition.instruments[0].port;
  tool.friction = 0.3;
  definition.instruments = {tool};
  OrganDefinition block;
  block.name = "block";
  RigidShape shape;
  shape.size = Vec3(2e-3, 16e-3, 14e-3);
  shape.rounding = 1e-3;
  shape.centre = Vec3(-80e-3, 70e-3, -112e-3);
  block.shape = shape;
  definition.anatomy.organs = {block};
  definition.anatomy.support = SupportDefinition{Vec3(0, 0, -120.2e-3), Vec3::UnitZ(), 0.3};
  definition.anatomy.friction = 0.3;
  definition.solver.motion = SolverMotion::dynamics;
  definition.laparoscope.look_at = "block.centre";
  Result<World> made = World::create(definition);
  ASSERT_TRUE(made) << to_text(made.failure());
  World& world = made.value();
  EXPECT_LT((world.landmark("block.centre") - shape.centre).norm(), 1e-3)
      << "its centre, not a point of its skin";
  test::Driver driver(world);
  const Vec3 top(-80e-3, 70e-3, -104e-3);
  ASSERT_TRUE(driver.go(top + Vec3(0, 0, 15e-3), 0.5, 5) && driver.go(top - Vec3(0, 0, 8e-3), 0.5, 5) &&
              driver.go(top - Vec3(0, 0, 8e-3), 0, 12) && driver.stay(2))
      << driver.why();
  EXPECT_EQ(driver.count(EventKind::perforation), 0);
  EXPECT_EQ(driver.count(EventKind::cut), 0);
  EXPECT_EQ(driver.count(EventKind::grasp), 0);
  EXPECT_GT(world.report().instruments[0].pose.jaw, 0.1) << "it is between them";
}

}  // namespace
}  // namespace calot
