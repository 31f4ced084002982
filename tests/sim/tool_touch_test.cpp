// A skin and an instrument that both give way.

#include "sim/tool_touch.h"

#include "base/units.h"
#include "field_rig.h"
#include "sim/rod_body.h"
#include "support/bodies.h"
#include "support/derivatives.h"
#include "support/random.h"
#include "tool_rig.h"

namespace calot {
namespace {

/// A body and one tool that touches it, as a group: the body's nodes first.
struct TouchedBody {
  const Body& body;
  Tool tool;
  ToolHolds holds;
  BodyState body_state, tool_state;
  ContactLoads none;
  ContactSearch body_search, tool_search;
  std::shared_ptr<const ToolTouch> touch;

  TouchedBody(const Body& touched, const BodyState& state, const Tool& touching)
      : body(touched), tool(touching), body_state(state), tool_state(ToolBody::at(touching.pose)) {
    body_search.own.active = tool_search.own.active = false;
    touch = std::make_shared<const ToolTouch>(std::array{0, 1}, tool, holds);
    touch->begin(std::vector<GroupPlace>{{&body, 0}, {nullptr, body.nodes()}});
  }
  TouchedBody(const TouchedBody&) = delete;
  TouchedBody& operator=(const TouchedBody&) = delete;

  VecX x() const {
    VecX out(body_state.x.size() + 6);
    out << body_state.x, tool_state.x;
    return out;
  }
  VecX gradient(const VecX& at) const {
    VecX out = VecX::Zero(at.size());
    touch->add_gradient(at, out);
    return out;
  }
  Vec3 force() const {
    Vec3 sum = Vec3::Zero();
    for (const ForceOnTool& one : touch->forces(x())) sum += one.force;
    return sum;
  }
  NewtonResult command(const InstrumentPose& pose) {
    const ToolBody held(tool, pose, hand_of(tool));
    const std::vector<Member> members{{body, none, body_search, body_state},
                                      {held, none, tool_search, tool_state}};
    const std::vector<JoinPointer> joins{touch};
    NewtonWorkspace work{BlockMatrix(0, {})};
    GroupPatterns patterns;
    return settle(members, joins, patterns, {}, work);
  }
};

/// A ball, and nearly closed jaws that have come down on it until their tip would be `depth` (m) in it.
Field pressed_ball(double depth) {
  Field field = test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ());
  const std::vector<Vec3> skin = field.organs[0].body->skin_positions(field.organs[0].state.x);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : skin) middle += p / static_cast<double>(skin.size());
  const Vec3 out = Vec3(0.3, 0.2, 1).normalized(), top = middle + 20e-3 * out;
  test::add_grasper(field, middle + 150e-3 * out);
  for (double height : {10e-3, -depth}) EXPECT_EQ(test::move_tip(field, top + height * out, 0.2, 4, 0.4), "");
  return field;
}

TEST(ToolTouch, ItsForcesAndStiffnessAreTheSlopesOfItsEnergyByTheSkinAndByThePose) {
  const Field field = pressed_ball(2e-3);
  const Organ& organ = field.organs[0];
  TouchedBody rig(*organ.body, organ.state, field.tools[0]);
  Rng rng(23);
  // Skin points near the tip are held, and contact points rub, sticking and sliding.
  const PosedPart jaw(rig.tool, rig.tool.pose, 1);
  const std::vector<ForceOnTool> pressing = rig.touch->forces(rig.x());
  ASSERT_GT(pressing.size(), 20u);
  const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
  int nearest = 0;
  for (int i = 0; i < static_cast<int>(skin.size()); ++i)
    if ((skin[i] - pressing[0].at).norm() < (skin[nearest] - pressing[0].at).norm()) nearest = i;
  rig.holds.pads.push_back(
      {1, nearest, jaw.frame().inverse() * skin[nearest] + test::random_vector(rng, 0.5e-3), 4e4});
  const Triangle& corner = organ.body->skin().triangles[7];
  rig.holds.pads.push_back({2, corner[0], test::random_vector(rng, 5e-3), 4e2});
  ContactPlaces places(organ.body->skin(), organ.state.x);
  for (double limit : {0.02, 20.0}) {
    const int point = 7 * contacts_each + (limit > 1 ? 3 : 17);
    const Vec3 anchor = jaw.frame().inverse() * (places.at(point) + test::random_vector(rng, 0.3e-3));
    rig.holds.rubs.push_back({1, point, {anchor, test::random_vector(rng, 1.0).normalized(), limit, 2e3}});
  }

  const VecX x = rig.x() + test::random_coordinates(rng, static_cast<int>(rig.x().size()), 2e-6);
  const auto value = [&](const VecX& at) { return rig.touch->value(at); };
  const auto slope = [&](const VecX& at) { return rig.gradient(at); };
  const VecX gradient = rig.gradient(x);
  EXPECT_GT(gradient.head(x.size() - 6).norm(), 0.01);
  EXPECT_GT(gradient.tail<6>().head<5>().cwiseAbs().minCoeff(), 1e-3);  // all motions of the tool are felt
  EXPECT_LT(test::relative_error(gradient, test::difference_gradient(value, x, 1e-8)), 1e-5);

  std::vector<std::vector<int>> all(1);
  for (int node = 0; node < organ.body->nodes() + tool_nodes; ++node) all[0].push_back(node);
  BlockMatrix matrix(organ.body->nodes() + tool_nodes, all);
  rig.touch->add_hessian(x, matrix);
  EXPECT_LT(test::relative_error(test::dense(matrix), test::difference_hessian(slope, x, 1e-9)), 1e-4);

  // The couplings that it announces are all that it needs.
  std::vector<std::vector<int>> cliques;
  rig.touch->add_cliques(x, true, cliques);
  const ToolBody held(rig.tool, rig.tool.pose, hand_of(rig.tool));
  BlockMatrix sparse(std::vector<BlockMatrix>{organ.body->pattern(), held.pattern()}, cliques);
  sparse.set_zero();
  rig.touch->add_hessian(x, sparse);
  EXPECT_FALSE(rig.touch->lacking());
  EXPECT_LT((test::dense(sparse) - test::dense(matrix)).norm(), 1e-12 * test::dense(matrix).norm());
}

TEST(ToolTouch, TheSkinFeelsWhatTheToolFeels) {
  const Field field = pressed_ball(2e-3);
  const TouchedBody rig(*field.organs[0].body, field.organs[0].state, field.tools[0]);
  const VecX gradient = rig.gradient(rig.x());
  const Vec3 on_tool = rig.force();
  ASSERT_GT(on_tool.norm(), 1e-3);
  EXPECT_LT((test::net_force(gradient.head(gradient.size() - 6)) - on_tool).norm(), 1e-10);
  EXPECT_NEAR(gradient[gradient.size() - 4],
              -on_tool.dot(PosedPart(rig.tool, rig.tool.pose, 0).frame().linear().col(2)), 1e-10);
  // As the field says of the same state.
  EXPECT_LT((on_tool - test::tool_force(field)).norm(), 1e-9);
}

TEST(ToolTouch, AHeldToolPressesAsOneThatFollowsItsCommandExactly) {
  const Field field = pressed_ball(4e-3);
  TouchedBody rig(*field.organs[0].body, field.organs[0].state, field.tools[0]);
  const double exact = rig.force().norm();
  const NewtonResult result = rig.command(field.tools[0].pose);
  ASSERT_TRUE(result.converged()) << to_text(result.status) << result.residual;
  const Hand::Effort effort = Hand(rig.tool, rig.tool.pose, hand_of(rig.tool)).effort(rig.tool_state.x);
  ASSERT_GT(exact, 5e-3);
  EXPECT_LT(rig.force().norm(), exact);
  EXPECT_NEAR(rig.force().norm(), exact, 1e-3 * exact);
  EXPECT_NEAR(effort.tip, rig.force().norm(), 0.05 * exact);  // it presses near the tip
}

TEST(ToolTouch, NoSafeStepTakesAToolThroughASkin) {
  const Field field = pressed_ball(-2e-3);
  const TouchedBody rig(*field.organs[0].body, field.organs[0].state, field.tools[0]);
  InstrumentPose deep = rig.tool.pose;
  deep.insertion += 10e-3;
  deep.yaw += 0.02;
  deep.roll += 0.5;
  VecX step = VecX::Zero(rig.x().size());
  step.tail<6>() = tool_coordinates(deep) - tool_coordinates(rig.tool.pose);
  for (int node = 0; node < rig.body.nodes(); ++node) step[3 * node + 2] = 2e-3;  // the ball comes towards it
  const double share = rig.touch->safe_share(rig.x(), step, 1.0);
  EXPECT_GT(share, 0.02);
  EXPECT_LT(share, 0.6);
  const auto gap = [&](double part) {  // to the cores
    const VecX at = rig.x() + part * step, of_skin = at.head(at.size() - 6);
    double least = 1;
    ContactPlaces places(rig.body.skin(), of_skin);
    for (const Shape& shape : instrument_shapes(rig.tool.trocar, pose_at(at.tail<6>()), rig.tool.geometry))
      for (int p = 0; p < contacts_each * static_cast<int>(rig.body.skin().triangles.size()); p += 7)
        least = std::min(least, signed_distance(core_of(contact_shape(shape)), places.at(p)));
    return least;
  };
  const double before = gap(0);
  for (double part : {0.25, 0.5, 0.75, 1.0}) EXPECT_GT(gap(part * share), 0.19 * before);
  EXPECT_LT(gap(1), 0);  // all of it would have been too far
  EXPECT_EQ(rig.touch->safe_share(rig.x(), -0.2 * step, 1.0), 1.0);
}

/// A thread on a firm bed, level, and open jaws that come from above, the thread across the middle of their pads.
struct ThreadInJaws {
  static constexpr double open = 40 * units::deg;
  RodBody rod;
  Tool jaws;
  std::optional<TouchedBody> rig;
  InstrumentPose command{.insertion = 0.11, .jaw = open};

  explicit ThreadInJaws(double pinch) : rod(RodBody::create(setup()).value()) {
    jaws.definition.pinch_force = pinch;
    jaws.pose = command;
    rig.emplace(rod, BodyState{.x = rod.rest()}, jaws);
  }
  static RodBody::Setup setup() {
    RodBody::Setup out;
    out.points = {{0, -0.02, -0.1}, {0, 0.02, -0.1}};
    out.wall = out.radius;  // solid
    out.shear_modulus = 1e6;
    out.held = {{0.5, 1.0, 1e8}};  // all of it
    return out;
  }
  /// Whether there is a balance.
  ::testing::AssertionResult go() {
    const NewtonResult result = rig->command(command);
    if (result.converged()) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << to_text(result.status) << " of part " << result.part << ": " << result.residual;
  }
  ::testing::AssertionResult close() {
    for (double jaw : {20 * units::deg, 10 * units::deg, 0.0}) {
      command.jaw = jaw;
      if (::testing::AssertionResult gone = go(); !gone) return gone << " at " << jaw;
    }
    return ::testing::AssertionSuccess();
  }
  double half_angle() const { return 0.5 * pose_at(rig->tool_state.x).jaw; }
  Hand::Effort effort() const { return Hand(jaws, command, hand_of(jaws)).effort(rig->tool_state.x); }
  /// N, of what presses on a part.
  Vec3 pressing_on(int part) const {
    Vec3 sum = Vec3::Zero();
    for (const ForceOnTool& one : rig->touch->forces(rig->x()))
      if (one.part == part && one.by == ForceOnTool::By::contact) sum += one.force;
    return sum;
  }
};

TEST(ToolTouch, JawsCloseUntilWhatTheyHoldCarriesTheirPinch) {
  for (double pinch : {0.5, 6.8}) {
    SCOPED_TRACE(pinch);
    ThreadInJaws held(pinch);
    ASSERT_EQ(held.rig->force(), Vec3::Zero());
    ASSERT_TRUE(held.close());
    EXPECT_NEAR(held.effort().pinch, pinch, 0.01 * pinch);
    EXPECT_GT(2 * held.half_angle(), 25 * units::deg);
    // At half a jaw from the hinge, where the pinch is meant, within what the thread is off there.
    EXPECT_NEAR(held.pressing_on(1).norm(), pinch, 0.05 * pinch);
    EXPECT_NEAR(held.pressing_on(2).norm(), held.pressing_on(1).norm(), 1e-3 * pinch);
    EXPECT_EQ(held.pressing_on(0), Vec3::Zero());
    // Without friction open pads push themselves off what they hold.
    EXPECT_NEAR(held.effort().tip, 2 * held.pressing_on(1).norm() * std::sin(held.half_angle()),
                0.02 * pinch);
  }
}

TEST(ToolTouch, PadsThatRubHoldAWedgeByTheirFrictionLessWhatItsSlopePushes) {
  constexpr double friction = 0.8;
  ThreadInJaws held(6.8);
  ASSERT_TRUE(held.close());
  const InstrumentPose pose = pose_at(held.rig->tool_state.x);
  double limits = 0;
  for (const ForceOnTool& one : held.rig->touch->forces(held.rig->x())) {
    const Pose back = PosedPart(held.jaws, pose, one.part).frame().inverse();
    const double limit = friction * one.force.norm();
    held.rig->holds.rubs.push_back(
        {one.part, one.point, StickSlip{one.at, one.force.normalized(), limit, 1e5}.carried(back)});
    limits += limit;
  }
  ASSERT_GT(limits, 10);
  // What pushed the tool out goes on at first, and holds it once it is drawn back.
  ASSERT_TRUE(held.go());
  held.command.insertion -= 3e-3;  // further than its bed gives way
  ASSERT_TRUE(held.go());
  const double half = held.half_angle(), pressed = held.pressing_on(1).norm();
  const double expected = limits * std::cos(half) - 2 * pressed * std::sin(half);  // 2 N (mu cos a - sin a)
  EXPECT_GT(expected, 5);
  EXPECT_NEAR(held.effort().tip, expected, 0.05 * expected);
}

TEST(ToolTouch, APadHoldsAlongItselfOnly) {
  ThreadInJaws held(6.8);
  TouchedBody& rig = *held.rig;
  const Pose jaw = PosedPart(held.jaws, held.jaws.pose, 1).frame();
  const Vec3 at = held.rod.skin_point(5, rig.body_state.x), off(0.3e-3, 0.1e-3, -0.2e-3);
  rig.holds.pads.push_back({1, 5, jaw.inverse() * at - off, 1e3});
  const Vec3 on_jaw = jaw.linear().transpose() * rig.force();
  EXPECT_LT((on_jaw - 1e3 * Vec3(0, off.y(), off.z())).norm(), 1e-12);
  EXPECT_NEAR(rig.touch->value(rig.x()), 0.5e3 * (off.y() * off.y() + off.z() * off.z()), 1e-15);
}

}  // namespace
}  // namespace calot
