// What a stroke with current hurts follows from its distances to the skins around it (acts/burn.h).

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acts/burn.h"
#include "acts/clearance.h"
#include "acts/current.h"
#include "base/units.h"
#include "group/contact_search.h"
#include "organs/body_kinds.h"
#include "rig.h"

namespace calot {
namespace {

constexpr double power = 30, duration = 0.04;  // W, s
constexpr double each = power * duration;      // J a step
constexpr double mm = units::mm;

/// Organs as they come to rest alone, and an electrode 5 mm across among them that nothing stops.
struct Stroke {
  Field field;
  std::vector<WorldEvent> events;

  explicit Stroke(const std::vector<OrganDefinition>& organs) {
    for (const OrganDefinition& organ : organs) add(organ);
    Tool& tool = field.tools.emplace_back();
    tool.definition = default_instrument(InstrumentType::bipolar_electrode);
    tool.definition.name = "hook";
    tool.definition.power = power;
    tool.geometry = instrument_geometry(tool.definition.type);
    tool.action = InstrumentAction::activate;
  }
  void add(const OrganDefinition& organ) { field.add(make_organ(organ, {}, Vec3::UnitZ(), 1e-6).value()); }
  Organ& organ(std::size_t k) { return field.organs[k]; }
  /// Its tip is there, and its shaft points `along`.
  void put(const Vec3& tip, const Vec3& along) {
    Tool& tool = field.tools[0];
    tool.trocar = tip - 0.1 * along;
    tool.pose = pose_reaching(tool.trocar, tip, 0, 0, tool.geometry);
  }
  /// Its tip points at a place from outside, a gap (m) before it.
  void put_before(const Vec3& place, const Vec3& out, double gap) { put(place + gap * out, -out); }
  void act(int steps = 1) {
    for (int k = 0; k < steps; ++k)
      for (const WorldEvent& event : apply_current(field, std::vector<ToolLoad>(1), duration))
        events.push_back(event);
  }
  double taken(std::size_t of) const {
    double sum = 0;
    for (const Burn& burn : field.organs[of].burns) sum += burn.energy;
    return sum;
  }
  double most_taken(std::size_t of) const {
    double most = 0;
    for (const Burn& burn : field.organs[of].burns) most = std::max(most, burn.energy);
    return most;
  }
  int count(EventKind kind) const {
    return static_cast<int>(std::count_if(events.begin(), events.end(),
                                          [&](const WorldEvent& event) { return event.kind == kind; }));
  }
  /// From what current flows through to an organ's skin, m: on its triangles, split into 24 parts along each edge.
  double distance(std::size_t to) const {
    constexpr int parts = 24;
    const Tool& tool = field.tools[0];
    const Shape end = instrument_shapes(tool.trocar, tool.pose, tool.geometry)[2];
    const Organ& organ = field.organs[to];
    const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t : organ.body->skin().triangles) {
      const double longest = std::max((skin[t[1]] - skin[t[0]]).norm(), (skin[t[2]] - skin[t[0]]).norm());
      if (signed_distance(end, skin[t[0]]) > longest + 1e-3) continue;
      for (int i = 0; i <= parts; ++i)
        for (int j = 0; i + j <= parts; ++j)
          least = std::min(
              least,
              signed_distance(end, (i * skin[t[0]] + j * skin[t[1]] + (parts - i - j) * skin[t[2]]) / parts));
    }
    return least;
  }
};

/// The law, of a reach of 0.3 mm.
double weight_at(double distance) { return std::clamp((0.3e-3 - distance) / 0.25e-3, 0.0, 1.0); }

OrganDefinition lobe(double width = 120e-3) {
  OrganDefinition organ;
  organ.name = "liver";
  organ.shape = LobeShape{.width = width, .bed_width = 0, .bed_depth = 0};
  return organ;
}

/// The middle of a liver's underside.
struct Underside {
  Vec3 place, out, along;  ///< m; unit, off it; unit, in it
  explicit Underside(const Organ& liver) {
    const int point = liver.landmarks.at("underside");
    place = liver.body->skin_point(point, liver.state.x);
    out = liver.body->skin_normals(liver.state.x)[static_cast<std::size_t>(point)];
    along = out.cross(Vec3::UnitX()).normalized();
  }
};

/// A gallbladder's fundus before the liver's underside: `room` m between them, and the electrode's end, in the middle.
struct BetweenWalls : Stroke {
  Underside liver{organ(0)};
  double room;

  explicit BetweenWalls(double room_for) : Stroke({lobe()}), room(room_for) {
    OrganDefinition ball = test::bedded_ball();
    ball.name = "gallbladder";
    ball.fundus = liver.place + room * liver.out;
    ball.neck = ball.fundus + 40e-3 * liver.out;
    ball.bile = {};
    add(ball);
    // It sags, and its skin lies inside its sphere: moved on until the room is as wide as it should be.
    put_at(0);
    const double wide = distance(0) + distance(1) + 5e-3;
    VecX& x = organ(1).state.x;
    for (int k = 0; k < organ(1).body->coarse_nodes(); ++k) x.segment<3>(3 * k) -= (wide - room) * liver.out;
  }
  /// Its middle in the middle of the room, or nearer by so much (m) to the gallbladder.
  void put_at(double nearer) {
    const double middle_before_tip = 3e-3;
    put(liver.place + (0.5 * room + nearer) * liver.out + middle_before_tip * liver.along, liver.along);
  }
};

TEST(WoundsOfCurrent, AWallsWeightFallsFromOneWhereItIsTouchedToNothingAtItsReach) {
  EXPECT_EQ(burn_weight(-1e-6, 0.3e-3), 1);
  EXPECT_EQ(burn_weight(contact_gap, 0.3e-3), 1) << "it is touched from here on";
  EXPECT_NEAR(burn_weight(0.1e-3, 0.3e-3), 0.8, 1e-12);
  EXPECT_NEAR(burn_weight(0.2e-3, 0.3e-3), 0.4, 1e-12);
  EXPECT_EQ(burn_weight(0.3e-3, 0.3e-3), 0);
  EXPECT_EQ(burn_weight(0.35e-3, 0.3e-3), 0);
  EXPECT_EQ(burn_weight(contact_gap, 0), 1) << "without a reach a wall takes what touches it";
  EXPECT_EQ(burn_weight(1.01 * contact_gap, 0), 0);
}

TEST(WoundsOfCurrent, BesideOneOfTwoWallsItHurtsThatByItsDistanceAndMidwayNone) {
  BetweenWalls plane(5.8e-3);
  for (const std::size_t wall : {0u, 1u})
    for (const double gap : {0.1e-3, 0.2e-3, 0.35e-3, 0.4e-3}) {
      for (Organ& organ : plane.field.organs) organ.burns.clear();
      plane.put_at((wall == 1 ? 1 : -1) * (0.4e-3 - gap));
      const double found = plane.distance(wall);
      ASSERT_NEAR(found, gap, 0.03e-3);
      ASSERT_GT(plane.distance(1 - wall), 0.35e-3);
      plane.act(5);
      EXPECT_NEAR(plane.taken(wall), 5 * each * weight_at(found), 0.02 * each) << wall << ", m: " << gap;
      EXPECT_EQ(plane.taken(1 - wall), 0) << wall << ", m: " << gap;
      EXPECT_EQ(plane.taken(wall) > 0, gap < 0.3e-3);
    }
}

TEST(WoundsOfCurrent, ClearanceIsToTheSurfaceBetweenItsPointsToo) {
  BetweenWalls plane(6.4e-3);
  for (const double nearer : {-0.5e-3, 0.0, 0.4e-3}) {
    plane.put_at(nearer);
    for (const std::size_t wall : {0u, 1u})
      EXPECT_NEAR(clearance(plane.field.tools[0], plane.organ(wall)).distance, plane.distance(wall), 0.01e-3);
  }
  // The liver's points lie up to 5 mm apart: to the nearest of them it is further.
  const std::vector<Shape> end = working_shapes(plane.field.tools[0]);
  EXPECT_FALSE(clearance_within(end, plane.organ(0), plane.distance(0) - 0.02e-3));
  ASSERT_TRUE(clearance_within(end, plane.organ(0), plane.distance(0) + 0.02e-3));
  EXPECT_NEAR(signed_distance(end[0], clearance_within(end, plane.organ(0), 5e-3)->place), plane.distance(0),
              0.01e-3);
}

TEST(WoundsOfCurrent, WallsThatAreBothNearShareThePowerAndAllOfItIsCounted) {
  BetweenWalls plane(5.2e-3);
  plane.put_at(0.05e-3);
  const std::array weights{weight_at(plane.distance(0)), weight_at(plane.distance(1))};
  ASSERT_GT(weights[0] + weights[1], 1.2);
  ASSERT_GT(weights[1], weights[0] + 0.1);
  plane.act(10);
  EXPECT_NEAR(plane.taken(0) + plane.taken(1), 10 * each, 1e-9);
  EXPECT_NEAR(plane.taken(1) / plane.taken(0), weights[1] / weights[0], 0.03);
}

/// A ball whose skin is touched here and there along its meridian.
struct TouchedBall : Stroke {
  explicit TouchedBall(int nodes = 61) : Stroke({ball_of(nodes)}) {}
  static OrganDefinition ball_of(int nodes) {
    OrganDefinition organ = test::bedded_ball();
    organ.nodes = nodes;
    organ.bile = {};
    return organ;
  }
  /// The tip on the skin so far (rad) from its top, as seen from its middle, for some steps.
  void visit(double angle, int steps) {
    const Vec3 out(std::sin(angle), 0, std::cos(angle));
    const Vec3 place = organ(0).definition.neck + Vec3(0, 0, 20e-3) + 20e-3 * out;
    put_before(place, out, 0);
    put_before(place, out, -distance(0));
    act(steps);
  }
};

TEST(WoundsOfCurrent, ATouchedWallAloneTakesAllAndOpensWhereAPlaceHasTakenItsBurnEnergy) {
  TouchedBall ball;
  ball.visit(0, 8);
  EXPECT_NEAR(ball.taken(0), 8 * each, 1e-9);
  ball.visit(0.5, 8);  // 10 mm aside
  ball.put(ball.organ(0).definition.fundus + Vec3(0, 0, 30e-3), -Vec3::UnitZ());
  ball.act(20);
  EXPECT_NEAR(ball.taken(0), 16 * each, 1e-9) << "off the wall it takes nothing";
  EXPECT_EQ(ball.count(EventKind::perforation), 0) << "no place has taken 15 J";
  ball.visit(0, 4);
  EXPECT_EQ(ball.count(EventKind::perforation), 0);
  ball.visit(0, 1);  // the thirteenth: 15.6 J
  ASSERT_EQ(ball.count(EventKind::perforation), 1) << "a second visit goes on from the first";
  EXPECT_EQ(ball.organ(0).openings.size(), 1u);
  ball.visit(0, 40);
  EXPECT_EQ(ball.count(EventKind::perforation), 1) << "once a place";
  ball.visit(0.5, 5);
  EXPECT_EQ(ball.count(EventKind::perforation), 2) << "the other place too";
  EXPECT_EQ(ball.organ(0).burns.size(), 2u);
}

TEST(WoundsOfCurrent, ASweepOverManyPlacesNeedsThatManyTimesTheEnergyOfOne) {
  constexpr int places = 5;
  TouchedBall ball;
  const auto visit = [&](int place, int steps) { ball.visit(0.15 * place, steps); };  // 3 mm apart
  for (int round = 0; round < 3; ++round)
    for (int place = 0; place < places; ++place) visit(place, 4);
  EXPECT_EQ(ball.count(EventKind::perforation), 0) << "72 J, of which each place took 14.4";
  for (int place = 0; place < places; ++place) visit(place, 1);
  EXPECT_EQ(ball.count(EventKind::perforation), places);
}

/// After a stroke of 6 mm over a ball.
TouchedBall swept_ball(int nodes) {
  TouchedBall ball(nodes);
  for (int k = -15; k < 15; ++k) ball.visit(0.01 * k, 1);
  return ball;
}

TEST(WoundsOfCurrent, WhatAPlaceOfASweepTakesHardlyDependsOnTheMesh) {
  const TouchedBall coarse = swept_ball(40), fine = swept_ball(120);
  EXPECT_NEAR(fine.taken(0), coarse.taken(0), 1e-9);
  EXPECT_NEAR(fine.most_taken(0), coarse.most_taken(0), 0.2 * coarse.most_taken(0));
  EXPECT_NEAR(static_cast<double>(fine.field.organs[0].burns.size()),
              static_cast<double>(coarse.field.organs[0].burns.size()), 1.0);
  // 30 steps over 6 mm: five a mm, and a place is 1 to 2 mm wide.
  EXPECT_LT(fine.most_taken(0), 10.5 * each);
  EXPECT_GT(fine.most_taken(0), 3.5 * each);
}

TEST(WoundsOfCurrent, WhatLiesAlongAWallBurnsALineAndATipASpot) {
  Stroke liver({lobe()});
  const Underside side(liver.organ(0));
  const auto take = [&](double length) {
    liver.organ(0).burns.clear();
    const Vec3 end = side.place + 1.0e-3 * side.out;  // 0.1 mm before it
    const std::vector<ReachedWall> walls =
        reached_walls(liver.field, {Capsule{end, end + length * side.along, 0.9e-3}});
    ASSERT_EQ(walls.size(), 1u);
    EXPECT_GT(walls[0].weight(), 0.6);
    burn(walls[0], "hook", 10, liver.events);
    EXPECT_NEAR(liver.taken(0), 10, 1e-12);
  };
  take(0);
  EXPECT_NEAR(liver.most_taken(0), 10, 1e-12) << "one place takes it all";
  take(5.5e-3);
  EXPECT_GE(liver.organ(0).burns.size(), 4u);
  EXPECT_LT(liver.most_taken(0), 4.1) << "J: two pieces of five or six at most count to one place";
}

TEST(WoundsOfCurrent, ALiverLosesItsCapsuleByTheAreaThatItsDosePaysForAndSaysSoOnceAPiece) {
  Stroke liver({lobe()});
  const Underside side(liver.organ(0));
  liver.put_before(side.place, side.out, 0);
  liver.act(2);
  EXPECT_EQ(liver.count(EventKind::raw_surface), 0) << "0.96 mm^2";
  liver.act();
  ASSERT_EQ(liver.count(EventKind::raw_surface), 1);
  const WorldEvent& event = liver.events.back();
  EXPECT_EQ(event.organ, "liver");
  EXPECT_EQ(event.instrument, "hook");
  EXPECT_EQ(event.cause, EventCause::current);
  EXPECT_NEAR(event.value, 3 * each / 2.5, 1e-9) << "mm^2";
  ASSERT_TRUE(event.place);
  EXPECT_LT((*event.place - side.place).norm(), 0.2e-3);
  for (int k = 1; k <= 8; ++k) {  // on over 8 mm, without a gap
    liver.put_before(side.place + k * mm * side.along, side.out, 0);
    liver.act(5);
  }
  EXPECT_EQ(liver.count(EventKind::raw_surface), 1) << "it is one piece";
  liver.put_before(side.place - 6 * mm * side.along, side.out, 0);
  liver.act(3);
  EXPECT_EQ(liver.count(EventKind::raw_surface), 2) << "another piece";
  EXPECT_NEAR(raw_area(liver.organ(0)), liver.taken(0) / 2.5e6, 1e-15);
  EXPECT_GT(raw_area(liver.organ(0)), 20 * mm * mm);
  EXPECT_EQ(liver.count(EventKind::perforation), 0) << "it is not hollow";
}

/// What a stroke of 6 mm along the underside, from 0.1 to 0.25 mm before it by its measured distances, leaves raw, m^2.
double raw_after_stroke(double width) {
  Stroke liver({lobe(width)});
  const Underside side(liver.organ(0));
  for (int k = 0; k < 12; ++k) {
    const double wanted = 0.1e-3 + 12.5e-6 * k;
    const Vec3 over = side.place + 0.5 * k * mm * side.along;
    double gap = wanted;
    for (int turn = 0; turn < 2; ++turn) {
      liver.put_before(over, side.out, gap);
      gap += wanted - liver.distance(0);
    }
    liver.put_before(over, side.out, gap);
    liver.act();
  }
  return raw_area(liver.organ(0));
}

TEST(WoundsOfCurrent, TheRawAreaIsThatOfTheDistancesWhateverTheMesh) {
  double expected = 0;  // m^2
  for (int k = 0; k < 12; ++k) expected += each * weight_at(0.1e-3 + 12.5e-6 * k) / 2.5e6;
  for (const double width : {80e-3, 300e-3})
    EXPECT_NEAR(raw_after_stroke(width), expected, 0.01 * expected) << "m, a lobe's width";
}

}  // namespace
}  // namespace calot
