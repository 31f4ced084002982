// A world that was saved to bytes goes on from there as if it had not been, to the last bit, in this process and in another;
// what is no such world's bytes is refused.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "act_rig.h"
#include "field/field_state.h"
#include "support/long_run.h"
#include "support/text_files.h"
#include "triangle_rig.h"

namespace calot {
namespace {

/// Hashes of steps on which all tools are drawn back from where they are commanded to be, a little turned.
std::vector<std::uint64_t> hashes_of(World& world, int steps) {
  std::vector<std::uint64_t> out;
  StepInput input;
  for (const Tool& tool : world.field().tools) input.instruments.push_back(tool.command);
  for (int k = 0; k < steps; ++k) {
    for (InstrumentPose& pose : input.instruments) {
      pose.insertion = std::max(0.0, pose.insertion - 0.4e-3);
      pose.roll += 0.01;
    }
    const Result<StepReport> report = world.step(input);
    EXPECT_TRUE(report) << to_text(report.failure());
    if (!report) return out;
    out.push_back(report->state_hash);
  }
  return out;
}

/// The law.
void expect_goes_on_alike(World& world, int steps = 8) {
  const std::string bytes = world.to_bytes();
  Result<World> loaded = World::from_bytes(world.scene(), bytes);
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  EXPECT_EQ(loaded->state_hash(), world.state_hash());
  EXPECT_EQ(loaded->report().time, world.report().time);
  EXPECT_TRUE(loaded->to_bytes() == bytes);
  EXPECT_EQ(hashes_of(loaded.value(), steps), hashes_of(world, steps));
}

/// Calot's triangle after a clip, two divisions, a hole in the gallbladder, and some of its fat torn.
World operated_triangle(SolverMotion motion) {
  SceneDefinition scene = test::triangle_scene();
  scene.solver.motion = motion;
  scene.solver.extension_levels = 1;
  auto& artery = std::get<TubeShape>(scene.anatomy.organs[4].shape);
  artery.carries = Carries::blood;
  World world = World::create(scene).value();
  EXPECT_TRUE(world.clip("cystic_duct", 0.3, ClipSize::ml));
  EXPECT_TRUE(world.divide("cystic_duct", 0.55));
  EXPECT_TRUE(world.clip("cystic_duct.patient", 0.8, ClipSize::m));
  EXPECT_TRUE(world.divide("cystic_artery", 0.5));
  FieldState state = world.state();
  state.group.organs[0].openings.push_back({.point = 3, .area = 3e-6, .cause = "hook"});
  for (std::size_t k = 0; k < 4; ++k) state.group.tissues[0].opened[k] = 50;
  EXPECT_TRUE(world.restore(state));
  return world;
}

TEST(WorldBytes, OfARestGoOnAlike) {
  for (const SolverMotion motion : {SolverMotion::statics, SolverMotion::dynamics}) {
    SceneDefinition scene = test::triangle_scene();
    scene.solver.motion = motion;
    World world = World::create(scene).value();
    expect_goes_on_alike(world);
  }
}

TEST(WorldBytes, OfAFoldInJawsGoOnAlike) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  SceneDefinition scene = test::ball_scene();
  scene.solver.extension_levels = 2;
  scene.instruments[0].friction = 0.2;
  test::FundusPath path(scene);
  ASSERT_TRUE(path.grasp() && path.lift(2)) << path.driver.why();
  ASSERT_EQ(path.world.report().instruments[0].holds, "ball");
  ASSERT_GT(path.world.report().organs[0].details, 0);
  ASSERT_FALSE(path.world.field().organs[0].state.shares.empty());
  expect_goes_on_alike(path.world, 12);
}

TEST(WorldBytes, OfAnOperationGoOnAlike) {
  CALOT_SLOW_WHEN_SANITIZED("a field that is operated on");
  World world = operated_triangle(SolverMotion::dynamics);
  hashes_of(world, 4);
  EXPECT_GT(world.field().tissues[0].torn(), 0);
  EXPECT_FALSE(world.field().spill.drops.empty());
  EXPECT_GT(world.field().spill.drained[1], 0) << "blood";
  EXPECT_GT(world.report().lost.size(), 0u);
  EXPECT_TRUE(world.field().group.work.factored);
  expect_goes_on_alike(world, 10);
}

TEST(WorldBytes, OfAStaticOperationGoOnAlike) {
  CALOT_SLOW_WHEN_SANITIZED("a field that is operated on");
  World world = operated_triangle(SolverMotion::statics);
  hashes_of(world, 2);
  expect_goes_on_alike(world, 4);
}

TEST(WorldBytes, OfBodiesThatCameWereTiedAndLeftGoOnAlike) {
  CALOT_SLOW_WHEN_SANITIZED("a field that is operated on");
  World world = operated_triangle(SolverMotion::dynamics);
  OrganDefinition stone;
  stone.name = "stone";
  stone.shape = RigidShape{.centre = test::beside_neck(120, -30, -20)};
  ASSERT_TRUE(world.add(stone));
  ASSERT_TRUE(world.add(
      test::straight_tube("drain", test::beside_neck(48, 0, 25), test::beside_neck(98, 0, 25), 2e-3)));
  ASSERT_TRUE(world.tie({"drain.start", "common_duct.start", 4e-3, 2e3}));
  ASSERT_TRUE(world.divide("drain", 0.5));
  const std::string piece = world.report().organs.back().name;
  ASSERT_TRUE(world.divide(piece, 0.5)) << piece;
  ASSERT_TRUE(world.remove("cystic_artery.specimen", "taken out"));
  hashes_of(world, 2);
  const std::string bytes = world.to_bytes();
  const World loaded = World::from_bytes(world.scene(), bytes).value();
  for (const std::string gone : {"cystic_artery.specimen", "drain", "cystic_duct"})
    EXPECT_EQ(to_text(loaded.organ(gone).failure()), to_text(world.organ(gone).failure()));
  expect_goes_on_alike(world, 6);
  EXPECT_EQ(World::from_bytes(world.scene(), world.to_bytes())->report().organs.size(),
            world.report().organs.size());
}

TEST(WorldBytes, OfAFieldThatWasReleasedBoundAnewAndOpenedGoOnAlike) {
  CALOT_SLOW_WHEN_SANITIZED("a field that is operated on");
  World world = operated_triangle(SolverMotion::dynamics);
  const std::string bed = world.scene().anatomy.organs[0].held.front().name;
  ASSERT_TRUE(world.release("gallbladder", bed));
  ASSERT_TRUE(world.release("cystic_duct.patient", "last"));
  ASSERT_TRUE(world.remove_tissue("cystic_plate"));
  TissueDefinition bands = test::tissue_between("bands", "gallbladder", "liver", 12e-3, 12);
  bands.looks = TissueLooks::areolar;
  ASSERT_TRUE(world.add_tissue(bands));
  ASSERT_TRUE(world.open_tube("common_duct", 0.5, 1e-3));
  hashes_of(world, 2);
  EXPECT_EQ(world.report().tissues.back().name, "bands");
  const World loaded = World::from_bytes(world.scene(), world.to_bytes()).value();
  EXPECT_EQ(loaded.field().tissues.back().definition.looks, TissueLooks::areolar);
  expect_goes_on_alike(world, 6);
}

TEST(WorldBytes, OfATubeBetweenJawsAndItsClipsGoOnAlike) {
  test::Acting applier(test::across(InstrumentType::clip_applier));
  ASSERT_TRUE(applier.reach(0.35) && applier.fire());
  ASSERT_EQ(applier.world.report().organs[0].clips.size(), 1u);
  expect_goes_on_alike(applier.world);
  test::Acting grasper(test::across(InstrumentType::atraumatic_grasper));
  ASSERT_TRUE(grasper.reach());
  ASSERT_TRUE(grasper.go(test::about(0), 12));
  ASSERT_EQ(grasper.world.report().instruments[0].holds, "duct");
  expect_goes_on_alike(grasper.world);
}

TEST(WorldBytes, OfTubesThatRubOnEachOtherGoOnAlike) {
  for (const SolverMotion motion : {SolverMotion::statics, SolverMotion::dynamics}) {
    SceneDefinition scene = test::across(InstrumentType::atraumatic_grasper, motion);
    scene.anatomy.organs.push_back(test::tube_across("below"));
    const double depth = -test::tube_depth - 4.0e-3;
    std::get<TubeShape>(scene.anatomy.organs[1].shape).points = {
        {-15e-3, 1e-3, depth}, {0, 0, depth}, {15e-3, -1e-3, depth}};
    scene.anatomy.friction = 0.4;
    test::Acting acting(scene);
    ASSERT_TRUE(acting.go(test::about(0, test::tube_depth - 8e-3), 2));
    ASSERT_TRUE(acting.go(test::about(0, test::tube_depth + 0.6e-3), 10));
    InstrumentPose aside = test::about(0, test::tube_depth + 0.6e-3);
    aside.pitch = 4e-3;
    ASSERT_TRUE(acting.go(aside, 3));
    ASSERT_FALSE(acting.world.field().group.rubbing.empty());
    ASSERT_FALSE(acting.world.field().group.patterns.joined.empty());
    expect_goes_on_alike(acting.world, 4);
  }
}

TEST(WorldBytes, OfAStateThatWasGivenBackGoOnAlike) {
  // Then the solver's matrix is of a later step than its factor.
  World world = World::create(test::triangle_scene()).value();
  hashes_of(world, 2);
  const FieldState state = world.state();
  hashes_of(world, 4);
  ASSERT_TRUE(world.restore(state));
  ASSERT_TRUE(world.field().group.work.factored);
  expect_goes_on_alike(world, 4);
}

TEST(WorldBytes, ALoadedWorldCanBeGivenBackItsStates) {
  World world = World::create(test::triangle_scene()).value();
  World loaded = World::from_bytes(world.scene(), world.to_bytes()).value();
  const FieldState state = loaded.state();
  const std::vector<std::uint64_t> once = hashes_of(loaded, 3);
  ASSERT_TRUE(loaded.divide("cystic_duct", 0.5));
  ASSERT_TRUE(loaded.restore(state));
  EXPECT_EQ(hashes_of(loaded, 3), once);
}

// ---- another process

constexpr const char* saved_world =
    "CALOT_SAVED_WORLD";  // environment: a file, beside which the hashes are written
constexpr int steps_there = 6;

/// Not a law but the other process of the next one.
TEST(WorldBytes, DISABLED_OtherProcess) {
  const char* path = std::getenv(saved_world);
  ASSERT_NE(path, nullptr);
  std::stringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  Result<World> world = World::from_bytes(test::triangle_scene(), bytes.str());
  ASSERT_TRUE(world) << to_text(world.failure());
  std::ofstream out(std::string(path) + ".hashes");
  for (std::uint64_t hash : hashes_of(world.value(), steps_there)) out << hash << "\n";
}

TEST(WorldBytes, GoOnAlikeInAnotherProcess) {
  World world = World::create(test::triangle_scene()).value();
  ASSERT_TRUE(world.clip("cystic_duct", 0.3, ClipSize::ml));
  ASSERT_TRUE(world.divide("cystic_duct", 0.55));
  hashes_of(world, 2);
  const test::Folder folder;
  const std::string path = folder.write("world", world.to_bytes()), log = path + ".log";
  const std::string program = std::filesystem::read_symlink("/proc/self/exe");
  const std::string command = fmt::format(
      "{}='{}' '{}' --gtest_also_run_disabled_tests --gtest_filter=WorldBytes.DISABLED_OtherProcess "
      "> '{}' 2>&1",
      saved_world, path, program, log);
  std::stringstream said;
  const int status = std::system(command.c_str());
  said << std::ifstream(log).rdbuf();
  ASSERT_EQ(status, 0) << said.str();
  std::ifstream in(path + ".hashes");
  const std::vector<std::uint64_t> there{std::istream_iterator<std::uint64_t>(in), {}};
  EXPECT_EQ(there, hashes_of(world, steps_there));
}

// ---- what is refused

std::string why_not(const SceneDefinition& scene, const std::string& bytes) {
  const Result<World> loaded = World::from_bytes(scene, bytes);
  return loaded ? "" : to_text(loaded.failure());
}

TEST(WorldBytes, OfAnotherSceneAreRefused) {
  const SceneDefinition scene = test::ball_scene();
  const std::string bytes = World::create(scene).value().to_bytes();
  const auto refused = [&](const char* what, const std::function<void(SceneDefinition&)>& change) {
    SceneDefinition other = scene;
    change(other);
    EXPECT_THAT(why_not(other, bytes), testing::HasSubstr("of another scene")) << what;
  };
  EXPECT_EQ(why_not(scene, bytes), "");
  refused("organ", [](SceneDefinition& s) { s.anatomy.organs[0].wall.thickness *= 1.01; });
  refused("instrument", [](SceneDefinition& s) { s.instruments[0].pinch_force += 0.1; });
  refused("laparoscope", [](SceneDefinition& s) { s.laparoscope.distance += 1e-3; });
  refused("solver", [](SceneDefinition& s) { s.solver.rate *= 2; });
  refused("ports", [](SceneDefinition& s) {
    s.ports = default_ports();
    s.ports.back().position.x() += 1e-3;
  });
}

TEST(WorldBytes, ThatAreCutLongerOrDamagedAreRefused) {
  const SceneDefinition scene = test::ball_scene();
  const std::string bytes = World::create(scene).value().to_bytes();
  EXPECT_THAT(why_not(scene, ""), testing::HasSubstr("does not begin as one"));
  EXPECT_THAT(why_not(scene, "calot"), testing::HasSubstr("does not begin as one"));
  for (const std::size_t size : {std::size_t{12}, std::size_t{14}, std::size_t{40}, std::size_t{90},
                                 bytes.size() / 2, bytes.size() - 1})
    EXPECT_THAT(why_not(scene, bytes.substr(0, size)), testing::HasSubstr("cut off")) << size;
  EXPECT_THAT(why_not(scene, bytes + "x"), testing::HasSubstr("1 bytes follow its end"));
  std::string other = bytes;
  ++other[12];
  EXPECT_THAT(why_not(scene, other), testing::HasSubstr("version 10, and this program reads version 9"));
  for (std::size_t at = 100; at < bytes.size(); at += bytes.size() / 20) {
    other = bytes;
    other[at] = static_cast<char>(other[at] ^ 1);
    EXPECT_THAT(why_not(scene, other), testing::HasSubstr("damaged")) << at;
  }
}

}  // namespace
}  // namespace calot
