// Laws of the world's step: determinism, failures, filling.

#include "world/world.h"

#include <gtest/gtest.h>

#include "act_rig.h"
#include "field_rig.h"
#include "milestone.h"
#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

TEST(World, SaysHowFarAnOrganCameToRestFromWhereItIsDrawn) {
  // A tube that is held at both ends sags most in its middle.
  const Result<World> world = World::create(test::across(InstrumentType::atraumatic_grasper));
  ASSERT_TRUE(world) << to_text(world.failure());
  ASSERT_EQ(world->rest_shifts().size(), 1u);
  const Vec3 drawn(0, 0, 1.8e-3 - test::tube_depth);  // of the middle, on top
  const double sag = (world->landmark("duct.middle") - drawn).norm();
  EXPECT_GT(sag, 1e-4);
  EXPECT_NEAR(world->rest_shifts()[0].distance, sag, 0.02 * sag);
  EXPECT_EQ(world->rest_shifts()[0].landmark, "middle");
}

std::vector<std::uint64_t> hashes_of_a_grasp(double depth) {
  test::FundusPath path(test::ball_scene());
  std::vector<std::uint64_t> hashes = {path.world.state_hash()};
  path.driver.watch = [&](const StepReport& report) { hashes.push_back(report.state_hash); };
  EXPECT_TRUE(path.grasp(2) && path.driver.go(path.fundus + depth * path.out, 0.0, 2)) << path.driver.why();
  return hashes;
}

TEST(World, SameInputsGiveTheSameStateHashesAndTheSmallestChangeOthers) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  const std::vector<std::uint64_t> first = hashes_of_a_grasp(2e-3), other = hashes_of_a_grasp(2e-3 + 1e-12);
  EXPECT_EQ(hashes_of_a_grasp(2e-3), first);
  for (std::size_t i = 1; i < first.size(); ++i) EXPECT_NE(first[i], first[i - 1]);
  ASSERT_EQ(first.size(), other.size());
  const std::size_t lift = first.size() - 2;  // the two steps of the lift differ, those before do not
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i] == other[i], i < lift);
}

TEST(World, StepWithUnchangedPosesLeavesTheStateBitIdentical) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  test::FundusPath path(test::ball_scene());
  const auto expect_still = [&] {
    const std::vector<Vec3> skin = path.world.skin_positions(OrganIndex(0));
    const StepReport before = path.world.report();
    ASSERT_TRUE(path.driver.stay(3)) << path.driver.why();
    const StepReport after = path.world.report();
    EXPECT_EQ(path.world.skin_positions(OrganIndex(0)), skin);
    EXPECT_EQ(after.organs[0].pressure, before.organs[0].pressure);
    EXPECT_EQ(after.instruments[0].force, before.instruments[0].force);
    EXPECT_TRUE(after.events.empty());
  };
  expect_still();
  ASSERT_TRUE(path.driver.go(path.fundus + 15e-3 * path.out, test::open_jaw, 2));
  ASSERT_TRUE(path.driver.go(path.fundus - 3e-3 * path.out, test::open_jaw, 4)) << path.driver.why();
  expect_still();
  ASSERT_TRUE(path.grasp(2) && path.lift()) << path.driver.why();
  expect_still();
}

TEST(World, TimeCountsStepsByTheRate) {
  SceneDefinition scene = test::grasper_scene(80);
  scene.solver.rate = 25;
  test::FundusPath path(scene);
  EXPECT_EQ(path.world.report().time, 0.0);
  ASSERT_TRUE(path.driver.stay(3));
  EXPECT_DOUBLE_EQ(path.world.report().time, 3.0 / 25);
}

TEST(World, FilledToAVolumeReadAtAPressureComesToThatPressure) {
  CALOT_SLOW_WHEN_SANITIZED("four rest states");
  SceneDefinition scene = test::grasper_scene(90);
  for (double pressure : {800.0, 2000.0}) {
    BileDefinition& bile = scene.anatomy.organs[0].bile;
    bile.fill_pressure = pressure;
    bile.fill_volume.reset();
    const OrganState by_pressure = World::create(scene).value().report().organs[0];
    // The author's pressure is met as closely as equilibrium is found.
    EXPECT_NEAR(by_pressure.pressure, pressure, 1e-6 * pressure);
    bile.fill_pressure.reset();
    bile.fill_volume = by_pressure.volume;
    const OrganState by_volume = World::create(scene).value().report().organs[0];
    EXPECT_NEAR(by_volume.volume, by_pressure.volume, 1e-9 * by_pressure.volume);
    EXPECT_NEAR(by_volume.pressure, pressure, 1e-5 * pressure);
    EXPECT_NEAR(by_volume.energy, by_pressure.energy, 1e-5 * by_pressure.energy);
  }
}

TEST(World, UnfilledOrganKeepsItsUnstressedVolume) {
  SceneDefinition scene = test::grasper_scene(90);
  scene.anatomy.organs[0].bile.fill_pressure.reset();
  const World world = World::create(scene).value();
  const double volume = world.report().organs[0].volume;
  EXPECT_GT(volume, 0.9 * 40e-6);  // the pear of 80 x 35 mm holds about 40 mL
  EXPECT_LT(volume, 1.1 * 40e-6);
}

TEST(World, FailedStepSaysWhereWhenAndWhatToDoAndLaterStepsFailAlike) {
  CALOT_SLOW_WHEN_SANITIZED("a motion that is tried over and over");
  // A coarse ball, grown on by three quarters, that closed jaws are sent through at 6 m/s.
  OrganDefinition ball = test::bedded_ball();
  ball.nodes = 20;
  ball.held[0].radius = 30e-3;
  SceneDefinition scene = test::ball_scene(ball);
  OrganDefinition elsewhere;
  elsewhere.name = "duct";
  elsewhere.shape = TubeShape{.points = {{0.1, 0, 0}, {0.13, 0, 0}}};
  elsewhere.wall.thickness = 0.8e-3;
  elsewhere.held = {{"first", "start", 4e-3, 1e6}};
  scene.anatomy.organs.insert(scene.anatomy.organs.begin(), elsewhere);
  World world = World::create(scene).value();
  test::Driver driver(world);
  const Vec3 top = world.landmark("ball.fundus"), out = (driver.trocar() - top).normalized();
  ASSERT_TRUE(driver.go(top + 2e-3 * out, 0.0, 2));
  driver.go(top - 120e-3 * out, 0.0, 1);
  ASSERT_TRUE(driver.failure) << "the tool went through";
  const Failure failure = *driver.failure;
  EXPECT_EQ(failure.kind, FailureKind::simulation);
  ASSERT_EQ(failure.problems.size(), 1u);
  const std::string& message = failure.problems[0].message;
  EXPECT_NE(message.find("'left'"), std::string::npos) << message;
  EXPECT_NE(message.find("'ball' finds no balance"), std::string::npos) << message;
  EXPECT_NE(message.find(" mm"), std::string::npos) << message;
  EXPECT_NE(message.find(" s"), std::string::npos) << message;
  EXPECT_FALSE(failure.problems[0].hint.empty());
  const std::uint64_t hash = world.state_hash();
  EXPECT_EQ(hash, world.report().state_hash) << "what was tried is undone";
  const std::vector<Vec3> skin = world.skin_positions(OrganIndex(0));
  StepInput retreat;
  retreat.instruments = {pose_reaching(driver.trocar(), top + 30e-3 * out, 0, 0)};
  for (int k = 0; k < 2; ++k) {
    const Result<StepReport> again = world.step(retreat);
    ASSERT_FALSE(again);
    EXPECT_EQ(to_text(again.failure()), to_text(failure));
    EXPECT_EQ(world.state_hash(), hash);
    EXPECT_EQ(world.skin_positions(OrganIndex(0)), skin);
  }
}

TEST(World, AnInterruptedStepChangesNothingAndTheWorldGoesOn) {
  CALOT_SLOW_WHEN_SANITIZED("a world pressed on");
  std::atomic<bool> stop = false;
  test::FundusPath path(test::grasper_scene(80), 1, &stop);  // where the skin is touched
  test::expect_refused_without_a_trace(path, [&] {
    StepInput input;
    input.instruments = {path.world.report().instruments[0].pose};
    input.instruments[0].insertion += 2e-3;
    stop = true;
    const Result<StepReport> step = path.world.step(input);
    stop = false;
    ASSERT_FALSE(step);
    EXPECT_EQ(step.failure().kind, FailureKind::interrupted);
  });
}

TEST(World, StepWithTooFewPosesIsRefusedAndChangesNothing) {
  CALOT_SLOW_WHEN_SANITIZED("a world pressed on");
  test::FundusPath path(test::grasper_scene(80));  // where the skin is touched
  test::expect_refused_without_a_trace(path, [&] {
    const Result<StepReport> step = path.world.step({});
    ASSERT_FALSE(step);
    EXPECT_EQ(step.failure().kind, FailureKind::internal);
  });
}

TEST(World, APoseBehindTheTrocarIsRefusedAndChangesNothing) {
  World world = World::create(test::grasper_scene(80)).value();
  const std::uint64_t hash = world.state_hash();
  StepInput input;
  input.instruments = {world.report().instruments[0].pose};
  input.instruments[0].insertion = -1e-3;
  const Result<StepReport> step = world.step(input);
  ASSERT_FALSE(step);
  EXPECT_EQ(step.failure().kind, FailureKind::scenario);
  EXPECT_NE(step.failure().problems[0].hint.find("insertion is 0 to"), std::string::npos);
  EXPECT_EQ(world.state_hash(), hash);
}

TEST(World, NamesThatTheSceneDoesNotHaveAreNoPlaces) {
  const World world = World::create(test::grasper_scene(80)).value();
  EXPECT_GT(world.landmark("gallbladder.fundus").norm(), 0);
  EXPECT_THROW(world.landmark("gallbladder.nose"), std::logic_error);
  EXPECT_THROW(world.landmark_normal("liver.fundus"), std::logic_error);
  EXPECT_THROW(world.port_position("transvaginal"), std::logic_error);
}

TEST(World, ToolThatStartsInsideAnOrganIsRefused) {
  SceneDefinition scene = test::grasper_scene(80);
  const World world = World::create(scene).value();
  const std::vector<Vec3> skin = world.skin_positions(OrganIndex(0));
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : skin) middle += p / static_cast<double>(skin.size());
  scene.ports = {{"umbilical", Vec3::Zero()}, {"right_subcostal", middle}};
  const Result<World> refused = World::create(scene);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.failure().kind, FailureKind::scenario);
}

TEST(World, UpIsOppositeToGravityOnATiltedTable) {
  SceneDefinition scene = test::grasper_scene(80);
  scene.anatomy.table_head_up = 0;
  scene.anatomy.table_left_down = 0;
  EXPECT_LT((World::create(scene).value().up() - Vec3::UnitZ()).norm(), 1e-15);
  // Head up: the patient's head (+y) is nearer to the ceiling; left side down: the left (+x) further from it.
  scene.anatomy.table_head_up = 0.3;
  EXPECT_NEAR(World::create(scene).value().up().y(), std::sin(0.3), 1e-15);
  scene.anatomy.table_head_up = 0;
  scene.anatomy.table_left_down = 0.2;
  EXPECT_NEAR(World::create(scene).value().up().x(), -std::sin(0.2), 1e-15);
}

}  // namespace
}  // namespace calot
