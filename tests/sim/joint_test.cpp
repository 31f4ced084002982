// What ties one body to another.

#include "joins/joint.h"

#include <gtest/gtest.h>

#include "group_rig.h"

namespace calot {
namespace joint_test {
namespace {

using test::GroupRig;

/// A duct that grows out of a ball's top, or out of another duct's side.
struct Grown {
  GroupRig rig;
  std::shared_ptr<Joint> joint;

  explicit Grown(bool on_ball, bool ball_first = false)
      : rig(on_ball ? ball_first ? std::vector{ball(), duct()} : std::vector{duct(), ball()}
                    : std::vector{duct(), stem()}) {
    const int one = ball_first ? 1 : 0;
    joint = std::make_shared<Joint>(
        joint_links(*rig.bodies[one].body, *rig.bodies[1 - one].body, {one, 1 - one}, top, radius, 800.0)
            .value());
    joint->begin(rig.places());
    rig.joins.push_back(joint);
  }
  static constexpr double radius = 2.5e-3;
  inline static const Vec3 top = Vec3(0, 0, 20e-3);
  static BodyPointer ball() { return test::soft_ball(Vec3::Zero()); }
  static BodyPointer duct() { return test::straight_duct(top, top + Vec3(0, 10e-3, 30e-3)); }
  static BodyPointer stem() { return test::straight_duct(top + Vec3(-30e-3, 0, 0), top + Vec3(20e-3, 0, 0)); }
};

TEST(Joint, NothingIsLoadedAtRestNorByAMotionOfTheWhole) {
  for (const bool on_ball : {true, false}) {
    const Grown grown(on_ball);
    ASSERT_GE(grown.joint->links().links.size(), 3U);
    const VecX rest = grown.rig.x();
    const double scale = grown.joint->links().stiffness * 1e-3;  // N: of links a millimetre long
    EXPECT_LT(test::gradient_of(*grown.joint, rest).lpNorm<Eigen::Infinity>(), 1e-10 * scale);
    Rng rng(1);
    for (int k = 0; k < 5; ++k) {
      const VecX moved = test::moved(test::random_motion(rng, 0.1), rest);
      // Rounding of places 0.1 m away.
      EXPECT_LT(test::gradient_of(*grown.joint, moved).lpNorm<Eigen::Infinity>(), 1e-9 * scale);
    }
  }
}

TEST(Joint, WeightsAreCalmAndKeepThePlace) {
  const Grown grown(true);
  for (const JointLinks::Link& link : grown.joint->links().links) {
    double sum = 0, size = 0;
    Vec3 at = Vec3::Zero();
    for (std::size_t i = 0; i < link.other.points.size(); ++i) {
      sum += link.other.weights[i];
      size += std::abs(link.other.weights[i]);
      at += link.other.weights[i] * grown.rig.bodies[1].body->skin_rest()[link.other.points[i]];
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_LT(size, 8.0);
    EXPECT_LT((at - grown.rig.bodies[0].body->skin_rest()[link.one.points[0]]).norm(), 1e-12);
  }
}

TEST(Joint, ForcesAndTorquesBalanceAndSlopesAreRight) {
  for (const bool on_ball : {true, false}) {
    for (const bool ball_first : {false, true}) {
      const Grown grown(on_ball, ball_first);
      Rng rng(2);
      VecX x = grown.rig.x();
      x += test::random_coordinates(rng, static_cast<int>(x.size()), 0.3e-3);
      const VecX g = test::gradient_of(*grown.joint, x);
      EXPECT_LT(test::net_force(g).norm(), 1e-12 * g.lpNorm<1>());
      EXPECT_LT(test::net_torque(x, g, Vec3::Zero()).norm(), 1e-13 * g.lpNorm<1>());
      test::expect_derivatives(grown.rig, *grown.joint, x, 1e-7, 1e-6);
    }
  }
}

TEST(Joint, APulledJointGivesByItsStiffness) {
  Grown grown(true);
  VecX x = grown.rig.x();
  const Vec3 away(0.1e-3, -0.2e-3, 0.3e-3);
  const Eigen::Index nodes = grown.rig.bodies[0].body->nodes();
  for (Eigen::Index i = 0; i < nodes; ++i) x.segment<3>(3 * i) += away;
  // On the ball, which pulls it back.
  EXPECT_LT((grown.joint->force(x) - 800.0 * away).norm(), 1e-9);
}

TEST(Joint, ATurnedEndIsTurnedBack) {
  Grown grown(true);
  VecX x = grown.rig.x();
  const Eigen::Index nodes = grown.rig.bodies[0].body->nodes();
  const Pose turn = Eigen::Translation3d(Grown::top) * Eigen::AngleAxisd(0.1, Vec3::UnitX()) *
                    Eigen::Translation3d(-Grown::top);
  x.head(3 * nodes) = test::moved(turn, x.head(3 * nodes));
  const VecX on_duct = -test::gradient_of(*grown.joint, x).head(3 * nodes);
  const double torque = test::net_torque(x.head(3 * nodes), on_duct, Grown::top).x();
  // Points at 0, 1 and 2 mm: k / 3 (0 + 1 + 4) mm^2 * 0.1, half of it if two points only were held.
  EXPECT_LT(torque, -0.7 * 800.0 / 3 * 5e-6 * 0.1);
}

TEST(Joint, ADuctHangsOnWhatItGrowsOutOf) {
  Grown grown(true);
  const int last = static_cast<int>(grown.rig.bodies[0].body->skin_rest().size()) - 1;
  const std::vector<Vec3>& skin = grown.rig.bodies[1].body->skin_rest();
  for (int row = 0; row < static_cast<int>(skin.size()); row += 7)
    if (skin[row].z() < -10e-3) grown.rig.hold(1, row, skin[row], 50);
  grown.rig.hold(0, last, grown.rig.bodies[0].body->skin_rest()[last] + Vec3(0, 0, 5e-3), 20);
  ASSERT_TRUE(grown.rig.settle().converged());
  const Vec3 pull = grown.joint->force(grown.rig.x());
  const Vec3 end = grown.rig.bodies[0].body->skin_point(last, grown.rig.bodies[0].state.x);
  const Vec3 held = 20 * (grown.rig.bodies[0].loads.grip.target[0] - end);
  EXPECT_GT(held.z(), 0.02);
  // What pulls at the far end comes through the joint, to the solver's tolerance.
  EXPECT_LT((pull - held).norm(), 1e-5 * held.norm());
}

TEST(Joint, DetailsTakePart) {
  GroupRig rig({test::straight_duct(Grown::top, Grown::top + Vec3(0, 0, 30e-3)),
                test::soft_ball(Vec3::Zero(), 20e-3, 61, 1)});
  const ShellBody& ball = *rig.bodies[1].body->as_shell();
  const Joint joint(joint_links(*rig.bodies[0].body, ball, {0, 1}, Grown::top, Grown::radius, 800.0).value());
  const auto distance = [&](int node) { return (ball.node_rest()[node] - Grown::top).norm(); };
  int nearest = ball.levels().nodes(0);
  for (int node = nearest; node < ball.levels().nodes(1); ++node)
    if (distance(node) < distance(nearest)) nearest = node;
  rig.bodies[1].body = std::make_shared<const ShellBody>(ball.with_details({nearest}).value());
  rig.bodies[1].state.x = rig.bodies[1].body->rest();
  joint.begin(rig.places());
  VecX x = rig.x();
  EXPECT_LT(test::gradient_of(joint, x).norm(), 1e-9);
  x.tail<3>() = Vec3(0, 0, 0.5e-3);
  EXPECT_GT(test::gradient_of(joint, x).head(3 * rig.bodies[0].body->nodes()).norm(), 1e-3);
}

TEST(Joint, RefusesWhatCannotBeJoined) {
  const BodyPointer duct = Grown::duct(), ball = Grown::ball();
  EXPECT_FALSE(joint_links(*duct, *ball, {0, 0}, Grown::top, 1e-3, 1.0));
  EXPECT_FALSE(joint_links(*duct, *ball, {0, 1}, Grown::top, 0.0, 1.0));
  EXPECT_FALSE(joint_links(*duct, *ball, {0, 1}, Grown::top, 1e-3, -1.0));
}

}  // namespace
}  // namespace joint_test
}  // namespace calot
