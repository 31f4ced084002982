// What leaves organs by openings, how fast, and that all of it is counted.

#include "liquid/leak.h"

#include <gtest/gtest.h>

#include <numbers>

#include "act_rig.h"
#include "acts/clips.h"
#include "body/rod_body.h"
#include "field/change_bodies.h"
#include "field/divide_body.h"
#include "field/field_state.h"
#include "field/join_bodies.h"
#include "liquid/leak_source.h"
#include "liquid/perforate.h"
#include "motion/settle_field.h"
#include "organs/body_kinds.h"
#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

using std::numbers::pi;

constexpr double bile_density = 1020;  // kg/m^3

double orifice(double pressure, double area, double density = bile_density) {
  return 0.6 * area * std::sqrt(2 * pressure / density);
}

double lost(const World& world, Carries liquid) {
  double sum = 0;
  for (const LostState& one : world.report().lost) sum += liquid == Carries::blood ? one.blood : one.bile;
  return sum;
}

// ---- laws

TEST(LeakLaw, AnElasticOrganEmptiesByTorricelliAlongAStraightRoot) {
  const double area = 3e-6, compliance = 5e-10, p0 = 1500;
  // Against dp/dt = -Q / C in steps so short that theirs is the only error, some 1e-5.
  double p = p0, out = 0;
  for (int k = 0; k < 20000; ++k) {
    const double dv = 1e-5 * orifice(p - 0.5 * 1e-5 * orifice(p, area) / compliance, area);
    out += dv;
    p -= dv / compliance;
  }
  EXPECT_NEAR(elastic_outflow(p0, compliance, area, bile_density, 0.2), out, 1e-5 * out);
  // The length of steps changes nothing.
  double left = p0, sum = 0;
  for (int k = 0; k < 7; ++k) {
    const double dv = elastic_outflow(left, compliance, area, bile_density, 0.2 / 7);
    sum += dv;
    left -= dv / compliance;
  }
  EXPECT_NEAR(sum, elastic_outflow(p0, compliance, area, bile_density, 0.2), 1e-12 * out);
  EXPECT_DOUBLE_EQ(elastic_outflow(p0, compliance, area, bile_density, 1e3), compliance * p0)
      << "then it is slack";
  // What resists beside comes to the same where it is next to nothing, and rules where it is large.
  EXPECT_NEAR(elastic_outflow(p0, compliance, area, bile_density, 1e-3, 1),
              elastic_outflow(p0, compliance, area, bile_density, 1e-3), 1e-5 * area);
  EXPECT_NEAR(elastic_outflow(p0, compliance, area, bile_density, 1e-3, 1e12), 1e-3 * p0 / 1e12,
              1e-3 * p0 / 1e15);
  EXPECT_EQ(elastic_outflow(-10, compliance, area, bile_density, 1), 0);
  EXPECT_NEAR(elastic_outflow(p0, 0, area, bile_density, 1e-3), 1e-3 * orifice(p0, area), 1e-18);
}

TEST(LeakLaw, WhatThePatientFeedsLosesItsPressureOnTheWayAndInTheOpening) {
  for (const double area : {1e-8, 5e-7, 4e-6})
    for (const double resistance : {0.0, 1e9, 1.2e10}) {
      const double q = fed_flow({12e3, resistance}, 12e3, area, blood_density);
      EXPECT_NEAR(resistance * q + 0.5 * blood_density * std::pow(q / (0.6 * area), 2), 12e3, 1e-6) << area;
    }
  EXPECT_EQ(fed_flow({12e3, 1e9}, 12e3, 0, blood_density), 0);
  EXPECT_EQ(fed_flow({12e3, 1e9}, -1, 1e-6, blood_density), 0);
}

// ---- a bag with a duct

/// A well filled ball with a duct out of its side, whose far end is held.
SceneDefinition bag_and_duct(double rate = 50, double resistance = 0) {
  SceneDefinition scene = test::ball_scene();
  const Vec3 side = scene.anatomy.organs[0].neck + Vec3(0, -20e-3, 20e-3);
  OrganDefinition duct;
  duct.name = "duct";
  duct.shape = TubeShape{.points = {side, side + Vec3(0, -12e-3, 0), side + Vec3(0, -24e-3, 0)},
                         .radius = 1.8e-3,
                         .patient_end = PatientEnd::end};
  std::get<TubeShape>(duct.shape).feed_resistance = resistance;
  duct.wall.thickness = 0.8e-3;
  duct.held = {{"far", "end", 4e-3, 1e6}};
  scene.anatomy.organs.push_back(duct);
  scene.anatomy.joints = {{"duct.start", "ball.body"}};
  scene.instruments.clear();
  scene.solver.rate = rate;
  return scene;
}

constexpr double lumen = pi * 1e-3 * 1e-3;  // m^2, of the duct

/// Bodies without anything that moves them.
struct Bodies {
  Field field;
  explicit Bodies(const SceneDefinition& scene) {
    for (const OrganDefinition& organ : scene.anatomy.organs)
      field.add(make_organ(organ, {}, Vec3::UnitZ(), 1e-6).value());
    EXPECT_TRUE(join_bodies(scene.anatomy, field));
    field.heart_rate = 70;
    keep_members(field);
  }
  Division cut(OrganIndex organ, double share = 0.5) { return divide_body(field, organ, share, 0).value(); }
  void clip(OrganIndex organ, double share, double opening) {
    const RodBody& rod = *field.organ(organ).body->as_tube();
    set_clip(field, organ, {ClipSize::ml, rod.at_share(share), opening, Vec3::UnitZ(), Vec3::UnitY(), 0});
  }
  double pressure(OrganIndex of, OrganIndex organ, bool at_end) const {
    const Organ& open = field.organ(organ);
    const int last = static_cast<int>(open.body->skin_rest().size()) - 1;
    return field.organ(of).body->as_shell()->bile()->pressure_at(
        open.body->skin_point(at_end ? last : 0, open.state.x), field.organ(of).state.datum_pressure);
  }
  std::vector<WorldEvent> run(double duration, int steps = 1) {
    std::vector<WorldEvent> events;
    for (int k = 0; k < steps; ++k) {
      field.time += duration / steps;
      for (const WorldEvent& event : leak(field, duration / steps)) events.push_back(event);
    }
    return events;
  }
  double lost(Carries liquid, const std::string& name = {}) const {
    double sum = 0;
    for (const LostState& one : field.spill.lost)
      if (name.empty() || one.name == name) sum += liquid == Carries::blood ? one.blood : one.bile;
    return sum;
  }
};

TEST(Leaks, AnOpenDuctLosesByItsLumenAndThePressureThere) {
  Bodies bodies(bag_and_duct());
  EXPECT_TRUE(bodies.run(0.02).empty()) << "what is whole loses nothing";
  const Division pieces = bodies.cut(OrganIndex(1));
  const double volume = bodies.field.organs[0].state.volume;
  bodies.field.group.work.factored = false;  // no wall that gives way: the pressure stays
  const double wanted = 0.02 * orifice(bodies.pressure(OrganIndex(0), pieces.specimen, true), lumen);
  // Of the patient's side the bile duct leaves by what feeds it.
  const double fed = 0.02 * fed_flow({1e3, 0}, 1e3, lumen, bile_density);
  const std::vector<WorldEvent> events = bodies.run(0.02);
  EXPECT_NEAR(bodies.lost(Carries::bile, "duct"), wanted + fed, 1e-9 * wanted);
  EXPECT_NEAR(volume - bodies.field.organs[0].state.volume, wanted, 1e-9 * volume);
  ASSERT_EQ(events.size(), 2u);
  for (const WorldEvent& event : events) EXPECT_EQ(event.kind, EventKind::bile_leak);
  EXPECT_EQ(events[1].organ, "duct.specimen");
  EXPECT_NEAR(events[1].value, 60e6 * wanted / 0.02, 1e-6 * events[1].value);
}

TEST(Leaks, ATubeLeaksByItsNarrowestPlaceAndHoldsWhatItsWidthsMake) {
  SceneDefinition scene = bag_and_duct();
  auto& tube = std::get<TubeShape>(scene.anatomy.organs[1].shape);
  const Vec3 start = tube.points.front(), way = tube.points.back() - start;
  tube.points.clear();
  for (int k = 0; k <= 8; ++k) tube.points.push_back(start + k / 8.0 * way);
  tube.radii.assign(9, tube.radius);
  tube.radii[2] = 1.3e-3;  // between the bag and the cut
  Bodies bodies(scene);
  const RodBody& rod = *bodies.field.organs[1].body->as_tube();
  double narrowest = lumen, sum = 0;
  const int last = static_cast<int>(rod.last_point());
  for (int k = 0; k <= last; ++k) {
    narrowest = std::min(narrowest, lumen_area(rod, k));
    sum += lumen_area(rod, k) / (last + 1);
  }
  EXPECT_LT(narrowest, 0.4 * lumen);
  EXPECT_NEAR(lumen_volume(rod) / (sum * rod.length()), 1, 0.03);
  const Division pieces = bodies.cut(OrganIndex(1));
  bodies.field.group.work.factored = false;
  const double wanted = 0.02 * orifice(bodies.pressure(OrganIndex(0), pieces.specimen, true), narrowest);
  bodies.run(0.02);
  EXPECT_NEAR(bodies.lost(Carries::bile, "duct") - 0.02 * fed_flow({1e3, 0}, 1e3, lumen, bile_density),
              wanted, 1e-6 * wanted);
}

TEST(Leaks, AClipLeaksByWhatItLeavesOpenAndAShutOneNothing) {
  for (const double opening : {0.4, 0.1, 0.0}) {
    Bodies bodies(bag_and_duct());
    bodies.clip(OrganIndex(1), 0.2, opening);
    bodies.clip(OrganIndex(1), 0.3, std::max(opening, 0.2));  // the tightest counts
    bodies.clip(OrganIndex(1), 0.8, 0);
    const Division pieces = bodies.cut(OrganIndex(1));
    bodies.field.group.work.factored = false;
    const double wanted =
        0.02 * orifice(bodies.pressure(OrganIndex(0), pieces.specimen, true), lumen * std::min(opening, 1.0));
    EXPECT_EQ(bodies.run(0.02).size(), opening > 0 ? 1u : 0u) << opening;
    EXPECT_NEAR(bodies.lost(Carries::bile), wanted, 1e-9 * orifice(1600, lumen)) << opening;
  }
}

TEST(Leaks, AHoleInATubeIsFedFromEitherSideUntilBothAreShut) {
  Bodies bodies(bag_and_duct());
  Organ& duct = bodies.field.organs[1];
  const Result<double> share = open_tube(duct, 0.5, 1e-3);
  ASSERT_TRUE(share);
  EXPECT_NEAR(share.value(), 0.5, 0.1);
  const double area = 0.25 * pi * 1e-3 * 1e-3;
  EXPECT_DOUBLE_EQ(source_of(bodies.field, OrganIndex(1), duct.openings[0]).area, area);
  // The bag's side is shut: the patient feeds it from the far end.
  bodies.clip(OrganIndex(1), 0.1, 0);
  EXPECT_EQ(source_of(bodies.field, OrganIndex(1), duct.openings[0]).kind, LeakSource::Kind::patient);
  bodies.field.group.work.factored = false;
  const std::vector<WorldEvent> events = bodies.run(0.02);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::bile_leak);
  EXPECT_NEAR(bodies.lost(Carries::bile), 0.02 * fed_flow({1e3, 0}, 1e3, area, bile_density), 1e-15);
  bodies.clip(OrganIndex(1), 0.9, 0);
  const std::vector<WorldEvent> stopped = bodies.run(0.02);
  ASSERT_EQ(stopped.size(), 1u);
  EXPECT_EQ(stopped[0].kind, EventKind::leak_stopped);
}

TEST(Leaks, AHoleInATubeThatIsDividedStaysOnItsPiece) {
  Bodies bodies(bag_and_duct());
  ASSERT_TRUE(open_tube(bodies.field.organs[1], 0.25, 1e-3));
  const Division pieces = bodies.cut(OrganIndex(1), 0.6);
  EXPECT_EQ(bodies.field.organ(pieces.specimen).openings.size(), 2u)
      << "the bag's side, with the hole and the cut";
  EXPECT_EQ(bodies.field.organ(pieces.patient).openings.size(), 1u);
}

TEST(Leaks, AHoleInTheWallLeaksByItsArea) {
  Bodies bodies(bag_and_duct());
  Opening hole;
  hole.area = 2e-6;
  hole.cause = "blades";
  bodies.field.organs[0].openings.push_back(hole);
  bodies.field.group.work.factored = false;
  const Organ& bag = bodies.field.organs[0];
  const double pressure = bag.body->as_shell()->bile()->pressure_at(bag.body->skin_point(0, bag.state.x),
                                                                    bag.state.datum_pressure);
  const std::vector<WorldEvent> events = bodies.run(0.01);
  EXPECT_NEAR(bodies.lost(Carries::bile, "ball"), 0.01 * orifice(pressure, 2e-6), 1e-15);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].instrument, "blades");
}

TEST(Leaks, APressureFallsByTheComplianceOfItsOwnOrgan) {
  SceneDefinition scene = bag_and_duct();
  OrganDefinition stiff = scene.anatomy.organs[0];
  stiff.name = "stiff";
  stiff.neck.x() += 80e-3;
  stiff.fundus.x() += 80e-3;
  stiff.wall.thickness *= 2;
  scene.anatomy.organs.push_back(stiff);
  for (const int open : {0, 2}) {
    Bodies bodies(scene);
    SolveStatistics statistics;
    ASSERT_TRUE(settle_field(bodies.field, "", statistics));
    // By how much its pressure falls with its volume.
    Organ& bag = bodies.field.organs[open];
    const double lost = 1e-4 * bag.state.volume, pressure_before = bag.state.datum_pressure;
    bag.state.volume -= lost;
    ASSERT_TRUE(settle_field(bodies.field, "", statistics));
    const double compliance = lost / (pressure_before - bag.state.datum_pressure);
    Opening hole;
    hole.area = 2e-6;
    bag.openings.push_back(hole);
    const double pressure = bag.body->as_shell()->bile()->pressure_at(bag.body->skin_point(0, bag.state.x),
                                                                      bag.state.datum_pressure);
    bodies.run(0.1);
    const double wanted = elastic_outflow(pressure, compliance, 2e-6, bile_density, 0.1);
    EXPECT_NEAR(bodies.lost(Carries::bile), wanted, 5e-3 * wanted) << open;
  }
}

TEST(Leaks, AHoleThatCurrentBurnsIsWhereItTouchedAndSaysWhatBurntIt) {
  Bodies bodies(bag_and_duct());
  bodies.field.group.work.factored = false;
  Organ& bag = bodies.field.organs[0];
  constexpr int touched = 17;
  const Vec3 at = bag.body->skin_point(touched, bag.state.x);
  perforate(bag, at + Vec3(1e-5, 0, 0), "hook");
  ASSERT_EQ(bag.openings.size(), 1u);
  EXPECT_EQ(bag.openings[0].point, touched);
  const std::vector<WorldEvent> events = bodies.run(0.01);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::bile_leak);
  EXPECT_EQ(events[0].instrument, "hook");
  ASSERT_TRUE(events[0].place);
  EXPECT_EQ(*events[0].place, at);
  perforate(bodies.field.organs[1], at, "hook");
  EXPECT_TRUE(bodies.field.organs[1].openings.empty()) << "a duct is no bag";
}

TEST(Leaks, ABagLosesWhatItsPressureDrivesOutAndAllOfItIsCounted) {
  World world = World::create(bag_and_duct()).value();
  const double start = world.report().organs[0].volume;
  ASSERT_TRUE(world.divide("duct", 0.5));
  int begun = 0, ended = 0;
  double before = 1e9;
  for (int k = 0; k < 60; ++k) {
    const Result<StepReport> step = world.step({});
    ASSERT_TRUE(step) << to_text(step.failure());
    const double fed = world.field().spill.given[0];
    EXPECT_NEAR(step->organs[0].volume + lost(world, Carries::bile) - fed, start, 1e-9 * start) << k;
    EXPECT_LE(step->organs[0].pressure, before + 1e-6) << k;
    before = step->organs[0].pressure;
    for (const WorldEvent& event : step->events) {
      begun += event.kind == EventKind::bile_leak;
      ended += event.kind == EventKind::leak_stopped;
    }
  }
  EXPECT_EQ(begun, 2);
  EXPECT_EQ(ended, 1) << "the bag's has run dry, the patient's side goes on";
  EXPECT_GT(start - world.report().organs[0].volume, 0.2e-6);
}

TEST(Leaks, OfADuctAreUsuallyMillilitresAMinute) {
  SceneDefinition scene = bag_and_duct();
  std::get<TubeShape>(scene.anatomy.organs[1].shape).feed_resistance.reset();
  Bodies bodies(scene);
  const Division pieces = bodies.cut(OrganIndex(1));
  bodies.run(0.02);
  EXPECT_NEAR(60e6 * bodies.field.organ(pieces.patient).openings[0].rate, 3, 0.2);
  EXPECT_NEAR(60e6 * bodies.field.organ(pieces.specimen).openings[0].rate, 20, 4);
}

TEST(Leaks, WhatIsLostDependsLittleOnTheLengthOfSteps) {
  CALOT_SLOW_WHEN_SANITIZED("two runs in small steps");
  std::vector<double> out;
  for (const double rate : {12.5, 25.0, 50.0, 100.0}) {
    World world = World::create(bag_and_duct(rate)).value();
    ASSERT_TRUE(world.divide("duct", 0.5));
    for (int k = 0; k < rate * 0.16 - 0.5; ++k) ASSERT_TRUE(world.step({}));
    out.push_back(lost(world, Carries::bile));
  }
  EXPECT_NEAR(out[2], out[3], 2e-3 * out[3]);
  EXPECT_NEAR(out[0], out[3], 1e-2 * out[3]);
}

TEST(Leaks, AreInTheStateAndItsHashWhateverTheThreads) {
  SceneDefinition scene = bag_and_duct();
  scene.anatomy.ground.push_back({.name = "table", .point = {0, 0, -160e-3}});
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2}) {
    World world = World::create(scene, nullptr, threads).value();
    ASSERT_TRUE(world.divide("duct", 0.5));
    const auto go = [&] {
      for (int k = 0; k < 8; ++k) EXPECT_TRUE(world.step({}));
      hashes.push_back(world.state_hash());
      return lost(world, Carries::bile);
    };
    go();
    const FieldState before = world.state();
    EXPECT_FALSE(before.spill.films.empty());
    const double once = go();
    ASSERT_TRUE(world.restore(before));
    EXPECT_EQ(go(), once);
    EXPECT_NE(hashes[hashes.size() - 3], hashes.back());
    EXPECT_EQ(hashes[hashes.size() - 2], hashes.back());
    // What has left is on its way or lies somewhere.
    double hanging = 0;
    for (const Organ& organ : world.field().organs)
      for (const Opening& opening : organ.openings) hanging += opening.drop;
    const Spill& spill = world.field().spill;
    EXPECT_NEAR(spill.lying(Carries::bile) + spill.out_of_sight[0] + hanging, once, 1e-9 * once);
  }
  EXPECT_EQ(hashes[2], hashes[5]);
}

// ---- blood

/// A cystic artery, held at both ends.
SceneDefinition artery() {
  SceneDefinition scene;
  OrganDefinition tube = test::tube_across("artery");
  auto& shape = std::get<TubeShape>(tube.shape);
  shape.radius = 0.8e-3;
  shape.carries = Carries::blood;
  tube.wall.thickness = 0.4e-3;
  scene.anatomy.organs = {tube};
  return scene;
}

TEST(Bleeding, OfACysticArteryIsThirtyToSixtyMillilitresAMinuteAndBeats) {
  Bodies bodies(artery());
  const Division pieces = bodies.cut(OrganIndex(0));
  const double beat = 60.0 / 70;
  std::vector<WorldEvent> events = bodies.run(beat, 43);
  const double held = pi * 0.4e-3 * 0.4e-3 * 15e-3;  // in the specimen's half
  const double bled = bodies.field.spill.given[1];
  EXPECT_GT(60e6 * bled / beat, 30);
  EXPECT_LT(60e6 * bled / beat, 60);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].kind, EventKind::bleeding);
  // A quarter of a beat after it began the pressure is highest, three quarters after it lowest.
  const auto rate_at = [&](double share) {
    bodies.field.time = 5 * beat + share * beat - 0.001;
    bodies.run(0.002);
    return bodies.field.organ(pieces.patient).openings[0].rate;
  };
  EXPECT_GT(rate_at(0.25), 1.5 * rate_at(0.75));
  bodies.run(2, 100);
  EXPECT_NEAR(bodies.field.spill.drained[1], held, 0.02 * held) << "the cut lies on a skin point";
  EXPECT_NEAR(bodies.lost(Carries::blood), bodies.field.spill.given[1] + bodies.field.spill.drained[1],
              1e-9 * bodies.lost(Carries::blood));
  EXPECT_EQ(bodies.field.organ(pieces.specimen).openings[0].leaks, false);

  bodies.clip(pieces.patient, 0.5, 0);
  events = bodies.run(0.1);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::leak_stopped);
  const double then = bodies.lost(Carries::blood);
  EXPECT_NEAR(events[0].value, 1e6 * (then - held), 0.02 * events[0].value);
  bodies.run(1);
  EXPECT_EQ(bodies.lost(Carries::blood), then);
}

TEST(Bleeding, DoesNotDependOnTheLengthOfSteps) {
  std::vector<double> out;
  for (const int steps : {7, 20, 300}) {
    Bodies bodies(artery());
    bodies.cut(OrganIndex(0));
    bodies.run(0.3, steps);
    out.push_back(bodies.lost(Carries::blood));
  }
  EXPECT_NEAR(out[0], out[2], 1e-5 * out[2]);
  EXPECT_NEAR(out[1], out[2], 1e-5 * out[2]);
}

/// An artery from which another one branches off, at its end or in its middle.
SceneDefinition branched(const std::string& from) {
  SceneDefinition scene = artery();
  OrganDefinition branch = scene.anatomy.organs[0];
  branch.name = "branch";
  const Vec3 start = std::get<TubeShape>(branch.shape).points[from == "end" ? 2 : 1];
  std::get<TubeShape>(branch.shape).points = {start, start + Vec3(8e-3, 0, 0), start + Vec3(16e-3, 0, 0)};
  branch.held = {{"far", "end", 4e-3, 1e6}};
  scene.anatomy.organs.push_back(branch);
  scene.anatomy.joints = {{"branch.start", "artery." + from}};
  return scene;
}

TEST(Bleeding, EndsByAClipRightBesideTheJointOnTheFarSide) {
  struct Clipped {
    std::string from;
    OrganIndex organ;            ///< that is clipped; the other one is cut
    std::vector<double> beside;  ///< skin points from the joint
  };
  constexpr OrganIndex artery{0}, branch{1};
  for (const Clipped& one :
       {Clipped{"end", artery, {-0.5}}, {"middle", artery, {-0.5, 0.5}}, {"end", branch, {0.5}}})
    for (const bool shut : {false, true}) {
      Bodies bodies(branched(one.from));
      const double last = bodies.field.organ(one.organ).body->as_tube()->last_point();
      const double joint = one.organ == branch ? 0 : one.from == "end" ? last : 0.5 * last;
      for (const double beside : one.beside) bodies.clip(one.organ, (joint + beside) / last, shut ? 0 : 1);
      const Division pieces = bodies.cut(one.organ == artery ? branch : artery);
      bodies.run(0.1, 5);
      // Of the branch the patient's piece is the one that grows out of the artery, of the artery the held one.
      const OrganIndex open = one.organ == artery ? pieces.patient : pieces.specimen;
      EXPECT_EQ(bodies.field.organ(open).openings[0].rate > 0, !shut) << one.from << one.organ.value;
    }
}

TEST(Bleeding, EndsBetweenJawsThatCloseOnTheStump) {
  // Rough jaws: out of smooth ones it would slide.
  SceneDefinition scene = test::across(InstrumentType::atraumatic_grasper);
  scene.instruments[0].friction = 0.6;
  std::get<TubeShape>(scene.anatomy.organs[0].shape).carries = Carries::blood;
  test::Acting acting(scene);
  const double deep = test::tube_depth + 14e-3;
  const auto open = [&] {
    const RodBody& rod = *acting.world.field().organs[0].body->as_tube();
    return open_between(acting.world.field(), OrganIndex(0), 0, rod.last_point()) / lumen_area(rod, 0);
  };
  ASSERT_TRUE(acting.go(test::about(0.7, test::tube_depth - 20e-3), 2) &&
              acting.go(test::about(0.7, deep), 8));
  EXPECT_EQ(open(), 1);
  ASSERT_TRUE(acting.go(test::about(0.4, deep), 12));
  EXPECT_GT(open(), 0.2);
  EXPECT_LT(open(), 0.8);
  ASSERT_TRUE(acting.go(test::about(0.24, deep), 8));
  EXPECT_EQ(open(), 0);
  Field without = acting.world.field();
  without.tools[0].waits = true;
  const RodBody& tube = *without.organs[0].body->as_tube();
  EXPECT_EQ(open_between(without, OrganIndex(0), 0, tube.last_point()), lumen_area(tube, 0))
      << "an instrument that waits outside shuts nothing";
  // Cut beyond the jaws: what the specimen's piece holds is all that is lost, until they open.
  ASSERT_TRUE(acting.world.divide("duct", 0.75));
  ASSERT_TRUE(acting.go(test::about(0.24, deep), 3));
  EXPECT_EQ(acting.world.field().spill.given[1], 0);
  EXPECT_EQ(acting.count(EventKind::bleeding), 1);
  ASSERT_TRUE(acting.go(test::about(0.4, deep), 8));
  EXPECT_GT(acting.world.field().spill.given[1], 0);
  EXPECT_EQ(acting.count(EventKind::bleeding), 2);
}

}  // namespace
}  // namespace calot
