// How far a group's step is safe, beside what each of its bodies and joins says alone.

#include <gtest/gtest.h>

#include <algorithm>

#include "group/group_problem.h"
#include "group_rig.h"
#include "joins/skin_join.h"

namespace calot {
namespace {

using test::GroupRig;

constexpr double radius = 20e-3, gap = 1.5e-3;

/// Two balls with a gap between them, and a shape that only the second one meets. The first one is `flat` times as thick.
struct TwoBalls {
  GroupRig rig{{test::soft_ball(Vec3::Zero()), test::soft_ball(Vec3(2 * radius + gap, 0, 0))}};
  std::vector<Member> members;
  explicit TwoBalls(double flat) {
    VecX& x = rig.bodies[0].state.x;
    for (Eigen::Index i = 0; i < x.size(); i += 3) x[i] *= flat;
    rig.bodies[1].loads.shapes = {Capsule{Vec3(2 * radius + gap, 0, radius + gap + 5e-3),
                                          Vec3(2 * radius + gap, 5e-3, radius + gap + 5e-3), 5e-3}};
    rig.bodies[0].search.own.active = true;
    rig.joins.push_back(
        std::make_shared<SkinJoin>(*rig.bodies[0].body, *rig.bodies[1].body, std::array{0, 1}));
    members = rig.members();
  }
  GroupProblem problem() { return GroupProblem(members, rig.joins, rig.patterns); }
};

/// The second ball goes that way, and the first one shrinks by a share of its size.
VecX step_of(const TwoBalls& balls, const Vec3& of_second, double squeeze) {
  VecX step = VecX::Zero(balls.rig.x().size());
  const Eigen::Index first = balls.rig.bodies[0].state.x.size();
  for (Eigen::Index i = 0; i < first; i += 3)
    step.segment<3>(i).x() = -squeeze * balls.rig.bodies[0].state.x[i];
  for (Eigen::Index i = first; i < step.size(); i += 3) step.segment<3>(i) = of_second;
  return step;
}

TEST(GroupSafeShare, IsTheLeastOfBodiesAndJoins) {
  int by_join = 0, by_shape = 0, by_itself = 0, whole = 0;
  struct Case {
    Vec3 way;
    double flat, squeeze;
  };
  for (const auto& [way, flat, squeeze] :
       {Case{Vec3(-2.4e-3, 0, 0), 1, 0.02}, Case{Vec3(-1e-3, 0, 0), 1, 0.02},
        Case{Vec3(0, 0, 2.4e-3), 1, 0.02}, Case{Vec3(0, 2e-3, 0), 1, 0.02}, Case{Vec3::Zero(), 0.05, 0.97}}) {
    TwoBalls balls(flat);
    const GroupProblem problem = balls.problem();
    const VecX x = balls.rig.x(), step = step_of(balls, way, squeeze);
    const double share = problem.safe_share(x, step), longest = problem.longest_share(x, step);
    EXPECT_LE(share, longest);
    double alone = longest;
    alone = std::min(alone, balls.rig.joins[0]->safe_share(x, step, longest));
    by_join += alone < longest ? 1 : 0;
    for (const Member& member : balls.members) {
      const Eigen::Index begin = &member == &balls.members[0] ? 0 : balls.members[0].state.x.size();
      const BodyProblem body(member.body, member.loads, member.search, member.state, false);
      const double own = body.safe_share(member.state.x, step.segment(begin, member.state.x.size()));
      (begin > 0 ? by_shape : by_itself) += own < longest ? 1 : 0;
      alone = std::min(alone, own);
    }
    whole += alone == 1 ? 1 : 0;
    // A way that is cut first and looked at then is cut where it would have been, to what the search resolves.
    EXPECT_NEAR(share, alone, 1e-3 * alone) << way.transpose();
    const double if_whole = problem.share_if_whole(x, step);
    EXPECT_EQ(if_whole == 1, share == 1);
    EXPECT_GE(if_whole, share);
  }
  EXPECT_GT(by_join, 0);
  EXPECT_GT(by_shape, 0);
  EXPECT_GT(by_itself, 0);
  EXPECT_GT(whole, 0);
}

}  // namespace
}  // namespace calot
