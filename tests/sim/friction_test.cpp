// Coulomb friction of pushed skin, measured at the tool.

#include <gtest/gtest.h>

#include <map>

#include "motion/settle_field.h"
#include "slide_rig.h"
#include "support/long_run.h"

namespace calot::friction_test {
namespace {

double furthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

std::vector<Vec3> skin(const test::Slide& slide) {
  return slide.organ().body->skin_positions(slide.organ().state.x);
}

TEST(Rubbing, SlidingSkinPullsByFrictionTimesWhatPresses) {
  CALOT_SLOW_WHEN_SANITIZED("long slides");
  for (double friction : {0.1, 0.2, 0.3}) {
    test::Slide slide(friction);
    ASSERT_EQ(slide.press(), "");
    ASSERT_EQ(slide.go(-4e-3, 5e-3, 5), "");
    const test::Slide::Contact now = slide.contact();
    EXPECT_GT(now.normal, 0.5);
    // Points at the rim of the contact stick or slide back: some hundredths of what presses.
    EXPECT_NEAR(now.rubbing / now.normal, friction, 0.01 * friction);
    // The jaw's rounded edges press aside too, which the plain sum of forces does not count.
    EXPECT_NEAR(-now.along.y() / now.push.z(), friction, 0.03 * friction);
    EXPECT_LT(std::abs(now.along.x()), 0.15 * std::abs(now.along.y())) << "against the motion";
  }
}

TEST(Rubbing, NeverLeavesTheCone) {
  CALOT_SLOW_WHEN_SANITIZED("long slides");
  test::Slide slide(0.2);
  ASSERT_EQ(slide.press(), "");
  for (double way : {0.3, 0.6, 1.0, 2.0, 4.0, 6.0, 5.8, 5.0, 3.0, 0.0}) {
    ASSERT_EQ(slide.go(-4e-3, way * 1e-3, 1), "");
    const test::Slide::Contact now = slide.contact();
    EXPECT_GT(now.rubbing, 0.01 * now.normal);
    EXPECT_LE(now.beyond, friction_tolerance * 0.2 * now.normal) << "at " << way << " mm";
  }
}

TEST(Rubbing, BelowTheConeTheSkinSticksAndDoesNotCreep) {
  CALOT_SLOW_WHEN_SANITIZED("long slides");
  test::Slide slide(1.0, 61);
  ASSERT_EQ(slide.press(), "");
  const Tool& tool = slide.field.tools[0];
  const auto in_the_jaws = [&] {
    const FrictionLoad load = friction_load(slide.field, slide.organ(), present_poses(slide.field));
    std::map<std::pair<int, int>, std::pair<Vec3, double>> out;  // by shape and point
    ContactPlaces places(slide.organ().body->skin(), slide.organ().state.x);
    for (const RubbingPoint& rubbing : load.points)
      out[{rubbing.shape, rubbing.point}] = {
          part_frame(tool, tool.pose, slide.field.shape(rubbing.shape).part).inverse() *
              places.at(rubbing.point),
          rubbing.hold.limit};
    return out;
  };
  const auto before = in_the_jaws();
  ASSERT_GT(before.size(), 50u);
  ASSERT_EQ(slide.go(-4e-3, 3e-3, 3), "");
  const auto after = in_the_jaws();
  double drift = 0, weight = 0, pressed = 0;
  for (const auto& [point, held] : before) {
    const auto& [place, limit] = held;
    pressed += limit;
    const auto now = after.find(point);
    if (now == after.end()) continue;
    // Along the pad, of which the jaw's y and z are the axes.
    drift += limit * (now->second.first - place).tail<2>().norm();
    weight += limit;
  }
  EXPECT_GT(pressed, 0.5) << "N";
  // Dragged along, the ball tilts: a fifth of it leaves the flat pad, others come to touch.
  EXPECT_GT(weight, 0.75 * pressed) << "most of what pressed still does";
  EXPECT_LT(drift / weight, 60e-6) << "m, a fiftieth of the way: what springs give and the rim slips";
  EXPECT_LT(slide.contact().rubbing, 0.8 * slide.contact().normal);

  const VecX x = slide.organ().state.x;
  const Vec3 force = test::tool_force(slide.field);
  ASSERT_EQ(slide.go(-4e-3, 3e-3, 50), "");
  EXPECT_EQ(slide.organ().state.x, x) << "a tool that rests a second long leaves it where it is";
  EXPECT_EQ(test::tool_force(slide.field), force);
}

TEST(Rubbing, WhatSticksDoesNotDependOnTheMesh) {
  CALOT_SLOW_WHEN_SANITIZED("long slides");
  test::Slide few(0.3, 61), many(0.3, 160);
  for (test::Slide* slide : {&few, &many}) ASSERT_EQ(slide->press(), "");
  const auto pulled = [](test::Slide& slide, double way) {
    EXPECT_EQ(slide.go(-4e-3, way, 4), "");
    return -slide.contact().along.y() / slide.contact().push.z();
  };
  const double coarse = pulled(few, 1e-3), fine = pulled(many, 1e-3);
  EXPECT_GT(coarse, 0.05);
  EXPECT_LT(coarse, 0.25) << "most of it sticks";
  // The balls differ by the discretisation of their walls.
  EXPECT_NEAR(coarse / fine, 1, 0.1);
  EXPECT_NEAR(pulled(few, 5e-3) / pulled(many, 5e-3), 1, 0.03) << "sliding";
}

TEST(Rubbing, ACycleLosesEnergyWithFrictionAndGivesAllBackWithoutIt) {
  CALOT_SLOW_WHEN_SANITIZED("long slides");
  const auto cycle = [](double friction, int fineness, double& largest) {
    test::Slide slide(friction);
    EXPECT_EQ(slide.press(4 * fineness), "");
    EXPECT_EQ(slide.go(-4e-3, 6e-3, 4 * fineness), "");
    largest = slide.work;
    EXPECT_EQ(slide.go(-4e-3, -2e-3, 5 * fineness), "");
    EXPECT_EQ(slide.go(-4e-3, 0, 2 * fineness), "");
    EXPECT_EQ(slide.go(1.2e-3, 0, 4 * fineness), "");
    EXPECT_EQ(slide.contact().normal, 0.0);
    return slide.work;
  };
  double largest = 0;
  // The trapezoidal rule errs by the square of the step, most where points begin to touch: finest where nothing is
  // to remain.
  const double none = cycle(0, 2, largest);
  EXPECT_LT(std::abs(none), 2e-3 * largest);
  EXPECT_GT(largest, 1e-3);
  const double some = cycle(0.2, 1, largest), more = cycle(0.4, 1, largest);
  // 16 mm of way under 1 N: all of it would be 16 mJ times friction, had nothing stuck.
  EXPECT_GT(some, 0.2 * 0.5 * 16e-3);
  EXPECT_LT(some, 0.2 * 1.05 * 16e-3);
  EXPECT_GT(more, some);
  EXPECT_GT(cycle(1.0, 1, largest), 0) << "where it sticks nearly all is given back";
}

TEST(Rubbing, TheRateOfTheStepsHardlyMatters) {
  CALOT_SLOW_WHEN_SANITIZED("long slides");
  test::Slide fast(0.3, 61), slow(0.3, 61);
  ASSERT_EQ(fast.press(1), "");
  ASSERT_EQ(slow.press(10), "");
  for (double way : {3e-3, 6e-3, 2e-3}) {
    ASSERT_EQ(fast.go(-4e-3, way, 1), "");
    ASSERT_EQ(slow.go(-4e-3, way, 10), "");
    const double pull = slow.contact().along.norm();
    EXPECT_LT((fast.contact().along - slow.contact().along).norm(), 0.02 * pull) << "after " << way << " m";
    EXPECT_LT(furthest(skin(fast), skin(slow)), 0.05e-3) << "of " << way << " m";
  }
}

TEST(Rubbing, WithoutFrictionAYankEndsWhereASlowPullEnds) {
  CALOT_SLOW_WHEN_SANITIZED("long slides");
  test::Slide yank(0), slow(0);
  ASSERT_EQ(yank.press(1), "");
  ASSERT_EQ(yank.go(-4e-3, 6e-3, 1), "");  // 300 mm/s at 50 Hz
  ASSERT_EQ(slow.press(20), "");
  ASSERT_EQ(slow.go(-4e-3, 6e-3, 30), "");
  EXPECT_LT(furthest(skin(yank), skin(slow)), 1e-6) << "m; equilibrium is met to 1e-6 of the nodal forces";
  EXPECT_TRUE(yank.organ().friction.points.empty());
}

TEST(Rubbing, ASupportThatRubsCarriesItsShareOfASidewaysPush) {
  OrganDefinition ball = test::taut_ball(61);
  ball.held = {{"top", "fundus", 12e-3, 2e5}};
  ball.neck = {0, 0, 0.6e-3};
  ball.fundus = {0, 0, 40.6e-3};
  const Vec3 up = Vec3::UnitZ();
  Vec3 share[2];
  for (double friction : {0.0, 0.3}) {
    Field field = test::make_field(ball, 1e-9, up, Plane{Vec3::Zero(), up});
    field.ground[0].friction = friction;
    test::add_grasper(field, {0, -150e-3, 20e-3});
    const auto at = [&](double y) { return pose_reaching(field.tools[0].trocar, Vec3(0, y, 15e-3), 0, 0); };
    field.tools[0].pose = at(-30e-3);
    SolveStatistics statistics;
    for (double y : {-25e-3, -20e-3, -17e-3}) ASSERT_TRUE(advance(field, {at(y)}, statistics)) << y;
    const Organ& organ = field.organs[0];
    const ContactLoads now = contact_loads(field, organ, present_poses(field));
    Vec3 rub = Vec3::Zero(), push = Vec3::Zero();
    ContactPlaces places(organ.body->skin(), organ.state.x);
    for (const RubbingPoint& rubbing : now.friction.points)
      if (field.shape(rubbing.shape).is_ground())
        rub += rubbing.hold.sample(places.at(rubbing.point)).gradient;
    for (const ContactForce& force :
         contact_forces(*organ.body, organ.state.x, now, gather_pairs(*organ.body, organ.state.x, now, 0.0)))
      if (field.shape(force.shape).is_ground()) push += force.on_shape;
    EXPECT_GT(test::tool_force(field).norm(), 0.02);
    // Equilibrium to 1e-9 of the nodal forces (below 1 N), on some 60 nodes.
    const Vec3 on_organ = test::bed_force(organ) - test::bile_weight(organ) * up - test::tool_force(field);
    EXPECT_LT((on_organ - push - rub).norm(), 1e-7);
    EXPECT_LE(rub.norm(), 1.001 * friction * push.norm());
    share[friction > 0] = rub;
  }
  EXPECT_EQ(share[0], Vec3::Zero());
  EXPECT_GT(share[1].y(), 0.01) << "pushed along +y, the ball drags the support along";
}

}  // namespace
}  // namespace calot::friction_test
