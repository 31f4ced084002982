// Friction of bodies on each other: what it balances, what it holds, what it costs.

#include "motion/body_rubbing.h"

#include <gtest/gtest.h>

#include "body/rigid_body.h"
#include "field/field_state.h"
#include "field_rig.h"
#include "geometry/solid_surface.h"
#include "group/self_contact.h"
#include "group_rig.h"
#include "joins/skin_join.h"
#include "motion/rubbing.h"
#include "motion/settle_field.h"
#include "support/long_run.h"

namespace calot {
namespace body_rubbing_test {
namespace {

using test::GroupRig;

constexpr double thin = 2.5e-3, apart = 0.2e-3;  // m, of ducts; between skins

BodyPointer ball(double z) { return test::soft_ball(Vec3(0.3e-3, -0.4e-3, z)); }
BodyPointer duct_along_x(double z) {
  return test::straight_duct(Vec3(-20e-3, 0, z), Vec3(20e-3, 0, z), thin);
}
BodyPointer stone(double z) {
  return std::make_shared<const RigidBody>(
      RigidBody::create({"stone", rounded_box(Vec3::Zero(), 6e-3, Vec3(0, 0, z), 1.5e-3), 1000}).value());
}

/// Pairs of bodies, each with a gap of 0.2 mm, of every kind of frame: ball on ball, a duct on a ball, ducts that cross
/// and, by little, along each other, a stone on a duct.
std::vector<std::vector<BodyPointer>> near_bodies() {
  const auto duct = [](const Vec3& from, const Vec3& to) { return test::straight_duct(from, to, thin); };
  return {{ball(0), ball(40e-3 + apart)},
          {ball(0), duct_along_x(20e-3 + thin + apart)},
          {duct(Vec3(1e-3, -15e-3, 0), Vec3(-2e-3, 20e-3, 0)), duct_along_x(2 * thin + apart)},
          {duct(Vec3(-15e-3, -7e-3, 0), Vec3(20e-3, 8e-3, 0)), duct_along_x(2 * thin + apart)},
          {duct(Vec3(-15e-3, -0.2e-3, 0), Vec3(20e-3, 0.3e-3, 0)), duct_along_x(2 * thin + apart)},
          {duct_along_x(0), stone(thin + 6e-3 + apart)}};
}

/// Holds of all that presses at x, with anchors `off` (m) beside, as if the points had gone that far.
std::vector<SkinHold> holds_at(const SkinJoin& join, std::span<const GroupPlace> bodies, const VecX& x,
                               double off) {
  const BodyPlaces places(bodies, x);
  Rng rng(9);
  std::vector<SkinHold> out;
  for (const SkinPress& press : join.pressing(x)) {
    SkinHold held{press.pair, press.place, places.across(press.place), {}};
    const RubbingFrame frame = places.frame(held);
    held.hold.normal = frame.turn.transpose() * press.force.normalized();
    held.hold.limit = 0.3 * press.force.norm();
    held.hold.stiffness = stick_stiffness * press.area;
    held.hold.anchor = frame.at + test::random_vector(rng, off);
    out.push_back(held);
  }
  std::sort(out.begin(), out.end(), [](const SkinHold& a, const SkinHold& b) { return a.pair < b.pair; });
  return out;
}

TEST(BodyRubbing, SlopesAreRightAndForcesBalanceWithoutATorque) {
  for (const std::vector<BodyPointer>& bodies : near_bodies())
    for (const double off : {1e-7, 0.3e-3}) {  // m: sticks, slides
      GroupRig rig(bodies);
      const auto join = std::make_shared<SkinJoin>(*bodies[0], *bodies[1], std::array{0, 1});
      join->begin(rig.places());
      Rng rng(3);
      const VecX x = rig.x() + test::random_coordinates(rng, static_cast<int>(rig.x().size()), 1e-5);
      const std::vector<SkinHold> holds = holds_at(*join, rig.places(), x, off);
      ASSERT_GT(holds.size(), 2U);
      rig.joins = {std::make_shared<SkinRubbing>(holds)};
      BlockMatrix h = rig.matrix(x);
      const Join& rubbing = *rig.joins[0];
      const VecX g = test::gradient_of(rubbing, x);
      ASSERT_GT(g.norm(), 1e-5);
      EXPECT_LT(test::net_force(g).norm(), 1e-12 * g.lpNorm<1>());
      EXPECT_LT(test::net_torque(x, g, Vec3::Zero()).norm(), 1e-13 * g.lpNorm<1>());
      rubbing.add_hessian(x, h);
      EXPECT_FALSE(rubbing.lacking());
      for (int k = 0; k < 5; ++k) {
        const VecX d = test::random_coordinates(rng, static_cast<int>(x.size()), 1.0);
        constexpr double step = 1e-10;  // m: none goes from sticking to sliding on it
        const double slope = (rubbing.value(x + step * d) - rubbing.value(x - step * d)) / (2 * step);
        EXPECT_NEAR(slope, g.dot(d), 1e-4 * g.norm() * d.norm());
        const VecX bend =
            (test::gradient_of(rubbing, x + step * d) - test::gradient_of(rubbing, x - step * d)) /
            (2 * step);
        EXPECT_LT((bend - h.multiply(d)).norm(), 1e-4 * bend.norm()) << off;
      }
    }
}

TEST(BodyRubbing, DuctsAlongEachOtherRollAndRubOnlyAlongThemselves) {
  const std::vector<BodyPointer> bodies = near_bodies()[4];
  const GroupRig rig(bodies);
  const SkinJoin join(*bodies[0], *bodies[1], {0, 1});
  join.begin(rig.places());
  const VecX x = rig.x();
  const std::vector<GroupPlace> places = rig.places();
  const SkinRubbing rubbing(holds_at(join, places, x, 0));
  rubbing.begin(places);
  const auto force = [&](const Vec3& by) {
    VecX moved = x;
    for (Eigen::Index i = bodies[0]->rest().size(); i < x.size(); i += 3) moved.segment<3>(i) += by;
    return test::net_force(test::gradient_of(rubbing, moved).tail(bodies[1]->rest().size()));
  };
  const double along = force(Vec3(0.01e-3, 0, 0)).x();
  EXPECT_GT(along, 1e-3);
  EXPECT_LT(force(Vec3(0, 0.01e-3, 0)).norm(), 0.02 * along) << "the angle that they are askew by";
}

/// A block that stands still and a stone on its slope, which a weak spring holds back.
struct Slope {
  Field field;
  SolveStatistics statistics;
  Vec3 up, down;  ///< and along the slope
  double weight = 0;

  Slope(double tangent, double friction) {
    up = Vec3(tangent, 0, 1).normalized();
    down = -Vec3::UnitX();
    OrganDefinition block, lying;
    block.name = "block";
    block.shape = RigidShape{.size = Vec3(30e-3, 12e-3, 2e-3), .rounding = 2e-3, .centre = Vec3(0, 0, -3e-3)};
    lying.name = "stone";
    lying.shape = RigidShape{.size = Vec3(6e-3, 6e-3, 2e-3),
                             .rounding = 1.5e-3,
                             .centre = Vec3(0, 0, 2.5e-3 + 0.35e-3),
                             .density = 40000};
    for (const OrganDefinition& organ : {block, lying})
      field.add(make_organ(organ, {}, up, field.tolerance).value());
    field.group.joins.push_back(
        std::make_shared<SkinJoin>(*field.organs[0].body, *field.organs[1].body, std::array{0, 1}));
    field.group.friction = friction;
    test::add_grasper(field, Vec3(0, 0, 300e-3));  // far above: it only holds
    weight = -test::net_force(field.organs[1].body->kept_load()).dot(up);
    hold(0, 1e4), hold(1, 1e3);
  }
  void hold(int organ, double stiffness) {
    Organ& of = field.organs[static_cast<std::size_t>(organ)];
    of.grips.clear();
    // Each jaw presses away from itself alone, both from the start, so that together they tie in every direction.
    const Vec3 pressed(0.1e-3, 0, 0);
    for (const int jaw : {0, 1}) {
      const Pose frame = part_frame(field.tools[0], field.tools[0].pose, 1 + jaw);
      for (std::size_t row = 0; row < of.body->skin_rest().size(); row += 7)
        of.grips.push_back({ToolIndex(0), jaw, static_cast<int>(row),
                            frame.inverse() * of.body->skin_rest()[row] - pressed, 0});
    }
    for (GripPoint& grip : of.grips) grip.stiffness = stiffness / static_cast<double>(of.grips.size());
  }
  bool settle() {
    return settle_group(field, present_poses(field), present_places(field), 100, statistics).converged();
  }
  Vec3 stone_at() const {
    Vec3 sum = Vec3::Zero();
    const Organ& of = field.organs[1];
    for (const Vec3& p : of.body->skin_positions(of.state.x))
      sum += p / static_cast<double>(of.body->skin_rest().size());
    return sum;
  }
  /// N, of all springs on the stone.
  Vec3 held() const {
    const Organ& of = field.organs[1];
    const GripSprings springs = grip_springs(of, field.tools, present_poses(field));
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < springs.row.size(); ++i)
      sum -= springs.sample(i, of.body->skin_point(springs.row[i], of.state.x)).gradient;
    return sum;
  }
};

TEST(BodyRubbing, AStoneOnASlopeLiesBelowTheConeAndSlidesBeyond) {
  constexpr double friction = 0.3;
  for (const double tangent : {0.25, 0.6}) {
    Slope slope(tangent, friction);
    const Vec3 before = slope.stone_at();
    for (const double stiffness : {1000, 500, 250, 125, 60, 30, 15}) {  // N/m: it is let go
      slope.hold(1, stiffness);
      ASSERT_TRUE(slope.settle()) << tangent;
    }
    const Vec3 way = slope.stone_at() - before;
    const double cosine = 1 / std::hypot(1, tangent), pull = slope.weight * tangent * cosine,
                 most = friction * slope.weight * cosine;
    if (pull < most) {
      EXPECT_LT(way.norm(), 0.25e-3)
          << "it settles on the block and gives by what sticks; free, it would go 2 mm";
    } else {
      // Pressed down in front it lies on its slope by up to 0.2 mm over its length: that turns what presses.
      EXPECT_NEAR(slope.held().x(), pull - most, 0.025 * slope.weight);
      EXPECT_LT(way.x(), -1.5e-3);
    }
    // Left alone it does not creep.
    const VecX x = slope.field.organs[1].state.x;
    ASSERT_TRUE(slope.settle());
    EXPECT_LT((slope.field.organs[1].state.x - x).lpNorm<Eigen::Infinity>(), 1e-7);
  }
}

TEST(BodyRubbing, WhatIsRestoredGoesOnToTheSameBits) {
  Slope slope(0.25, 0.3);
  ASSERT_TRUE(slope.settle());
  const FieldState before = field_state(slope.field);
  ASSERT_FALSE(slope.field.group.rubbing.empty());
  std::array<VecX, 2> after;
  for (VecX& x : after) {
    slope.hold(1, 100);
    ASSERT_TRUE(slope.settle());
    x = slope.field.organs[1].state.x;
    restore(slope.field, before);
  }
  EXPECT_EQ(after[0], after[1]);
  EXPECT_NE(after[0], slope.field.organs[1].state.x);
}

/// A duct held at both ends over another, and a rod that presses it down and pushes it along itself and across.
struct Ducts {
  World world;
  test::Driver driver;
  std::vector<std::uint64_t> hashes;

  explicit Ducts(double friction) : world(made(friction)), driver(world) {
    const Vec3 middle = world.landmark("upper.middle");
    push(middle + Vec3(0, 0, 5e-3)), push(middle - Vec3(0, 0, 3e-3)), push(middle + Vec3(0, 3e-3, -3e-3));
  }
  void push(const Vec3& to) {
    EXPECT_TRUE(driver.go(to, 0, 2)) << driver.why();
    hashes.push_back(world.report().state_hash);
  }
  static World made(double friction) {
    const auto duct = [](const char* name, const Vec3& from, const Vec3& to) {
      OrganDefinition organ;
      organ.name = name;
      organ.shape = TubeShape{.points = {from, to}, .radius = 3e-3};
      organ.wall.thickness = 1e-3;
      organ.held = {{"start", "start", 6e-3, 1e6}, {"end", "end", 6e-3, 1e6}};
      return organ;
    };
    SceneDefinition scene = test::scene_with(InstrumentType::bipolar_electrode);
    scene.anatomy = {};
    scene.anatomy.friction = friction;
    scene.anatomy.organs = {duct("lower", {-80e-3, 70e-3, -107e-3}, {-80e-3, 110e-3, -107e-3}),
                            duct("upper", {-100e-3, 90e-3, -100e-3}, {-60e-3, 90e-3, -100e-3})};
    scene.laparoscope.look_at = "upper.middle";
    return World::create(scene).value();
  }
};

TEST(BodyRubbing, WhatDuctsHoldEachOtherByIsStateAndKnownToTheHash) {
  const Ducts smooth(0), again(0.3);
  Ducts rough(0.3);
  EXPECT_EQ(rough.hashes, again.hashes);
  EXPECT_EQ(rough.hashes[0], smooth.hashes[0]) << "they do not touch yet";
  EXPECT_NE(rough.hashes[2], smooth.hashes[2]);
  EXPECT_TRUE(smooth.world.field().group.rubbing.empty());
  World& world = rough.world;
  const FieldState kept = world.state();
  ASSERT_FALSE(kept.group.rubbing.empty());
  StepInput on{.instruments = {world.report().instruments[0].pose}};
  on.instruments[0].insertion += 1e-3;
  const Result<StepReport> first = world.step(on);
  ASSERT_TRUE(first);
  FieldState slid = kept;
  slid.group.rubbing.front().hold.anchor.x() += 1e-9;
  ASSERT_TRUE(world.restore(slid));
  EXPECT_NE(world.state_hash(), rough.hashes[2]);
  ASSERT_TRUE(world.restore(kept));
  EXPECT_EQ(world.state_hash(), rough.hashes[2]);
  const Result<StepReport> second = world.step(on);
  ASSERT_TRUE(second);
  EXPECT_EQ(first->state_hash, second->state_hash);
}

/// What the rod feels over its way and back, J, is lost: friction gives nothing.
TEST(BodyRubbing, ADragThereAndBackCostsWork) {
  const auto cycle = [](double friction) {
    Ducts ducts(friction);
    double work = 0;
    Vec3 at = ducts.world.report().instruments[0].tip, force = ducts.world.report().instruments[0].force;
    const Vec3 start = at;
    for (const double y : {0.75, 0.5, 0.25, 0.0, 0.25, 0.5, 0.75, 1.0}) {
      EXPECT_TRUE(ducts.driver.go(start + Vec3(0, (y - 1) * 6e-3, 0), 0, 1)) << ducts.driver.why();
      const InstrumentState& now = ducts.world.report().instruments[0];
      work += 0.5 * (force + now.force).dot(now.tip - at);
      at = now.tip, force = now.force;
    }
    return -work;
  };
  const double smooth = cycle(0), rough = cycle(0.3);
  EXPECT_GT(rough, 5 * std::abs(smooth));
}

}  // namespace
}  // namespace body_rubbing_test
}  // namespace calot
