#include "field/field_state.h"

#include <gtest/gtest.h>

#include "milestone.h"
#include "sim/rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

SceneDefinition refined_scene(bool skip_still = true) {
  SceneDefinition scene = test::ball_scene();
  scene.solver.extension_levels = 1;
  scene.solver.skip_still = skip_still;
  scene.instruments[0].friction = 0.2;
  return scene;
}

/// Hashes of 50 steps that pull a held fold, hold still, and let go.
std::vector<std::uint64_t> fifty_steps(test::FundusPath& path) {
  std::vector<std::uint64_t> hashes;
  path.driver.watch = [&](const StepReport& report) { hashes.push_back(report.state_hash); };
  path.lift(20);
  path.driver.stay(10);
  path.release(20);
  return hashes;
}

TEST(FieldState, RestoredTheSameStepsHaveTheSameBits) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  test::FundusPath path(refined_scene());
  ASSERT_TRUE(path.grasp()) << path.driver.why();
  ASSERT_EQ(path.world.report().instruments[0].holds, "ball");
  ASSERT_GT(path.world.report().organs[0].details, 0);
  const test::Milestone grasped(path);
  const std::uint64_t at_start = path.world.state_hash();
  const std::vector<std::uint64_t> first = fifty_steps(path);
  ASSERT_EQ(first.size(), 50u) << path.driver.why();
  EXPECT_NE(path.world.state_hash(), at_start);
  grasped.go_back();
  EXPECT_EQ(path.world.state_hash(), at_start);
  EXPECT_EQ(fifty_steps(path), first);
}

/// Of a matrix that is twice as large.
Cholesky twice(const NewtonWorkspace::Kept& kept) {
  BlockMatrix matrix = kept.pattern.blank();
  matrix.assign(kept.factor.factorised());
  matrix.scale(2);
  Cholesky out = kept.factor;
  EXPECT_EQ(out.factorise(matrix), FactorStatus::ok);
  return out;
}

TEST(FieldState, EachPartOfItIsInTheStateHash) {
  test::FundusPath path(refined_scene());
  ASSERT_TRUE(path.grasp() && path.lift(2)) << path.driver.why();
  const FieldState state = path.world.state();
  ASSERT_FALSE(state.group.organs[0].grips.empty());
  ASSERT_FALSE(state.group.organs[0].extensions.empty());
  ASSERT_FALSE(state.group.organs[0].state.shares.empty());
  ASSERT_TRUE(state.group.factor.factored);
  ASSERT_GT(state.group.missed.dx.size(), 0);
  const std::uint64_t hash = path.world.state_hash();
  const auto differs = [&](const char* what, const std::function<void(FieldState&)>& change) {
    FieldState other = state;
    change(other);
    ASSERT_TRUE(path.world.restore(other));
    EXPECT_NE(path.world.state_hash(), hash) << what;
  };
  differs("steps", [](FieldState& s) { ++s.steps; });
  differs("place", [](FieldState& s) { s.group.organs[0].state.x[0] += 1e-15; });
  differs("pressure", [](FieldState& s) { s.group.organs[0].state.datum_pressure += 1e-9; });
  differs("volume", [](FieldState& s) { s.group.organs[0].state.volume *= 1.0000001; });
  differs("share", [](FieldState& s) { s.group.organs[0].state.shares[0].share *= 0.5; });
  differs("leaving", [](FieldState& s) { s.group.organs[0].state.shares[0].leaving ^= true; });
  differs("fading load", [](FieldState& s) {
    s.group.organs[0].state.fading_load = VecX::Constant(s.group.organs[0].state.x.size(), 1e-6);
  });
  differs("grip's point", [](FieldState& s) { ++s.group.organs[0].grips[0].skin_point; });
  differs("grip's place", [](FieldState& s) { s.group.organs[0].grips[0].local.x() += 1e-12; });
  differs("grip's stiffness", [](FieldState& s) { s.group.organs[0].grips[0].stiffness *= 0.2; });
  differs("extension", [](FieldState& s) { ++s.group.organs[0].extensions[0].centre; });
  differs("refused details", [](FieldState& s) { s.group.organs[0].refused_details = {{1, 2, 3}}; });
  differs("missed motion", [](FieldState& s) { s.group.missed.dx[0] += 1e-15; });
  differs("missed pressure", [](FieldState& s) { s.group.missed.dpressures[0] += 1e-9; });
  differs("missed motion's way", [](FieldState& s) { s.group.missed.travel *= 1.0000001; });
  differs("missed motion's iterations by its factor", [](FieldState& s) { ++s.group.missed.by_last_factor; });
  differs("friction", [](FieldState& s) {
    s.group.organs[0].friction.points.push_back({0, 0, StickSlip{.limit = 1e-3, .stiffness = 1}});
  });
  differs("factor", [](FieldState& s) { s.group.factor.factor = twice(s.group.factor); });
  differs("answers of the factor", [](FieldState& s) { s.group.factor.border.answers(0, 0) += 1e-12; });
  differs("no factor", [](FieldState& s) { s.group.factor.factored = false; });
  differs("shifted", [](FieldState& s) { s.group.factor.shifted ^= true; });
  differs("pose", [](FieldState& s) { s.tools[0].pose.roll += 1e-12; });
  differs("jaws", [](FieldState& s) { s.tools[0].jaw_stopped ^= true; });
  differs("pressing jaws", [](FieldState& s) { s.tools[0].pressing ^= true; });
  differs("roll", [](FieldState& s) { s.tools[0].roll_stiffness += 1e-3; });
  differs("slip", [](FieldState& s) { s.tools[0].slipping ^= true; });
  differs("action", [](FieldState& s) { s.tools[0].action = InstrumentAction::activate; });
  differs("lost", [](FieldState& s) { s.tools[0].lost ^= true; });
  differs("beside", [](FieldState& s) { s.tools[0].beside ^= true; });
  differs("touch", [](FieldState& s) { s.report.instruments[0].touching ^= true; });
  differs("what hands felt", [](FieldState& s) { s.report.instruments[0].at_tip.x() += 1e-12; });
  differs("command", [](FieldState& s) { s.tools[0].command.pitch += 1e-12; });
  differs("drag", [](FieldState& s) { s.tools[0].drag.x() += 1e-12; });
  differs("limit", [](FieldState& s) { s.tools[0].over_limit ^= true; });
  differs("on a clip", [](FieldState& s) { s.tools[0].on_clip ^= true; });
  differs("beside what is kept", [](FieldState& s) { s.tools[0].beside_kept ^= true; });
  ASSERT_TRUE(path.world.restore(state));
  EXPECT_EQ(path.world.state_hash(), hash);
}

TEST(FieldState, WhatIsListedInsideAPartOfItIsInTheStateHash) {
  World world = World::create(test::grasper_scene(80)).value();
  const FieldState state = world.state();
  std::vector<std::uint64_t> hashes{world.state_hash()};
  const auto differs = [&](const char* what, const std::function<void(FieldState&)>& change) {
    FieldState other = state;
    change(other);
    ASSERT_TRUE(world.restore(other));
    EXPECT_EQ(std::count(hashes.begin(), hashes.end(), world.state_hash()), 0) << what;
    hashes.push_back(world.state_hash());
  };
  const auto opened = [](FieldState& s, const char* cause) {
    s.group.organs[0].openings.push_back({.cause = cause});
  };
  differs("an opening", [&](FieldState& s) { opened(s, "left"); });
  differs("its cause", [&](FieldState& s) { opened(s, "right"); });
  const auto wet = [](FieldState& s, int first, int second) {
    s.spill.films = {{0, std::vector<WetPoint>(first)}, {0, std::vector<WetPoint>(second)}};
  };
  const auto burnt = [](FieldState& s, const Burn& burn) { s.group.organs[0].burns = {burn}; };
  differs("a burn", [&](FieldState& s) { burnt(s, {Vec3::Zero(), 1}); });
  differs("its place", [&](FieldState& s) { burnt(s, {Vec3(1e-9, 0, 0), 1}); });
  differs("its energy", [&](FieldState& s) { burnt(s, {Vec3::Zero(), 1.5}); });
  differs("what was said of it", [&](FieldState& s) { burnt(s, {Vec3::Zero(), 1, true}); });
  differs("films", [&](FieldState& s) { wet(s, 1, 2); });
  differs("films of which the first is longer", [&](FieldState& s) { wet(s, 2, 1); });
  differs("what was drained", [](FieldState& s) { s.spill.drained[0] = 1e-9; });
  differs("a couple of nodes that once met", [](FieldState& s) { s.group.patterns.joined = {{1, 2}}; });
}

TEST(FieldState, OfAnotherWorldIsRefused) {
  World world = World::create(test::grasper_scene(80)).value();
  const FieldState state = World::create(test::grasper_scene(80)).value().state();
  const std::uint64_t hash = world.state_hash();
  EXPECT_EQ(world.restore(state).failure().kind, FailureKind::internal);
  EXPECT_EQ(world.state_hash(), hash);
}

TEST(StillSteps, AreWhatTheyWouldBeIfTheyWereComputed) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  std::vector<std::uint64_t> hashes[2];
  int substeps[2] = {0, 0}, still[2] = {0, 0};
  for (int skip = 0; skip < 2; ++skip) {
    SceneDefinition scene = refined_scene(skip == 1);
    scene = test::with_strong_jaws(scene);
    scene.instruments[0].pad_friction = 0.075;  // slips as it is lifted: no more in the first step that stays
    test::FundusPath path(scene);
    ASSERT_TRUE(path.grasp(2) && path.lift(2)) << path.driver.why();
    ASSERT_TRUE(path.world.state().tools[0].slipping);
    path.driver.watch = [&](const StepReport& report) {
      hashes[skip].push_back(report.state_hash);
      substeps[skip] += report.statistics.substeps;
    };
    ASSERT_TRUE(path.driver.stay(12)) << path.driver.why();
    still[skip] = substeps[skip];
    ASSERT_TRUE(path.lower(2)) << path.driver.why();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_GE(still[0], 12);
  EXPECT_LE(still[1], still[0] - 8) << "a held fold comes to rest within a few steps";
}

}  // namespace
}  // namespace calot
