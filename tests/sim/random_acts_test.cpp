// Whatever instruments do to a field of all kinds of organs: nothing is lost, and what cannot be followed says so.

#include "random_acts.h"

#include "support/long_run.h"
#include "triangle_rig.h"

namespace calot {
namespace {

/// The triangle with an instrument of each type about it. Its liver is a thick bar, or a lobe, of which a step takes longer.
SceneDefinition field_of_all_kinds(bool lobe, double rate = 50) {
  SceneDefinition scene = test::triangle_scene();
  scene.anatomy.organs[0].held = {{"bed", "bed", 14e-3, 3e5, true}, {"base", "neck", 6e-3, 3e5}};
  scene.anatomy.organs[0].liver_side = Vec3::UnitY();
  if (lobe) scene.anatomy.organs[1] = test::lobe_behind();
  for (OrganDefinition& organ : scene.anatomy.organs) {
    organ.wall.density = 1050;
    auto* tube = std::get_if<TubeShape>(&organ.shape);
    if (organ.name == "cystic_artery" && tube) tube->carries = Carries::blood;
  }
  scene.solver.motion = SolverMotion::dynamics;
  scene.solver.rate = rate;
  scene.ports = default_ports();
  scene.instruments.clear();
  int k = 0;
  for (const std::string& type : instrument_type_names()) {
    InstrumentDefinition tool = default_instrument(*instrument_type_called(type));
    tool.name = type;
    tool.hand_force = 0.5 * test::RandomActs::hardest;  // else hands stop before they have to give way
    tool.port = "port" + std::to_string(k);
    scene.ports.push_back({tool.port, test::beside_neck(-60 + 25 * k, -60 - 10 * (k % 3), 130)});
    scene.instruments.push_back(tool);
    ++k;
  }
  return scene;
}

/// A bag of bile that hangs on a bar by a plane alone, over a floor, two graspers and a hook: what a bed is, but coarse.
SceneDefinition bag_on_its_bed() {
  SceneDefinition scene = field_of_all_kinds(false, 25);
  AnatomyDefinition& anatomy = scene.anatomy;
  anatomy.organs.resize(2);
  anatomy.joints.clear();
  anatomy.organs[0].held = {{"base", "neck", 22e-3, 1e6, true}};  // until it is filled
  anatomy.tissue = {test::tissue_between("cystic_plate", "gallbladder", "liver", 12e-3, 60)};
  anatomy.tissue[0].looks = TissueLooks::areolar;
  anatomy.tissue[0].slack = 0.05;
  anatomy.tissue[0].stiffness = 20e3;
  anatomy.tissue[0].strength = 30e3;
  anatomy.tissue[0].divide_energy = 0.25e6;
  anatomy.ground = {{.name = "floor", .point = test::beside_neck(0, 0, -40), .friction = 0.3}};
  const auto stays = [](const InstrumentDefinition& tool) {
    return tool.type == InstrumentType::atraumatic_grasper || tool.type == InstrumentType::l_hook;
  };
  std::erase_if(scene.instruments, [&](const InstrumentDefinition& tool) { return !stays(tool); });
  InstrumentDefinition second = scene.instruments[0];
  second.name = "second_grasper";
  second.port = scene.ports.back().name;
  scene.instruments.push_back(second);
  return scene;
}

// With the acts on the whole field (tests/lua/bed_field_test.cpp) 50. An act takes four seconds: hundreds are left to
// scripts/test --long.
TEST(BedActs, AreFollowedWhateverHandsDoToTheBagAndItsPlane) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of steps");
  test::perform(bag_on_its_bed(), 7, test::cases(38, 1000), test::long_run() ? 0.1 : 0);
}

TEST(BedActs, ThatAreDoneAgainHaveTheSameBits) {
  CALOT_SLOW_WHEN_SANITIZED("a hundred steps");
  std::vector<std::uint64_t> hashes;
  for (int run = 0; run < 2; ++run) {
    test::RandomActs hands(World::create(bag_on_its_bed()).value(), 8);
    for (int k = 0; k < 2; ++k) hands.act();
    EXPECT_GT(hands.steps, 10);
    hashes.push_back(hands.hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

/// In each of three fields: two seconds an act were measured, and a suite has an hour.
constexpr int of_a_long_run = 300;

TEST(RandomActs, LoseNothingAndEndOrSayWhy) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of steps");
  test::perform(field_of_all_kinds(false), 1, test::cases(10, of_a_long_run));
}

TEST(RandomActs, LoseNothingBesideALobeAndInLongSteps) {
  if (!test::long_run() || test::sanitized) GTEST_SKIP() << "left to scripts/test --long";
  test::perform(field_of_all_kinds(true), 2, of_a_long_run);
  test::perform(field_of_all_kinds(false, 20), 3, of_a_long_run, 0.1);
}

}  // namespace
}  // namespace calot
