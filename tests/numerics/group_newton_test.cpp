#include <gtest/gtest.h>

#include "spring_net.h"

namespace calot {
namespace {

using test::Net;

/// Nets as the bodies of one problem, each in a measure of stiffness and of length of its own, joined by springs.
class Group : public ConstrainedEnergy {
 public:
  struct Member {
    Net net;
    double stiffness = 1;  ///< factor of its energy
    double length = 1;
  };
  struct Join {
    int node, other;  ///< of the group
  };
  std::vector<Member> members;
  std::vector<Join> joins;  ///< springs of 1 N/m
  bool keeps_last_twice = false;

  Member& add(bool keeps_volume) { return members.emplace_back(Member{Net(keeps_volume)}); }
  int nodes() const { return Net::nodes * static_cast<int>(members.size()); }
  VecX rest() const {
    VecX x(3 * nodes());
    for (std::size_t p = 0; p < members.size(); ++p) own(x, p) = members[p].net.rest();
    return x;
  }
  static Eigen::VectorBlock<VecX> own(VecX& x, std::size_t p) {
    return x.segment(static_cast<Eigen::Index>(p) * 3 * Net::nodes, 3 * Net::nodes);
  }
  static VecX own(const VecX& x, std::size_t p) {
    return x.segment(static_cast<Eigen::Index>(p) * 3 * Net::nodes, 3 * Net::nodes);
  }
  NewtonWorkspace workspace() const {
    std::vector<std::vector<int>> cliques;
    for (int first = 0; first < nodes(); first += Net::nodes) {
      cliques.emplace_back();
      for (int i = 0; i < Net::nodes; ++i) cliques.back().push_back(first + i);
    }
    for (const Join& join : joins) cliques.push_back({join.node, join.other});
    return NewtonWorkspace(BlockMatrix(nodes(), cliques));
  }
  /// Joins three nodes of a member with the same of the next.
  void weld(int p) {
    for (int i = 0; i < 3; ++i) joins.push_back({Net::nodes * p + i, Net::nodes * (p + 1) + i});
  }

  std::vector<Part> parts() const override {
    std::vector<Part> out;
    for (const Member& member : members) {
      const int first = Net::nodes * static_cast<int>(out.size()), last = first + Net::nodes;
      out.push_back({{first, last}, {last, last}, member.length});
    }
    return out;
  }
  int constraints() const override { return static_cast<int>(keepers().size()); }
  double value(const VecX& x) const override {
    double sum = 0;
    for (std::size_t p = 0; p < members.size(); ++p)
      sum += members[p].stiffness * members[p].net.value(own(x, p));
    for (const Join& join : joins) sum += 0.5 * gap(x, join).squaredNorm();
    return sum;
  }
  void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const override {
    gradient.resize(x.size());
    largest_internal.resize(static_cast<Eigen::Index>(members.size()));
    for (std::size_t p = 0; p < members.size(); ++p) {
      VecX g;
      double& internal = largest_internal[static_cast<Eigen::Index>(p)];
      members[p].net.gradient(own(x, p), g, internal);
      internal *= members[p].stiffness;
      own(gradient, p) = members[p].stiffness * g;
    }
    for (const Join& join : joins) {
      gradient.segment<3>(3 * join.node) += gap(x, join);
      gradient.segment<3>(3 * join.other) -= gap(x, join);
    }
  }
  void hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const override {
    matrix.set_zero();
    const std::vector<std::size_t> kept = keepers();
    for (std::size_t p = 0; p < members.size(); ++p) {
      const Member& member = members[p];
      double multiplier = 0;
      for (std::size_t k = 0; k < kept.size(); ++k)
        if (kept[k] == p) multiplier += multipliers[static_cast<Eigen::Index>(k)];
      BlockMatrix alone = member.net.workspace().matrix;
      member.net.hessian(own(x, p), multiplier / member.stiffness, alone);
      const Eigen::MatrixXd blocks = member.stiffness * test::dense(alone);
      const int first = Net::nodes * static_cast<int>(p);
      for (int j = 0; j < Net::nodes; ++j)
        for (int i = j; i < Net::nodes; ++i)
          matrix.add(first + i, first + j, blocks.block<3, 3>(3 * i, 3 * j));
    }
    for (const Join& join : joins) {
      matrix.add(join.node, join.node, Mat3::Identity());
      matrix.add(join.other, join.other, Mat3::Identity());
      matrix.add(std::max(join.node, join.other), std::min(join.node, join.other), -Mat3::Identity());
    }
  }
  void constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const override {
    values = constraint_values(x);
    gradients = Eigen::MatrixXd::Zero(x.size(), constraints());
    for (int k = 0; k < constraints(); ++k) {
      const std::size_t p = keepers()[static_cast<std::size_t>(k)];
      VecX g, column = VecX::Zero(x.size());
      members[p].net.constraint(own(x, p), g);
      own(column, p) = g;
      gradients.col(k) = column;
    }
  }
  VecX constraint_values(const VecX& x) const override {
    return of_keepers([&](std::size_t p) { return members[p].net.constraint_value(own(x, p)); });
  }
  VecX constraint_scales() const override {
    return of_keepers([&](std::size_t p) { return members[p].net.constraint_scale(); });
  }
  double safe_share(const VecX&, const VecX&) const override { return 1; }

 private:
  /// The member of each constraint.
  std::vector<std::size_t> keepers() const {
    std::vector<std::size_t> out;
    for (std::size_t p = 0; p < members.size(); ++p)
      if (members[p].net.constrained()) out.push_back(p);
    if (keeps_last_twice) out.push_back(out.back());
    return out;
  }
  template <class Of>
  VecX of_keepers(const Of& of) const {
    VecX out(constraints());
    for (Eigen::Index k = 0; k < out.size(); ++k) out[k] = of(keepers()[static_cast<std::size_t>(k)]);
    return out;
  }
  /// How far apart the nodes are beyond what they are at rest.
  Vec3 gap(const VecX& x, const Join& join) const {
    const VecX at_rest = rest();
    return x.segment<3>(3 * join.node) - at_rest.segment<3>(3 * join.node) -
           (x.segment<3>(3 * join.other) - at_rest.segment<3>(3 * join.other));
  }
};

struct SolvedGroup {
  NewtonResult result;
  VecX x, multipliers;
};

SolvedGroup solved(const Group& group, const NewtonSettings& settings = {}) {
  SolvedGroup out{{}, group.rest(), VecX::Zero(group.constraints())};
  NewtonWorkspace work = group.workspace();
  out.result = solve_equilibrium(group, settings, work, out.x, out.multipliers);
  return out;
}

/// Of stationarity of the Lagrangian.
VecX residual(const Group& group, const VecX& x, const VecX& multipliers) {
  VecX g, values, internal;
  Eigen::MatrixXd c;
  group.gradient(x, g, internal);
  group.constraint(x, values, c);
  return g - c * multipliers;
}

NewtonSettings settings_of(double tolerance) {
  NewtonSettings out;
  out.tolerance = tolerance;
  return out;
}

NewtonSettings no_iterations() {
  NewtonSettings out;
  out.max_iterations = 0;
  return out;
}

TEST(GroupNewton, GroupUsedHereHasExactDerivatives) {
  Group group;
  group.add(true).stiffness = 3;
  group.add(false);
  group.add(true);
  group.weld(0);
  group.weld(1);
  Rng rng(2);
  const VecX x = group.rest() + test::random_coordinates(rng, 3 * group.nodes(), 0.1);
  const VecX multipliers{{0.7, -0.4}};
  const auto lagrangian = [&](const VecX& y) {
    return group.value(y) - multipliers.dot(group.constraint_values(y));
  };
  EXPECT_LT(
      test::relative_error(residual(group, x, multipliers), test::difference_gradient(lagrangian, x, 1e-5)),
      1e-8);  // the step's square, and 1e-16 / 1e-5 of rounding
  BlockMatrix matrix = group.workspace().matrix;
  group.hessian(x, multipliers, matrix);
  const auto gradient = [&](const VecX& y) { return residual(group, y, multipliers); };
  EXPECT_LT(test::relative_error(test::dense(matrix), test::difference_hessian(gradient, x, 1e-5)), 1e-8);
}

TEST(GroupNewton, TwoBodiesSolvedTogetherAreWhatEachIsAlone) {
  Group group;
  group.add(true).net.volume *= 1.2;
  group.add(false).net.load *= -8;
  group.add(true).net.volume *= 0.8;
  const SolvedGroup together = solved(group, settings_of(1e-10));
  ASSERT_TRUE(together.result.converged()) << to_text(together.result.status);
  int liquid = 0;
  for (std::size_t p = 0; p < group.members.size(); ++p) {
    const Net& net = group.members[p].net;
    NewtonWorkspace work = net.workspace();
    VecX x = net.rest();
    double multiplier = 0;
    ASSERT_TRUE(solve_equilibrium(net, settings_of(1e-10), work, x, multiplier).converged());
    // Both are met to 1e-10 of a load of 0.4 N on springs of 1 N/m.
    EXPECT_LT((Group::own(together.x, p) - x).norm(), 1e-9) << p;
    EXPECT_GT((x - net.rest()).norm(), 1e-3) << p;
    if (!net.constrained()) continue;
    EXPECT_NEAR(together.multipliers[liquid++], multiplier, 1e-9) << p;
  }
  EXPECT_EQ(liquid, 2);
}

TEST(GroupNewton, EachLiquidKeepsItsOwnVolume) {
  Group group;
  group.add(true).net.volume *= 1.6;
  group.add(false).net.load *= 40;
  group.add(true).net.volume *= 0.6;
  group.weld(0);
  group.weld(1);
  const SolvedGroup out = solved(group);
  ASSERT_TRUE(out.result.converged()) << to_text(out.result.status);
  const VecX left = group.constraint_values(out.x);
  for (int k = 0; k < 2; ++k) EXPECT_LT(std::abs(left[k]), 1e-10 * group.constraint_scales()[k]);
  EXPECT_GT(out.multipliers[0], 0.01) << "it is blown up";
  EXPECT_LT(out.multipliers[1], -0.01) << "it is sucked in";
  // Of the smallest load: the tolerance is 1e-6 of each body's.
  EXPECT_LT(residual(group, out.x, out.multipliers).norm(), 1e-4 * group.members[0].net.load.norm());
}

TEST(GroupNewton, TheAnswerToALoadKeepsEveryVolumeToFirstOrder) {
  Group group;
  group.add(true).net.volume *= 1.2;
  group.add(true).net.volume *= 0.9;
  group.weld(0);
  const SolvedGroup at = solved(group, settings_of(1e-10));
  ASSERT_TRUE(at.result.converged());
  NewtonWorkspace work = group.workspace();
  Rng rng(4);
  const VecX load = test::random_coordinates(rng, 3 * group.nodes(), 1.0);
  const std::vector<double> edges(static_cast<std::size_t>(group.nodes()), 1e6);
  const FirstOrderAnswer answer = first_order_answer(group, work, at.x, at.multipliers, load, edges, false);
  ASSERT_TRUE(answer.result.converged());
  VecX values;
  Eigen::MatrixXd gradients;
  group.constraint(at.x, values, gradients);
  EXPECT_GT(answer.dx.norm(), 1e-2);
  EXPECT_LT((gradients.transpose() * answer.dx).norm(), 1e-13 * answer.dx.norm()) << "rounding";
  // It is the derivative of the equilibrium: the same balance, to first order.
  const VecX back = work.matrix.multiply(answer.dx) - gradients * answer.dmultipliers;
  EXPECT_LT((back - load).norm(), 1e-12 * load.norm()) << "rounding";
}

TEST(GroupNewton, AStiffBodyDoesNotHideASoftOne) {
  Group group;
  Group::Member& stiff = group.add(false);
  stiff.stiffness = 1e9;
  Group::Member& soft = group.add(false);
  soft.stiffness = 1e-3;
  // The stiff one is at rest under what it carries; the soft one's whole load is 1e-12 of that.
  Group lone;
  lone.members.push_back(group.members[0]);
  const VecX rested = solved(lone, settings_of(1e-9)).x;
  VecX x = group.rest(), none;
  Group::own(x, 0) = rested;
  NewtonWorkspace work = group.workspace();
  const NewtonResult before = solve_equilibrium(group, no_iterations(), work, x, none);
  EXPECT_EQ(before.status, NewtonStatus::iteration_limit);
  EXPECT_EQ(before.part, 1);
  EXPECT_GT(before.residual, 0.1);
  const NewtonResult after = solve_equilibrium(group, {}, work, x, none);
  ASSERT_TRUE(after.converged()) << to_text(after.status);
  VecX g;
  double internal = 0;
  group.members[1].net.gradient(Group::own(x, 1), g, internal);
  EXPECT_LE(largest_node(g), 1e-6 * internal) << "the tolerance, of its own load";
}

TEST(GroupNewton, ALargeBodyDoesNotHideASmallOnesIncrements) {
  Group group;
  group.add(false).length = 1000;
  group.add(false).net.load *= 0.01;
  NewtonSettings one;
  one.max_iterations = 1;
  const SolvedGroup out = solved(group, one);
  const VecX moved = out.x - group.rest();
  const double large = Group::own(moved, 0).lpNorm<Eigen::Infinity>(),
               small = Group::own(moved, 1).lpNorm<Eigen::Infinity>();
  ASSERT_GT(large, 10 * small);
  EXPECT_NEAR(out.result.increment, small, 1e-15) << "rounding of places of 1 m";
}

TEST(GroupNewton, TheBodyWhoseVolumeIsOffIsNamed) {
  for (int off : {0, 2}) {
    Group group;
    for (int p = 0; p < 3; ++p) group.add(p != 1);
    group.members[static_cast<std::size_t>(off)].net.volume *= 1.5;
    const NewtonResult result = solved(group, no_iterations()).result;
    EXPECT_EQ(result.part, off);
    EXPECT_NEAR(result.constraint_error, 0.5, 1e-12) << "rounding";
  }
}

TEST(GroupNewton, ABodyWhoseForcesAreNotFiniteIsNamed) {
  for (int bad : {0, 1, 2}) {
    Group group;
    for (int p = 0; p < 3; ++p) group.add(false);
    group.members[static_cast<std::size_t>(bad)].net.poison = std::nan("");
    const NewtonResult result = solved(group).result;
    EXPECT_EQ(result.status, NewtonStatus::not_finite);
    EXPECT_EQ(result.part, bad);
  }
}

TEST(GroupNewton, AFreeBodyAmongHeldOnesIsNamed) {
  for (int free : {0, 1, 2}) {
    for (bool constrained : {false, true}) {
      Group group;
      for (int p = 0; p < 3; ++p) group.add(constrained);
      group.members[static_cast<std::size_t>(free)].net.ground = 0;
      const NewtonResult result = solved(group).result;
      EXPECT_EQ(result.status, NewtonStatus::mechanism);
      EXPECT_EQ(result.part, free);
    }
  }
}

TEST(GroupNewton, ABodyThatAHeldOneHoldsIsNoMechanism) {
  Group group;
  group.add(false);
  group.add(false).net.ground = 0;
  group.weld(0);
  EXPECT_TRUE(solved(group).result.converged());
}

TEST(GroupNewton, BodiesThatHoldEachOtherButThatNothingHoldsAreAMechanism) {
  Group group;
  group.add(false);
  for (int p = 0; p < 2; ++p) group.add(false).net.ground = 0;
  group.weld(1);
  const NewtonResult result = solved(group).result;
  EXPECT_EQ(result.status, NewtonStatus::mechanism);
  EXPECT_GE(result.part, 1);
}

TEST(GroupNewton, ABodyThatTurnsAboutOneNodeOfAHeldOneIsAMechanism) {
  Group group;
  group.add(false);
  group.add(false).net.ground = 0;
  for (Group::Member& member : group.members) member.net.load.setZero();
  group.members[0].net.load[0] = 1e-3;  // something to solve for
  group.joins = {{0, Net::nodes}};
  const NewtonResult result = solved(group).result;
  EXPECT_EQ(result.status, NewtonStatus::mechanism);
  EXPECT_EQ(result.part, 1);
}

TEST(GroupNewton, ASoftlyHeldBodyBesideAStiffOneIsNoMechanism) {
  Group group;
  group.add(false).stiffness = 1e6;
  group.add(false).stiffness = 1e-6;
  EXPECT_TRUE(solved(group).result.converged());
}

TEST(GroupNewton, AnUnstableBodyIsShiftedByItsOwnStiffness) {
  Group group;
  group.add(false).stiffness = 1e6;
  group.add(false);
  group.members[0].net.load.setZero();
  Net& net = group.members[1].net;
  net.load.setZero();
  net.load[0] = 1e-3;
  VecX squeezed = 0.3 * net.rest(), x = group.rest(), none;
  Group::own(x, 1) = squeezed;
  NewtonWorkspace work = net.workspace(), of_group = group.workspace();
  double multiplier = 0;
  const NewtonResult alone = solve_equilibrium(net, {}, work, squeezed, multiplier);
  const NewtonResult together = solve_equilibrium(group, {}, of_group, x, none);
  ASSERT_TRUE(alone.converged());
  ASSERT_TRUE(together.converged()) << to_text(together.status);
  EXPECT_GT(alone.shifts, 0);
  EXPECT_EQ(together.shifts, alone.shifts);
  EXPECT_EQ(together.iterations, alone.iterations);
}

TEST(GroupNewton, DependentConstraintsAreRefused) {
  Group group;
  group.add(true);
  group.add(true).net.volume *= 1.1;
  group.keeps_last_twice = true;
  const SolvedGroup out = solved(group);
  EXPECT_EQ(out.result.status, NewtonStatus::dependent_constraints);
  EXPECT_EQ(out.result.part, 1);
  EXPECT_EQ(out.x, group.rest());
  NewtonWorkspace work = group.workspace();
  const FirstOrderAnswer answer =
      first_order_answer(group, work, out.x, out.multipliers, VecX::Ones(out.x.size()), {}, true);
  EXPECT_EQ(answer.result.status, NewtonStatus::dependent_constraints);
  EXPECT_FALSE(work.factored) << "nothing to go on with";
}

}  // namespace
}  // namespace calot
