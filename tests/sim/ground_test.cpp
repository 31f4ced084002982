// Instruments and what lies around the organs and stays.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "acts/hands.h"
#include "base/units.h"
#include "field/field.h"
#include "rig.h"
#include "support/derivatives.h"
#include "support/random.h"
#include "tool_rig.h"
#include "tools/ground_meeting.h"

namespace calot {
namespace {

const std::vector<Shape> shapes{
    Plane{{0, 0, -0.13}, Vec3(0.2, 0.1, 1).normalized()},
    Capsule{{-0.05, 0.02, -0.14}, {0.05, 0.03, -0.15}, 15e-3},
    RoundedBox{Pose(Eigen::Translation3d(0.01, 0.01, -0.15)), {20e-3, 20e-3, 10e-3}, 3e-3}};

TEST(GroundMeeting, ItsForcesAndStiffnessAreTheSlopesOfItsEnergyWhateverShape) {
  Rng rng(7);
  for (const Shape& shape : shapes) {
    int balanced = 0;
    for (int k = 0; k < 20000 && balanced < 5; ++k) {
      Tool tool;
      tool.geometry = instrument_geometry(InstrumentType::atraumatic_grasper);
      const GroundMeeting meeting(tool, 0, {shape});
      const Vec3 tip = Vec3(0.01, 0.02, -0.125) + test::random_vector(rng, 15e-3);
      const VecX x =
          tool_coordinates(pose_reaching(tool.trocar, tip, rng.uniform(-2, 2), 0.5, tool.geometry));
      if (const double gap = meeting.gap(x, 0.05e-3); gap > 0.04e-3 || gap < -0.03e-3) continue;
      ++balanced;
      const auto value = [&](const VecX& at) { return meeting.value(at); };
      const auto slope = [&](const VecX& at) {
        VecX out = VecX::Zero(6);
        meeting.add_gradient(at, out);
        return out;
      };
      const VecX expected = test::difference_gradient(value, x, 1e-9);
      EXPECT_GT(expected.norm(), 1e-3);
      EXPECT_LT(test::relative_error(slope(x), expected), 1e-5);
      std::vector<std::vector<int>> cliques;
      meeting.add_cliques(x, true, cliques);
      BlockMatrix matrix(2, cliques);
      meeting.add_hessian(x, matrix);
      EXPECT_LT(test::relative_error(test::dense(matrix), test::difference_hessian(slope, x, 1e-10)), 1e-4);
    }
    EXPECT_GE(balanced, 5) << shape.index();
  }
}

/// An instrument that comes straight down from its port on a slab of ground, beside a ball that nobody touches.
struct Slab {
  World world;
  test::Driver driver;
  Vec3 above;

  explicit Slab(InstrumentType type, GroundType ground = GroundType::box) : Slab(scene(type, ground)) {}
  explicit Slab(const SceneDefinition& scene)
      : world(World::create(scene).value()), driver(world), above(driver.trocar() + Vec3(5e-3, 0, -70e-3)) {}
  static SceneDefinition scene(InstrumentType type, GroundType kind) {
    SceneDefinition scene = test::ball_scene();
    InstrumentDefinition tool = default_instrument(type);
    tool.name = "left";
    tool.port = scene.instruments[0].port;
    scene.instruments[0] = tool;
    for (Vec3* place : {&scene.anatomy.organs[0].neck, &scene.anatomy.organs[0].fundus})
      *place += Vec3(0.1, 0.1, 0.08);
    GroundDefinition ground;
    ground.name = "slab";
    ground.type = kind;
    ground.point = Vec3(-80e-3, 70e-3, -110e-3);
    ground.normal = Vec3::UnitZ();
    ground.size = Vec3(30e-3, 30e-3, 20e-3);
    if (kind == GroundType::capsule) {
      ground.to = ground.point + Vec3(20e-3, 0, 0);
      ground.point -= Vec3(20e-3, 0, 0);
      ground.radius = 14e-3;
    }
    if (kind == GroundType::plane) ground.point.z() = -98e-3;
    scene.anatomy.ground = {ground};
    return scene;
  }
  /// m, of the ground's surface below the instrument.
  double top() const {
    const Vec3 over(above.x(), above.y(), 0);
    return -signed_distance(world.field().ground[0].shape, over);
  }
  /// m, of the instrument's surface in the ground, as both are made; 0: it is out of it.
  double depth() const {
    const Field& field = world.field();
    const GroundMeeting meeting(field.tools[0], 0, {field.ground[0].shape});
    return std::max(0.0, -meeting.gap(tool_coordinates(field.tools[0].pose), 1e-3));
  }
};

TEST(InstrumentOnGround, StopsAtItWhateverInstrumentAndShapeAndPressesNoHarderThanItsHand) {
  for (const std::string& name : instrument_type_names())
    for (const GroundType kind : {GroundType::box, GroundType::plane, GroundType::capsule}) {
      const std::string what = fmt::format("{} on ground {}", name, static_cast<int>(kind));
      Slab slab(*instrument_type_called(name), kind);
      double deepest = 0, strongest = 0;
      slab.driver.watch = [&](const StepReport& report) {
        deepest = std::max(deepest, slab.depth());
        strongest = std::max(strongest, report.instruments[0].handle_force.norm());
      };
      ASSERT_TRUE(slab.driver.go(slab.above, 0, 10)) << what << ": " << slab.driver.why();
      EXPECT_FALSE(slab.world.report().instruments[0].touching) << what;
      ASSERT_TRUE(slab.driver.go(slab.above - Vec3(0, 0, 35e-3), 0, 25)) << what << ": " << slab.driver.why();
      const InstrumentState& state = slab.world.report().instruments[0];
      EXPECT_EQ(state.touches, "slab") << what;
      EXPECT_GT(state.load_on(ToolPart::jaws).force.z(), 15) << what;
      EXPECT_EQ(state.load_on(ToolPart::jaws).organ, "slab") << what;
      EXPECT_GT(state.lag, 1e-3) << what << ": the hand gives way";
      EXPECT_LT(deepest, 0.1e-3) << what;
      EXPECT_LT(strongest, 1.3 * slab.world.scene().instruments[0].hand_force)
          << what << ", with its port's drag";
      EXPECT_EQ(slab.driver.count(EventKind::contact), 1) << what;
      ASSERT_TRUE(slab.driver.go(slab.above, 0, 15)) << what << ": " << slab.driver.why();
      EXPECT_FALSE(slab.world.report().instruments[0].touching) << what;
      EXPECT_LT(slab.world.report().instruments[0].lag, 1e-9) << what;
    }
}

/// Injuries of a kind of ground's looks: what each was called, by its cause.
std::map<std::string, std::string> injuries(const test::Driver& driver) {
  std::map<std::string, std::string> out;
  for (const WorldEvent& event : driver.events)
    if (event.kind == EventKind::injury) out[to_text(event.cause)] += event.text;
  return out;
}

using Called = std::map<std::string, std::string>;

TEST(InstrumentOnGround, AThrustBeyondItsLimitHurtsBowelAndLiverOnceUntilItIsLetGo) {
  const std::pair<GroundLooks, std::string> all[] = {{GroundLooks::liver, "liver injured"},
                                                     {GroundLooks::bowel, "bowel injured"},
                                                     {GroundLooks::fat, ""},
                                                     {GroundLooks::peritoneum, ""},
                                                     {GroundLooks::usual, ""}};
  for (const auto& [looks, called] : all)
    for (const std::string& name : instrument_type_names()) {
      // A bowel is round.
      SceneDefinition scene = Slab::scene(
          *instrument_type_called(name), looks == GroundLooks::bowel ? GroundType::capsule : GroundType::box);
      scene.anatomy.ground[0].looks = looks;
      Slab slab(scene);
      ASSERT_TRUE(slab.driver.go(slab.above, 0, 5)) << name << slab.driver.why();
      const Vec3 gentle(slab.above.x(), slab.above.y(), slab.top() - 0.01e-3);
      ASSERT_TRUE(slab.driver.go(gentle, 0, 5)) << name << slab.driver.why();
      EXPECT_TRUE(injuries(slab.driver).empty()) << name << " is laid on it";
      ASSERT_TRUE(slab.driver.go(slab.above - Vec3(0, 0, 30e-3), 0, 8)) << name << slab.driver.why();
      EXPECT_EQ(injuries(slab.driver), called.empty() ? Called{} : Called({{"thrust", called}})) << name;
      EXPECT_EQ(slab.world.field().wounds.size(), called.empty() ? 0u : 1u) << name;
      ASSERT_TRUE(slab.driver.go(slab.above, 0, 5) && slab.driver.go(slab.above - Vec3(0, 0, 30e-3), 0, 5));
      EXPECT_EQ(injuries(slab.driver), called.empty() ? Called{} : Called({{"thrust", called + called}}))
          << name << " comes again";
    }
}

TEST(InstrumentOnGround, WoundsAndWhatIsHurtAlreadyAreInTheStateAndItsBytes) {
  SceneDefinition scene = Slab::scene(InstrumentType::atraumatic_grasper, GroundType::box);
  scene.anatomy.ground[0].looks = GroundLooks::liver;
  Slab slab(scene);
  ASSERT_TRUE(slab.driver.go(slab.above, 0, 5) && slab.driver.go(slab.above - Vec3(0, 0, 30e-3), 0, 8));
  ASSERT_EQ(slab.world.field().wounds.size(), 1u);
  Result<World> other = World::from_bytes(scene, slab.world.to_bytes());
  ASSERT_TRUE(other) << to_text(other.failure());
  EXPECT_EQ(other->field().wounds.size(), 1u);
  EXPECT_EQ(other->state_hash(), slab.world.state_hash());
  StepInput input;
  input.instruments = {slab.world.report().instruments[0].pose};
  input.instruments[0].insertion += 1e-3;
  const Result<StepReport> here = slab.world.step(input), there = other->step(input);
  ASSERT_TRUE(here && there);
  EXPECT_EQ(here->state_hash, there->state_hash);
  EXPECT_EQ(slab.world.field().wounds.size(), 1u) << "it was never off it";
}

TEST(InstrumentOnGround, TwoGroundsAreHurtEachByItself) {
  SceneDefinition scene = Slab::scene(InstrumentType::atraumatic_grasper, GroundType::box);
  GroundDefinition& one = scene.anatomy.ground[0];
  one.looks = GroundLooks::liver;
  one.size.x() = 10e-3;
  one.point.x() -= 2e-3;
  GroundDefinition other = one;
  other.name = "other";
  other.point.x() += 17e-3;  // their round edges meet where the tip comes down
  scene.anatomy.ground.push_back(other);
  Slab slab(scene);
  ASSERT_TRUE(slab.driver.go(slab.above, 0, 5) && slab.driver.go(slab.above - Vec3(0, 0, 35e-3), 0, 20))
      << slab.driver.why();
  int hurt = 0;
  for (const WorldEvent& event : slab.driver.events) hurt += event.kind == EventKind::injury ? 1 : 0;
  EXPECT_EQ(hurt, 2);
  EXPECT_EQ(slab.world.report().instruments[0].load_on(ToolPart::jaws).organ.empty(), false);
}

TEST(InstrumentOnGround, BladesThatCloseOnItCurrentAndClipsHurtIt) {
  for (const InstrumentType type : {InstrumentType::scissors, InstrumentType::atraumatic_grasper}) {
    SceneDefinition scene = Slab::scene(type, GroundType::box);
    scene.anatomy.ground[0].injury = "duodenum opened";
    Slab slab(scene);
    const Vec3 laid(slab.above.x(), slab.above.y(), slab.top() - 0.02e-3);
    ASSERT_TRUE(slab.driver.go(slab.above, 0.3, 5) && slab.driver.go(laid, 0.3, 5) &&
                slab.driver.go(laid, 0.1, 5));
    EXPECT_EQ(injuries(slab.driver),
              type == InstrumentType::scissors ? Called({{"scissors", "duodenum opened"}}) : Called{});
  }
  for (const auto& [type, action, cause] :
       {std::tuple{InstrumentType::l_hook, InstrumentAction::activate, EventCause::current},
        std::tuple{InstrumentType::clip_applier, InstrumentAction::fire, EventCause::clip}}) {
    SceneDefinition scene = Slab::scene(type, GroundType::capsule);
    scene.anatomy.ground[0].looks = GroundLooks::bowel;
    Slab slab(scene);
    const Vec3 laid(slab.above.x(), slab.above.y(), slab.top() - 0.02e-3);
    StepInput input;
    ASSERT_TRUE(slab.driver.go(slab.above, 0, 5) && slab.driver.go(laid, 0, 5)) << slab.driver.why();
    ASSERT_TRUE(slab.world.report().instruments[0].touching);
    input.instruments = {slab.world.report().instruments[0].pose};
    input.actions = {action};
    const Result<StepReport> report = slab.world.step(input);
    ASSERT_TRUE(report) << to_text(report.failure());
    EXPECT_EQ(std::count_if(report->events.begin(), report->events.end(),
                            [wanted = cause](const WorldEvent& event) {
                              return event.kind == EventKind::injury && event.cause == wanted &&
                                     event.organ == "slab" && event.place;
                            }),
              1);
  }
}

TEST(InstrumentOnGround, WhatTouchesNoneComesWhereItIsCommandedToTheBit) {
  Slab slab(InstrumentType::atraumatic_grasper);
  SceneDefinition bare = Slab::scene(InstrumentType::atraumatic_grasper, GroundType::box);
  bare.anatomy.ground.clear();
  World other = World::create(bare).value();
  test::Driver driver(other);
  // To half a millimetre above it, where it is looked for and not met.
  const Vec3 place(slab.above.x(), slab.above.y(), slab.top() + 0.5e-3);
  ASSERT_TRUE(slab.driver.go(place, 0.3, 10));
  ASSERT_TRUE(driver.go(place, 0.3, 10));
  EXPECT_EQ(slab.world.report().instruments[0].pose, other.report().instruments[0].pose);
}

}  // namespace
}  // namespace calot
