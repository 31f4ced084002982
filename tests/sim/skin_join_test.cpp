// Skins of two bodies against each other: energy, forces, what it keeps from passing, and what it remembers.

#include "joins/skin_join.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "body/rigid_body.h"
#include "field_rig.h"
#include "geometry/self_touch.h"
#include "geometry/solid_surface.h"
#include "group/self_contact.h"
#include "group_rig.h"
#include "joins/joint.h"
#include "support/long_run.h"

namespace calot {
namespace skin_join_test {
namespace {

using test::GroupRig;

constexpr double radius = 20e-3, thin = 2.5e-3;  // m, of balls and ducts

/// Pairs of drawn triangles of two bodies that touch each other; only where both may be.
std::size_t crossings(const GroupRig& rig) {
  std::vector<std::vector<Vec3>> drawn;
  std::vector<Eigen::AlignedBox3d> boxes(2);
  for (std::size_t k = 0; k < 2; ++k) {
    drawn.push_back(rig.bodies[k].body->drawn(rig.bodies[k].state.x).positions);
    for (const Vec3& p : drawn[k]) boxes[k].extend(p);
  }
  const Eigen::AlignedBox3d shared = boxes[0].intersection(boxes[1]);
  if (shared.isEmpty()) return 0;
  TriMesh both;
  for (std::size_t k = 0; k < 2; ++k) {
    const int first = static_cast<int>(both.points.size());
    both.points.insert(both.points.end(), drawn[k].begin(), drawn[k].end());
    for (const Triangle& t : rig.bodies[k].body->drawn_triangles()) {
      Eigen::AlignedBox3d box;
      for (int corner : t) box.extend(drawn[k][corner]);
      if (box.intersects(shared)) both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return touching_pairs(both, 0.0).size();
}

/// Two bodies with a gap of 0.2 mm, shaken.
struct Near {
  GroupRig rig;
  std::shared_ptr<SkinJoin> join;
  VecX x;

  explicit Near(std::vector<BodyPointer> bodies, double shake = 2e-5) : rig(bodies) {
    join = std::make_shared<SkinJoin>(*bodies[0], *bodies[1], std::array{0, 1});
    rig.joins.push_back(join);
    join->begin(rig.places());
    Rng rng(3);
    x = rig.x();
    x += test::random_coordinates(rng, static_cast<int>(x.size()), shake);
  }
};

constexpr double apart = 0.2e-3;
BodyPointer ball(double z) { return test::soft_ball(Vec3(0.3e-3, -0.4e-3, z)); }
BodyPointer duct_along_x(double z) {
  return test::straight_duct(Vec3(-20e-3, 0, z), Vec3(20e-3, 0, z), thin);
}
BodyPointer duct_along_y(double z) {
  return test::straight_duct(Vec3(1e-3, -15e-3, z), Vec3(-2e-3, 20e-3, z), thin);
}

BodyPointer stone(double z) {
  return std::make_shared<const RigidBody>(
      RigidBody::create({"stone", rounded_box(Vec3::Zero(), 6e-3, Vec3(0, 0, z), 1.5e-3), 1000}).value());
}

/// A box of 10 mm without any rounding, its points 2.5 mm apart.
BodyPointer sharp_box(const Pose& pose) {
  TriMesh surface = rounded_box(Vec3::Constant(10e-3), 0, Vec3::Zero(), 2.5e-3);
  for (Vec3& p : surface.points) p = pose * p;
  return std::make_shared<const RigidBody>(RigidBody::create({"box", surface, 1000}).value());
}

/// Two boxes, an edge of one across one of the other, with a gap between them, x and y from points of either.
std::vector<BodyPointer> crossing_boxes(double gap, double x = 1.2e-3, double y = 1.3e-3) {
  const double up = std::sqrt(2.0) * 10e-3 + gap, quarter = 0.25 * std::numbers::pi;
  return {sharp_box(Pose(Eigen::AngleAxisd(quarter, Vec3::UnitX()))),
          sharp_box(Eigen::Translation3d(x, y, up) * Eigen::AngleAxisd(quarter, Vec3::UnitY()))};
}

/// Ball on ball, duct on ball, duct across duct, a stone on a duct.
std::vector<std::vector<BodyPointer>> near_bodies() {
  return {{ball(0), ball(2 * radius + apart)},
          {ball(0), duct_along_x(radius + thin + apart)},
          {duct_along_y(0), duct_along_x(2 * thin + apart)},
          {duct_along_x(0), stone(thin + 6e-3 + apart)}};
}

TEST(SkinJoin, SlopesAreRightAndForcesBalanceInEitherOrder) {
  for (std::vector<BodyPointer> bodies : near_bodies()) {
    double energy = 0;
    for (int order = 0; order < 2; ++order) {
      const Near near(bodies, 0);
      if (order == 0) energy = near.join->value(near.x);
      EXPECT_NEAR(near.join->value(near.x), energy, 1e-12 * energy);
      const Near shaken(bodies);
      const VecX g = test::gradient_of(*shaken.join, shaken.x);
      EXPECT_LT(test::net_force(g).norm(), 1e-12 * g.lpNorm<1>());
      EXPECT_LT(test::net_torque(shaken.x, g, Vec3::Zero()).norm(), 1e-13 * g.lpNorm<1>());
      // A step of a hundred-thousandth of the gaps, so that few parts change within it.
      test::expect_derivatives(shaken.rig, *shaken.join, shaken.x, 1e-9, 1e-4);
      // The first pushes the other up, or is pushed down by it.
      EXPECT_GT((order == 0 ? 1 : -1) * shaken.join->force(shaken.x).z(), 1e-3);
      std::swap(bodies[0], bodies[1]);
    }
  }
}

TEST(SkinJoin, WhatTheGapCurvesByIsMadeConvex) {
  const Near shaken(near_bodies()[2]);
  test::expect_convexity(shaken.rig, *shaken.join, shaken.x);
}

TEST(SkinJoin, EdgesThatCrossPressWithSlopesAndBalance) {
  for (const double gap : {0.02e-3, 0.06e-3}) {
    std::vector<BodyPointer> bodies = crossing_boxes(gap);
    for (int order = 0; order < 2; ++order) {
      const Near near(bodies);  // shaken by as much as the gap
      ASSERT_EQ(near.join->crossing(near.x).size(), 1U);
      EXPECT_TRUE(near.join->touching(near.x).empty());
      const VecX g = test::gradient_of(*near.join, near.x);
      EXPECT_LT(test::net_force(g).norm(), 1e-12 * g.lpNorm<1>());
      EXPECT_LT(test::net_torque(near.x, g, Vec3::Zero()).norm(), 1e-13 * g.lpNorm<1>());
      test::expect_derivatives(near.rig, *near.join, near.x, 1e-9, 1e-4);
      const Vec3 force = near.join->force(near.x), first = -test::net_force(g.head(g.size() / 2));
      EXPECT_LT((force + first).norm(), 1e-12 * force.norm());
      EXPECT_GT((order == 0 ? 1 : -1) * force.z(), 1e-3);
      std::swap(bodies[0], bodies[1]);
    }
  }
  const Near beyond(crossing_boxes(1.05 * self_edge_barrier.range), 0);
  EXPECT_EQ(beyond.join->value(beyond.x), 0);
}

/// Sum over what presses on points of the first body, less what presses on the other's: N.
Vec3 pressed(const SkinJoin& join, const VecX& x) {
  Vec3 sum = Vec3::Zero();
  for (const SkinPress& press : join.pressing(x)) sum += (press.pair.point.body == 0 ? 1 : -1) * press.force;
  return sum;
}

TEST(SkinJoin, WhatRubsIsPressedAsMuchAsTheBodies) {
  for (const std::vector<BodyPointer>& bodies :
       {near_bodies()[3], crossing_boxes(0.05e-3), crossing_boxes(0.05e-3, 0.2e-3, 0.3e-3)}) {
    const Near near(bodies);
    const std::vector<SkinPress> presses = near.join->pressing(near.x);
    ASSERT_FALSE(presses.empty());
    EXPECT_TRUE(std::is_sorted(presses.begin(), presses.end(), [](const SkinPress& a, const SkinPress& b) {
      return a.pair <= b.pair;  // each point once
    }));
    const Vec3 force = near.join->force(near.x);
    EXPECT_LT((pressed(*near.join, near.x) + force).norm(), 1e-12 * force.norm());
  }
}

/// By springs, every second body softly.
void hold_all(GroupRig& rig) {
  for (std::size_t k = 0; k < rig.bodies.size(); ++k) {
    const std::vector<Vec3>& skin = rig.bodies[k].body->skin_rest();
    for (int row = 0; row < static_cast<int>(skin.size()); ++row)
      rig.hold(static_cast<int>(k), row, skin[row], k % 2 == 0 ? 20 : 2);
  }
}
void push_down(GroupRig& rig, std::size_t body) {
  for (Vec3& target : rig.bodies[body].loads.grip.target) target.z() -= 0.5e-3;
}

TEST(SkinJoin, BoxesPushedEdgeOnEdgeDoNotPass) {
  GroupRig rig(crossing_boxes(0.5e-3));
  hold_all(rig);
  const auto join = std::make_shared<SkinJoin>(*rig.bodies[0].body, *rig.bodies[1].body, std::array{0, 1});
  rig.joins.push_back(join);
  for (int step = 0; step < 4; ++step) {
    push_down(rig, 1);
    ASSERT_TRUE(rig.settle().converged()) << step;
    EXPECT_EQ(crossings(rig), 0U) << step;
  }
  // 98 springs of 2 N/m, and those below, are pressed by 1.5 mm less the gap that is left.
  EXPECT_NEAR(join->force(rig.x()).z(), 98 * 1.5e-3 / (1 / 2.0 + 1 / 20.0), 0.01);
}

/// Places of two pairs of boxes, pushed onto each other, when so many threads look for what presses.
VecX pushed_boxes(int threads) {
  std::vector<BodyPointer> bodies = crossing_boxes(0.2e-3);
  for (const BodyPointer& body : crossing_boxes(0.1e-3, 0.2e-3, 0.3e-3)) bodies.push_back(body);
  GroupRig rig(bodies);
  hold_all(rig);
  Workers workers(threads);
  Assembly assembly(workers);
  rig.assembly = &assembly;
  for (const std::array<int, 2> pair : {std::array{0, 1}, {2, 3}})
    rig.joins.push_back(std::make_shared<SkinJoin>(*bodies[pair[0]], *bodies[pair[1]], pair));
  for (int step = 0; step < 2; ++step) {
    push_down(rig, 1);
    push_down(rig, 3);
    EXPECT_TRUE(rig.settle().converged()) << step;
  }
  for (const JoinPointer& join : rig.joins) EXPECT_FALSE(join->skins()->crossing(rig.x()).empty());
  return rig.x();
}

TEST(SkinJoin, EdgesPressToTheSameBitsByTwoThreads) { EXPECT_EQ(pushed_boxes(1), pushed_boxes(2)); }

TEST(SkinJoin, NoMotionTakesBoxesThroughEachOther) {
  Rng rng(5);
  int stopped = 0;
  for (int k = 0; k < 60; ++k) {
    const auto box = [&](double z) {
      const Eigen::AngleAxisd turn(rng.uniform(0, 3), test::random_vector(rng, 1.0).normalized());
      return sharp_box(Eigen::Translation3d(test::random_vector(rng, 6e-3) + Vec3(0, 0, z)) * turn);
    };
    Near near({box(0), box(30e-3)}, 0);
    VecX step = VecX::Zero(near.x.size());
    const Vec3 way(rng.uniform(-5e-3, 5e-3), rng.uniform(-5e-3, 5e-3), -45e-3);
    const Vec3 spin = test::random_vector(rng, 0.5);
    for (Eigen::Index i = near.x.size() / 2; i < near.x.size(); i += 3)
      step.segment<3>(i) = way + spin.cross(near.x.segment<3>(i));
    for (int part = 0; part < 3; ++part) {  // a short one after a long one, too
      const double share = near.join->safe_share(near.x, step, 1.0);
      for (int at = 1; at <= 10; ++at) {
        const VecX x = near.x + 0.1 * at * share * step;
        for (std::size_t b = 0; b < 2; ++b)
          near.rig.bodies[b].state.x = b == 0 ? x.head(x.size() / 2) : x.tail(x.size() / 2);
        ASSERT_EQ(crossings(near.rig), 0U) << k;
      }
      near.x += share * step;
      stopped += share < 1 ? 1 : 0;
    }
  }
  EXPECT_GT(stopped, 90);
}

TEST(SkinJoin, ReachesAsFarAsItsRange) {
  for (const double gap : {0.9, 1.1}) {
    const Near near({duct_along_y(0), duct_along_x(2 * thin + gap * self_barrier.range)}, 0);
    EXPECT_EQ(near.join->value(near.x) > 0, gap < 1) << gap;
  }
  const Near in_each_other({duct_along_y(0), duct_along_x(1.9 * thin)}, 0);
  EXPECT_TRUE(std::isinf(in_each_other.join->value(in_each_other.x)));
  EXPECT_LT(in_each_other.join->gap(in_each_other.x), 0);
}

TEST(SkinJoin, NothingPressesNearAJoint) {
  const Vec3 top(0, 0, radius);
  const BodyPointer below = test::soft_ball(Vec3::Zero()),
                    duct = test::straight_duct(top, top + Vec3(0, 5e-3, 30e-3), thin);
  GroupRig rig({below, duct});
  const VecX x = rig.x();
  const SkinJoin all(*below, *duct, {0, 1});
  all.begin(rig.places());
  EXPECT_TRUE(std::isinf(all.value(x)));
  const std::vector<JoinedPlace> joined{{top, 2 * thin}};
  const SkinJoin rest(*below, *duct, {0, 1}, joined);
  rest.begin(rig.places());
  EXPECT_EQ(rest.value(x), 0);
  EXPECT_GT(rest.gap(x), self_barrier.range);
}

constexpr std::array solid{false, false}, hollow{true, true};

std::optional<SkinOverlap> overlap_of(const std::vector<BodyPointer>& bodies,
                                      const std::array<bool, 2>& may_hold = solid,
                                      std::span<const JoinedPlace> joined = {}) {
  const GroupRig rig(bodies);
  const SkinJoin join(*bodies[0], *bodies[1], {0, 1}, joined);
  join.begin(rig.places());
  return join.overlap(rig.x(), may_hold);
}

TEST(SkinJoin, BodiesThatAreInEachOtherAreFoundWithDepthAndPlace) {
  const auto box = [](double z) { return sharp_box(Pose(Eigen::Translation3d(1e-3, 2e-3, z))); };
  struct Case {
    std::vector<BodyPointer> bodies;
    double depth, within;  // m
    Vec3 place;            // m, to 3 mm
  };
  const Vec3 top(0, 0, 20e-3);
  for (const Case& one :
       {Case{{ball(0), ball(2 * radius - 3e-3)}, 3e-3, 1e-3, top},  // drawn they are a little smaller
        {{ball(0), duct_along_x(radius + thin - 2e-3)}, 2e-3, 1e-3, top},
        {{duct_along_y(0), duct_along_x(2 * thin - 1e-3)}, 1e-3, 0.3e-3, Vec3(0, 0, thin)},
        {{ball(0), box(radius + 4e-3)}, 1e-3, 0.5e-3, top},
        {{duct_along_x(0), box(0)},
         3e-3 + thin,
         0.1e-3,
         Vec3(1e-3, 0, 0)},                               // through it, 2 mm off its middle
        {{box(0), ball(0)}, 16e-3, 3e-3, Vec3(0, 0, 0)},  // all inside
        {crossing_boxes(-1e-3), std::sqrt(0.5) * 1e-3, 1e-6, Vec3(1.2e-3, 0, 7e-3)}}) {  // no point is inside
    std::vector<BodyPointer> bodies = one.bodies;
    for (int order = 0; order < 2; ++order) {
      const std::optional<SkinOverlap> found = overlap_of(bodies);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->depth, one.depth, one.within);
      EXPECT_LT((found->place - one.place).norm(), 8e-3);
      std::swap(bodies[0], bodies[1]);
    }
  }
}

TEST(SkinJoin, BodiesBesideEachOtherInAHollowOneOrJoinedThereAreNotInEachOther) {
  for (const std::vector<BodyPointer>& bodies : near_bodies()) EXPECT_FALSE(overlap_of(bodies));
  EXPECT_FALSE(overlap_of(crossing_boxes(0.02e-3)));
  const std::vector<BodyPointer> inside{ball(0), sharp_box(Pose::Identity())},
      poking{ball(0), sharp_box(Pose(Eigen::Translation3d(0, 0, radius - 4e-3)))};
  EXPECT_FALSE(overlap_of(inside, hollow));
  EXPECT_TRUE(overlap_of(inside, solid));
  EXPECT_TRUE(overlap_of(poking, hollow)) << "it goes through the wall";
  EXPECT_LT(overlap_of(poking, hollow)->depth, 2.5e-3) << "by its corners";
  const Vec3 top(0, 0, radius);
  const std::vector<BodyPointer> grown{ball(0), test::straight_duct(top, top + Vec3(0, 5e-3, 30e-3), thin)};
  EXPECT_TRUE(overlap_of(grown));
  EXPECT_FALSE(overlap_of(grown, solid, std::vector<JoinedPlace>{{top, 3 * thin}}));
}

/// Two balls, held by springs on their far caps.
GroupRig held_balls(double apart_by) {
  GroupRig rig({test::soft_ball(Vec3::Zero()), test::soft_ball(Vec3(0, 0, 2 * radius + apart_by))});
  for (int k = 0; k < 2; ++k) {
    const std::vector<Vec3>& skin = rig.bodies[k].body->skin_rest();
    const double away = k == 0 ? -1 : 1, middle = k == 0 ? 0 : 2 * radius + apart_by;
    for (int row = 0; row < static_cast<int>(skin.size()); row += 3)
      if (away * (skin[row].z() - middle) > 8e-3) rig.hold(k, row, skin[row], 5);
  }
  rig.joins.push_back(std::make_shared<SkinJoin>(*rig.bodies[0].body, *rig.bodies[1].body, std::array{0, 1}));
  return rig;
}

/// Counts what it is asked; always idle.
struct IdleJoin : Join {
  mutable int asked = 0;
  bool idle(std::span<const SkinBounds>) const override { return true; }
  void find(const VecX&) const override { ++asked; }
  double value(const VecX&) const override { return ++asked; }
  void add_gradient(const VecX&, VecX&) const override { ++asked; }
  void add_hessian(const VecX&, BlockMatrix&) const override { ++asked; }
  void add_cliques(const VecX&, bool, std::vector<std::vector<int>>&) const override { ++asked; }
  double safe_share(const VecX&, const VecX&, double) const override { return ++asked; }
};

TEST(SkinJoin, NothingIsAskedOfAnIdleJoin) {
  GroupRig rig = held_balls(50e-3);
  const auto join = std::make_shared<IdleJoin>();
  rig.joins.push_back(join);
  for (Vec3& target : rig.bodies[1].loads.grip.target) target.z() += 1e-3;
  EXPECT_GT(rig.settle().iterations, 0);
  EXPECT_EQ(join->asked, 0);
}

TEST(SkinJoin, BallsPressedTogetherMeetAndDoNotOverlap) {
  CALOT_SLOW_WHEN_SANITIZED("two balls pressed together");
  GroupRig rig = held_balls(0.3e-3);
  const SkinJoin& join = *rig.joins[0]->skins();
  for (int step = 0; step < 5; ++step) {
    for (Vec3& target : rig.bodies[1].loads.grip.target) target.z() -= 2.4e-3;
    ASSERT_TRUE(rig.settle().converged()) << step;
    EXPECT_EQ(crossings(rig), 0U) << step;
  }
  const VecX x = rig.x();
  EXPECT_GT(join.gap(x), 0);
  // What presses is what the springs hold against.
  Vec3 held = Vec3::Zero();
  const GroupRig::One& upper = rig.bodies[1];
  for (std::size_t i = 0; i < upper.loads.grip.row.size(); ++i)
    held += upper.loads.grip.stiffness[i] *
            (upper.loads.grip.target[i] - upper.body->skin_point(upper.loads.grip.row[i], upper.state.x));
  EXPECT_LT(held.z(), -0.2);
  EXPECT_LT((join.force(x) + held).norm(), 1e-5 * held.norm());
}

TEST(SkinJoin, NoMotionTakesBodiesThroughEachOther) {
  for (const std::vector<BodyPointer>& bodies : near_bodies()) {
    const Near near(bodies, 0);
    for (const double start : {0.0, 15e-3, 60e-3}) {
      // From `start` above its place the other goes down by 100 mm, turning a little.
      VecX x = near.x, step = VecX::Zero(x.size());
      const Eigen::Index first = bodies[0]->rest().size(), size = bodies[1]->rest().size();
      for (Eigen::Index i = first; i < first + size; i += 3) {
        x[i + 2] += start;
        step.segment<3>(i) = Vec3(2e-3, 0.1 * x[i], -100e-3);
      }
      const SkinJoin join(*bodies[0], *bodies[1], {0, 1});
      join.begin(near.rig.places());
      const double share = join.safe_share(x, step, 1.0);
      EXPECT_LT(share, (start + 1.5 * apart) / 95e-3);  // drawn balls are a little smaller than they are
      // At least what a gap of `apart` or half the way down leaves room for.
      EXPECT_GT(share, 0.4 * (start + apart) / 100e-3);
      for (int k = 1; k <= 20; ++k) EXPECT_GT(join.gap(x + k * 0.05 * share * step), 0);
    }
  }
}

bool same(const std::vector<SkinTouch>& a, const std::vector<SkinTouch>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const SkinTouch& s, const SkinTouch& t) {
    return s.skin == t.skin && s.point == t.point && s.other == t.other && s.part.corner == t.part.corner &&
           s.part.times == t.part.times && s.gap == t.gap && s.area == t.area;
  });
}

TEST(SkinJoin, IsIdleOnlyWhereAFullLookFindsNothing) {
  Rng rng(11);
  const auto random = [&](double most) {
    return Vec3(rng.uniform(-most, most), rng.uniform(-most, most), rng.uniform(-most, most));
  };
  for (const std::vector<BodyPointer>& bodies : near_bodies()) {
    const Near near(bodies, 0);
    const Eigen::Index first = bodies[0]->rest().size(), size = near.x.size();
    int idle = 0, busy = 0;
    for (int k = 0; k < 200; ++k) {
      // From nearly touching to far apart, resting or with a motion and a twist of either.
      const double scale = std::pow(10.0, rng.uniform(-5, -1.5));
      const Vec3 away = random(std::pow(10.0, rng.uniform(-4, -1))), one = random(scale),
                 other = random(scale), twist = random(10 * scale);
      VecX x = near.x, step(size);
      for (Eigen::Index i = 0; i < size; i += 3) {
        if (i >= first) x.segment<3>(i) += Vec3(away.x(), away.y(), std::abs(away.z()));
        step.segment<3>(i) = (i < first ? one : other) + twist.cross(x.segment<3>(i));
      }
      if (k % 4 == 0) step.setZero();
      const auto bounds = [&](int body) -> SkinBounds {
        const Eigen::Index from = body == 0 ? 0 : first, own = bodies[body]->rest().size();
        return {skin_box(*bodies[body], x.segment(from, own)),
                skin_motion(*bodies[body], step.segment(from, own))};
      };
      if (!near.join->idle(std::vector{bounds(0), bounds(1)})) {
        ++busy;
        continue;
      }
      ++idle;
      const SkinJoin look(*bodies[0], *bodies[1], {0, 1});
      look.begin(near.rig.places());
      EXPECT_GE(look.gap(x), uncouple_above);
      EXPECT_EQ(look.value(x), 0);
      EXPECT_EQ(look.safe_share(x, step, 1.0), 1.0);
      std::vector<std::vector<int>> cliques;
      look.add_cliques(x, false, cliques);
      EXPECT_TRUE(cliques.empty());
    }
    EXPECT_GT(std::min(idle, busy), 20);
  }
}

TEST(SkinJoin, WhatOtherBodiesDoIsNoNewState) {
  const std::vector<BodyPointer> bodies{near_bodies()[0][0], near_bodies()[0][1], duct_along_x(-90e-3)};
  GroupRig rig(bodies);
  const SkinJoin join(*bodies[0], *bodies[1], {0, 1});
  join.begin(rig.places());
  VecX x = rig.x();
  const std::vector<SkinTouch> touches = join.touching(x);
  ASSERT_FALSE(touches.empty());
  const int searched = join.searches();
  // Far more than would have the two looked at anew, and nothing finite.
  for (const double by : {0.5, std::numeric_limits<double>::infinity()}) {
    x.tail(bodies[2]->rest().size()).array() += by;
    EXPECT_TRUE(same(join.touching(x), touches));
    EXPECT_EQ(join.searches(), searched);
  }
}

TEST(SkinJoin, MotionsAsideAreFree) {
  const Near near(near_bodies()[0], 0);
  VecX step = VecX::Zero(near.x.size());
  for (Eigen::Index i = near.x.size() / 2; i < near.x.size(); i += 3) step[i + 2] = 100e-3;
  EXPECT_EQ(near.join->safe_share(near.x, step, 1.0), 1.0);
  EXPECT_EQ(near.join->safe_share(near.x, step, 0.7), 0.7);
}

/// A duct held by springs at its ends is drawn by 10 mm a step: half a metre a second at 50 steps a second.
void draw_across(GroupRig& rig, int duct, const Vec3& by, int steps) {
  for (int step = 0; step < steps; ++step) {
    for (Vec3& target : rig.bodies[duct].loads.grip.target) target += by;
    ASSERT_TRUE(rig.settle(1e-6).converged()) << step;
    ASSERT_EQ(crossings(rig), 0U) << step;
    ASSERT_GT(rig.joins[0]->skins()->gap(rig.x()), 0) << step;
  }
}
void hold_ends(GroupRig& rig, int body, double stiffness) {
  const std::vector<Vec3>& skin = rig.bodies[body].body->skin_rest();
  for (std::size_t row : {std::size_t{0}, skin.size() - 1})
    rig.hold(body, static_cast<int>(row), skin[row], stiffness);
}

TEST(SkinJoin, ADuctDrawnAcrossABallStaysOutside) {
  CALOT_SLOW_WHEN_SANITIZED("a duct drawn across a ball");
  GroupRig rig({test::straight_duct(Vec3(-30e-3, -30e-3, 4e-3), Vec3(30e-3, -30e-3, 4e-3), thin),
                test::soft_ball(Vec3::Zero())});
  hold_ends(rig, 0, 10);
  const std::vector<Vec3>& skin = rig.bodies[1].body->skin_rest();
  for (int row = 0; row < static_cast<int>(skin.size()); row += 3)
    if (skin[row].z() < -5e-3) rig.hold(1, row, skin[row], 20);
  rig.joins.push_back(std::make_shared<SkinJoin>(*rig.bodies[0].body, *rig.bodies[1].body, std::array{0, 1}));
  draw_across(rig, 0, Vec3(0, 10e-3, 0), 4);
}

TEST(SkinJoin, ADuctDrawnAcrossADuctStaysOnItsSide) {
  GroupRig rig({test::straight_duct(Vec3(0, 0, -25e-3), Vec3(0, 0, 25e-3), thin),
                test::straight_duct(Vec3(-25e-3, -12e-3, 3e-3), Vec3(25e-3, -12e-3, 3e-3), thin)});
  hold_ends(rig, 0, 100);
  hold_ends(rig, 1, 20);
  rig.joins.push_back(std::make_shared<SkinJoin>(*rig.bodies[0].body, *rig.bodies[1].body, std::array{0, 1}));
  draw_across(rig, 1, Vec3(0, 10e-3, 0), 4);
  const VecX &still = rig.bodies[0].state.x, &drawn = rig.bodies[1].state.x;
  EXPECT_GT(still[3 * (still.size() / 6) + 1], drawn[3 * (drawn.size() / 6) + 1]);
}

bool same(const std::vector<EdgeTouch>& a, const std::vector<EdgeTouch>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const EdgeTouch& s, const EdgeTouch& t) {
    return s.ends == t.ends && s.sample.energy == t.sample.energy && s.area == t.area;
  });
}

TEST(SkinJoin, MemoryLeavesNoTrace) {
  std::vector<std::vector<BodyPointer>> all = near_bodies();
  all.push_back(crossing_boxes(0.06e-3));
  for (const std::vector<BodyPointer>& bodies : all) {
    const Near near(bodies);
    Rng rng(7);
    VecX x = near.x;
    int touched = 0;
    const int before = near.join->searches();
    constexpr int steps = 60;
    for (int k = 0; k < steps; ++k) {
      const Vec3 drift(0.05e-3, 0.02e-3, 0.02e-3 * std::sin(0.5 * k));
      VecX step = test::random_coordinates(rng, static_cast<int>(x.size()), 1e-6);
      for (Eigen::Index i = bodies[0]->rest().size(); i < x.size(); i += 3) step.segment<3>(i) += drift;
      // A look elsewhere between.
      if (k % 20 == 7) near.join->value(x + 200 * step);
      const SkinJoin fresh(*bodies[0], *bodies[1], {0, 1});
      fresh.begin(near.rig.places());
      ASSERT_TRUE(same(near.join->touching(x), fresh.touching(x))) << k;
      ASSERT_TRUE(same(near.join->crossing(x), fresh.crossing(x))) << k;
      ASSERT_EQ(near.join->safe_share(x, 3 * step, 1.0), fresh.safe_share(x, 3 * step, 1.0));
      std::vector<std::vector<int>> remembered, found;
      near.join->add_cliques(x, true, remembered);
      fresh.add_cliques(x, true, found);
      ASSERT_EQ(remembered, found);
      touched += fresh.touching(x).empty() && fresh.crossing(x).empty() ? 0 : 1;
      x += step;
    }
    EXPECT_GT(touched, 10);
    EXPECT_LT(near.join->searches() - before, steps / 2);
  }
}

TEST(SkinJoin, DetailsTakePart) {
  const BodyPointer plain = test::soft_ball(Vec3::Zero(), radius, 61, 1),
                    duct = duct_along_x(radius + thin + apart);
  const ShellBody& shell = *plain->as_shell();
  const Vec3 top(0, 0, radius);
  const auto distance = [&](int node) { return (shell.node_rest()[node] - top).norm(); };
  int nearest = shell.levels().nodes(0);
  for (int node = nearest; node < shell.levels().nodes(1); ++node)
    if (distance(node) < distance(nearest)) nearest = node;
  const auto extended = std::make_shared<const ShellBody>(shell.with_details({nearest}).value());
  const SkinJoin join(*plain, *duct, {0, 1});
  GroupRig before({plain, duct}), after({extended, duct});
  join.begin(before.places());
  const double energy = join.value(before.x());
  ASSERT_GT(energy, 0);
  join.begin(after.places());
  VecX x = after.x();
  EXPECT_NEAR(join.value(x), energy, 1e-9 * energy);
  x[extended->rest().size() - 1] = 0.1e-3;
  EXPECT_GT(join.value(x), 1.01 * energy);
  after.joins.push_back(std::make_shared<SkinJoin>(*plain, *duct, std::array{0, 1}));
  after.joins[0]->begin(after.places());
  test::expect_derivatives(after, *after.joins[0], x, 1e-9, 1e-4);
}

TEST(SkinJoin, AMatrixServesForManySteps) {
  GroupRig rig = held_balls(0.1e-3);
  rig.joins.push_back(std::make_shared<Joint>(
      joint_links(*rig.bodies[0].body, *rig.bodies[1].body, {0, 1}, Vec3(radius, 0, 0), 3e-3, 1.0).value()));
  int made = 0;
  for (int step = 0; step < 20; ++step) {
    const std::vector<std::vector<int>> before = rig.patterns.joined;
    for (Vec3& target : rig.bodies[1].loads.grip.target) target += Vec3(0.1e-3, 0, -0.1e-3);
    ASSERT_TRUE(rig.settle().converged()) << step;
    made += rig.patterns.joined != before ? 1 : 0;
  }
  EXPECT_GE(made, 1);
  EXPECT_LE(made, 8);
  // Far apart again, their couplings go.
  for (const double up : {30e-3, 0.1e-3}) {
    for (Vec3& target : rig.bodies[1].loads.grip.target) target.z() += up;
    ASSERT_TRUE(rig.settle().converged());
  }
  EXPECT_EQ(rig.patterns.joined.size(), 1U) << "the joint's";
}

TEST(SkinJoin, AnOrganPushedByAToolPushesAnother) {
  CALOT_SLOW_WHEN_SANITIZED("two organs and a tool");
  const Vec3 up = -Vec3::UnitZ();  // they hang
  Field field = test::make_field(test::held_ball(), 1e-6, up);
  OrganDefinition beside = test::ball(Vec3(40.5e-3, 0, 0));
  beside.held = {{"base", "neck", 10e-3, 1e6}};
  field.add(make_organ(beside, {}, up, field.tolerance).value());
  const auto join =
      std::make_shared<SkinJoin>(*field.organs[0].body, *field.organs[1].body, std::array{0, 1});
  field.group.joins.push_back(join);
  const auto x = [&] {
    VecX out(field.organs[0].state.x.size() + field.organs[1].state.x.size());
    out << field.organs[0].state.x, field.organs[1].state.x;
    return out;
  };
  test::add_grasper(field, Vec3(-150e-3, 0, 24e-3));
  ASSERT_EQ(test::move_tip(field, Vec3(-30e-3, 0, 22e-3), 0, 1), "");
  for (const double to : {-20e-3, -10e-3}) {  // each a step at half a metre a second
    ASSERT_EQ(test::move_tip(field, Vec3(to, 0, 22e-3), 0, 1), "");
    EXPECT_GT(join->gap(x()), 0);
  }
  EXPECT_GT(join->force(x()).x(), 0.02);
  int far = 0;
  const Organ& pushed = field.organs[1];
  for (std::size_t i = 0; i < pushed.body->skin_rest().size(); ++i)
    if (pushed.body->skin_rest()[i].x() > pushed.body->skin_rest()[far].x()) far = static_cast<int>(i);
  EXPECT_GT(pushed.body->skin_point(far, pushed.state.x).x(), 60.6e-3);
}

}  // namespace
}  // namespace skin_join_test
}  // namespace calot
