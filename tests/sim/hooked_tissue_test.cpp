// Instruments among the strands of a world.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "field/field_state.h"
#include "organs/tissue.h"
#include "rail_rig.h"
#include "rig.h"

namespace calot {
namespace {

using test::rail_height;

/// Two stiff rails along x, 16 mm apart, with a few strands across between them, about x = -80 mm; the instrument's port
/// is above.
/// `reach`: m, break energy by strength.
SceneDefinition railed(SolverMotion motion, double strength, double reach = 60e-3) {
  SceneDefinition scene = test::ball_scene();
  scene.anatomy.organs = {test::rail("near", 82e-3), test::rail("far", 98e-3)};
  TissueDefinition tissue;
  tissue.name = "veil";
  tissue.from = "near";
  tissue.to = "far";
  tissue.within = 13e-3;
  tissue.start = 0.46;
  tissue.stop = 0.54;
  tissue.strands = 3;
  tissue.strength = strength;
  tissue.stiffness = strength / 3;
  tissue.break_energy = reach * strength;
  scene.anatomy.tissue = {tissue};
  scene.solver.motion = motion;
  scene.ports = {{"umbilical", Vec3::Zero()}, {"right_subcostal", Vec3(-80e-3, 90e-3, 100e-3)}};
  scene.laparoscope.look_at = "near.middle";
  InstrumentDefinition electrode = default_instrument(InstrumentType::bipolar_electrode);
  electrode.name = "left";
  electrode.port = "right_subcostal";
  electrode.force_limit = 100;
  scene.instruments = {electrode};
  return scene;
}

World railed_world(const SceneDefinition& scene, int threads = 1) {
  Result<World> world = World::create(scene, nullptr, threads);
  EXPECT_TRUE(world) << to_text(world.failure());
  return std::move(world).value();
}

/// How far before the shaft, along x, the strands cross it: negative where one that is whole is behind it.
double least_ahead(const World& world, const Vec3& tip, const Vec3& up) {
  const Field& field = world.field();
  const Tissue& tissue = field.tissues[0];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < tissue.now.opened.size(); ++i) {
    const PlacedStrand& strand = tissue.strands->strands()[i];
    if (strand.strand.law.torn(tissue.now.opened[i])) continue;
    const auto end = [&](const CarriedPlace& place, int body) {
      Vec3 sum = Vec3::Zero();
      for (std::size_t k = 0; k < place.points.size(); ++k)
        sum += place.weights[k] *
               field.organs[body].body->skin_point(place.points[k], field.organs[body].state.x);
      return sum;
    };
    const std::array<Vec3, 3> at{end(strand.one, 0), tissue.now.state.x.segment<3>(3 * Eigen::Index(i)),
                                 end(strand.other, 1)};
    for (int piece = 0; piece < 2; ++piece)
      for (double share = 0; share <= 1; share += 0.01) {
        const Vec3 p = at[piece] + share * (at[piece + 1] - at[piece]);
        const Vec3 beside = p - tip - (p - tip).dot(up) * up;
        if (std::abs(beside.y()) < 2e-3) least = std::min(least, beside.x());
      }
  }
  return least;
}

struct DrawnAlong {
  double largest = 0, last = 0;  ///< N
  double least_ahead = 1;        ///< m
  int torn = 0, blunt = 0;
  bool followed = false;
  std::string why;
  std::vector<std::uint64_t> hashes;
  std::vector<WorldEvent> events;
};

/// A shaft between the rails, its tip below the strands, is drawn along at 500 mm/s.
DrawnAlong draw_along(const SceneDefinition& scene, double to = -65e-3, int threads = 1) {
  World world = railed_world(scene, threads);
  test::Driver driver(world);
  DrawnAlong out;
  driver.watch = [&](const StepReport& report) {
    const InstrumentState& tool = report.instruments[0];
    out.last = tool.force.norm();
    out.largest = std::max(out.largest, out.last);
    out.least_ahead =
        std::min(out.least_ahead, least_ahead(world, tool.tip, (driver.trocar() - tool.tip).normalized()));
    out.hashes.push_back(report.state_hash);
  };
  const double below = rail_height - 25e-3;
  EXPECT_TRUE(driver.go({-95e-3, 90e-3, below}, 0, 12)) << driver.why();
  EXPECT_EQ(out.largest, 0) << "it meets nothing on its way";
  out.followed = driver.go({to, 90e-3, below}, 0, static_cast<int>(std::lround((to + 95e-3) / 10e-3)));
  out.why = driver.why();
  out.torn = world.report().tissues[0].torn;
  out.blunt = world.report().tissues[0].blunt;
  out.events = driver.events;
  return out;
}

TEST(HookedTissue, AToolDrawnAcrossStrandsAt500MillimetresASecondNeverPasses) {
  for (SolverMotion motion : {SolverMotion::statics, SolverMotion::dynamics}) {
    const DrawnAlong strong = draw_along(railed(motion, 300e3));
    EXPECT_TRUE(strong.followed) << strong.why;
    EXPECT_GT(strong.least_ahead, 0) << "all lie before the shaft";
    EXPECT_GT(strong.largest, 0.5);
    EXPECT_EQ(strong.torn, 0);
    ASSERT_FALSE(strong.events.empty());
    EXPECT_EQ(strong.events[0].kind, EventKind::contact);
    EXPECT_EQ(strong.events[0].organ, "veil");
  }
}

TEST(HookedTissue, PulledPastItsStrengthItTearsAndTheToolComesFreeWithTheSameBitsOnTwoThreads) {
  const SceneDefinition scene = railed(SolverMotion::dynamics, 15e3, 14e-3);
  const DrawnAlong weak = draw_along(scene, -35e-3);
  EXPECT_TRUE(weak.followed) << weak.why;
  EXPECT_EQ(weak.torn, 3);
  EXPECT_EQ(weak.blunt, 3);
  EXPECT_GT(weak.largest, 0.1);
  EXPECT_EQ(weak.last, 0);
  EXPECT_EQ(weak.events.back().kind, EventKind::parted);
  EXPECT_EQ(draw_along(scene, -35e-3, 2).hashes, weak.hashes);
}

TEST(HookedTissue, AnInstrumentDoesNotBeginAmongStrands) {
  SceneDefinition scene = railed(SolverMotion::dynamics, 100e3);
  // It waits 30 mm deep, and looks at the first organ.
  OrganDefinition aim = scene.anatomy.organs[0];
  aim.name = "aim";
  aim.shape =
      TubeShape{.points = {Vec3(-80e-3, 90e-3, -140e-3), Vec3(-60e-3, 90e-3, -140e-3)}, .radius = 2e-3};
  scene.anatomy.organs.insert(scene.anatomy.organs.begin(), aim);
  scene.ports[1].position.z() = rail_height + 20e-3;
  const Result<World> world = World::create(scene);
  ASSERT_FALSE(world);
  EXPECT_THAT(to_text(world.failure()), testing::HasSubstr("touches strands of 'veil'"));
  scene.anatomy.tissue[0].radius = 0;
  EXPECT_TRUE(World::create(scene)) << "which it does not feel then";
}

/// Steps with the electrode where it is.
std::vector<WorldEvent> keep_acting(World& world, InstrumentAction action, int steps) {
  std::vector<WorldEvent> events;
  for (int k = 0; k < steps; ++k) {
    const Result<StepReport> report = world.step({{world.report().instruments[0].pose}, {action}});
    EXPECT_TRUE(report) << to_text(report.failure());
    if (!report) break;
    events.insert(events.end(), report->events.begin(), report->events.end());
  }
  return events;
}

std::vector<EventKind> kinds_of(const std::vector<WorldEvent>& events) {
  std::vector<EventKind> out;
  for (const WorldEvent& event : events) out.push_back(event.kind);
  return out;
}

TEST(HookedTissue, CurrentDividesWhatItsElectrodeTouchesByPowerAndTime) {
  using enum EventKind;
  SceneDefinition scene = railed(SolverMotion::dynamics, 100e3);
  scene.anatomy.tissue[0].divide_energy = 2e6;
  World world = railed_world(scene);
  test::Driver driver(world);
  const double level = rail_height - 6e-3;
  ASSERT_TRUE(driver.go({-95e-3, 90e-3, level}, 0, 12)) << driver.why();
  const auto in_the_air = kinds_of(keep_acting(world, InstrumentAction::activate, 20));
  EXPECT_EQ(in_the_air, (std::vector{activation, dry_activation})) << "no contact, no cut, one error";
  ASSERT_TRUE(driver.go({-83.4e-3, 90e-3, level}, 0, 8)) << driver.why();
  ASSERT_TRUE(world.report().instruments[0].touching);
  EXPECT_TRUE(keep_acting(world, InstrumentAction::none, 20).empty()) << "no current, no cut";
  EXPECT_EQ(world.report().tissues[0].torn, 0);

  // One strand is touched: it takes all of the power.
  const Field& field = world.field();
  std::size_t first = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (field.tissues[0].now.state.x[3 * Eigen::Index(i)] <
        field.tissues[0].now.state.x[3 * Eigen::Index(first)])
      first = i;
  const double area = field.tissues[0].strands->strands()[first].area;
  const int steps = static_cast<int>(std::ceil(2e6 * area / 30 * scene.solver.rate));
  ASSERT_GT(steps, 3);
  EXPECT_EQ(kinds_of(keep_acting(world, InstrumentAction::activate, steps - 1)), std::vector{activation});
  const FieldState before = world.state();
  const std::vector<WorldEvent> parted_now = keep_acting(world, InstrumentAction::activate, 1);
  ASSERT_EQ(kinds_of(parted_now), std::vector{divided});
  EXPECT_EQ(parted_now[0].instrument, "left");
  EXPECT_EQ(parted_now[0].organ, "veil");
  EXPECT_NEAR(parted_now[0].value, area / 1e-6, 1e-9);
  EXPECT_EQ(world.report().tissues[0].torn, 1);
  const std::uint64_t hash = world.report().state_hash;
  ASSERT_TRUE(world.restore(before));
  keep_acting(world, InstrumentAction::activate, 1);
  EXPECT_EQ(world.report().state_hash, hash) << "what it had taken is part of the state";
  EXPECT_TRUE(keep_acting(world, InstrumentAction::activate, 5).empty()) << "let go of soon enough";
  EXPECT_FALSE(world.report().instruments[0].touching) << "a divided strand is not felt";
  EXPECT_EQ(world.report().instruments[0].force.norm(), 0);
}

TEST(HookedTissue, AStrandAndAWallThatIsNearShareThePowerByTheirWeights) {
  SceneDefinition scene = railed(SolverMotion::dynamics, 100e3);
  scene.anatomy.tissue[0].divide_energy = 1e8;
  scene.anatomy.organs[0].wall.burn_reach = 5e-3;
  World world = railed_world(scene);
  test::Driver driver(world);
  const double level = rail_height - 6e-3;
  ASSERT_TRUE(driver.go({-95e-3, 90e-3, level}, 0, 12)) << driver.why();
  ASSERT_TRUE(driver.go({-83.4e-3, 90e-3, level}, 0, 8)) << driver.why();
  const double distance = world.clearance(ToolIndex(0), OrganIndex(0));
  const double weight = (5e-3 - distance) / (5e-3 - 0.05e-3);
  ASSERT_GT(weight, 0.1);
  keep_acting(world, InstrumentAction::activate, 10);
  double strands = 0, wall = 0;  // J
  for (const double heated : world.field().tissues[0].now.heated) strands += heated;
  for (const Burn& burn : world.field().organs[0].burns) wall += burn.energy;
  EXPECT_NEAR(strands + wall, 10 * 30 / scene.solver.rate, 1e-9) << "J: 30 W, shared";
  EXPECT_NEAR(wall / strands, weight, 0.03);
  EXPECT_TRUE(world.field().organs[1].burns.empty()) << "the other's reach is 0.3 mm";
}

TEST(HookedTissue, JawsDivideAllThatTheyCarryAndTheLastStrandPartsTheTissue) {
  SceneDefinition scene = railed(SolverMotion::dynamics, 100e3);
  scene.anatomy.tissue[0].divide_energy = 1e4;
  InstrumentDefinition forceps = default_instrument(InstrumentType::semm_forceps);
  forceps.name = "left";
  forceps.port = "right_subcostal";
  scene.instruments = {forceps};
  World world = railed_world(scene);
  test::Driver driver(world);
  ASSERT_TRUE(driver.go({-95e-3, 90e-3, rail_height - 10e-3}, 0, 12)) << driver.why();
  ASSERT_TRUE(driver.go({-77e-3, 90e-3, rail_height - 10e-3}, 0, 12)) << driver.why();
  EXPECT_EQ(world.report().tissues[0].torn, 0);
  const std::vector<WorldEvent> events = keep_acting(world, InstrumentAction::activate, 5);
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.back().kind, EventKind::parted);
  EXPECT_EQ(world.report().tissues[0].torn, 3);
  EXPECT_EQ(world.report().tissues[0].blunt, 0);
}

}  // namespace
}  // namespace calot
