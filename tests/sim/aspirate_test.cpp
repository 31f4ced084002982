// What a needle draws out of a hollow organ, how fast, until when, and that all of it is counted.

#include "liquid/aspirate.h"

#include <gtest/gtest.h>

#include <numbers>

#include "act_rig.h"
#include "base/units.h"
#include "field/field_state.h"
#include "liquid/outflow.h"
#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

using std::numbers::pi;

constexpr double drawn_density = 1020;  // kg/m^3

InstrumentDefinition needle_at(const std::string& port) {
  InstrumentDefinition needle = default_instrument(InstrumentType::aspiration_needle);
  needle.name = "left";
  needle.port = port;
  return needle;
}

// ---- laws

TEST(NeedleLaw, AThinBoreDrawsByHagenAndPoiseuille) {
  InstrumentDefinition needle = needle_at("right_subcostal");
  needle.bore = 0.3e-3;
  const double inside = 2600, over = inside + needle.suction, time = 1e-3;
  const double wanted = pi * std::pow(needle.bore, 4) * over / (128 * bile_viscosity * needle.bore_length);
  // What its mouth takes is 7e-4 of the pressure here.
  EXPECT_NEAR(drawn_by(needle, inside, 0, drawn_density, time), wanted * time, 1e-3 * wanted * time);
  InstrumentDefinition twice = needle;
  twice.bore_length *= 2;
  EXPECT_NEAR(drawn_by(twice, inside, 0, drawn_density, time), 0.5 * wanted * time, 1e-3 * wanted * time);
}

TEST(NeedleLaw, WhatBoreAndMouthTakeIsAllThePressureThereIs) {
  InstrumentDefinition needle = needle_at("right_subcostal");
  for (const double bore : {0.5e-3, 0.9e-3, 1.2e-3}) {
    needle.bore = bore;
    const double inside = 6e3, q = drawn_by(needle, inside, 0, drawn_density, 1);
    const double mouth = 0.25 * pi * bore * bore, speed = q / (discharge * mouth);
    ASSERT_LT(0.5 * drawn_density * speed * speed, inside) << "the wall does not shut its mouth";
    EXPECT_NEAR(
        bore_resistance(bore, needle.bore_length, bile_viscosity) * q + 0.5 * drawn_density * speed * speed,
        inside + needle.suction, 1e-6);
  }
}

TEST(NeedleLaw, ASlackWallGivesNoMoreThanItsOwnPressureDrives) {
  InstrumentDefinition needle = needle_at("right_subcostal");
  const double mouth = 0.25 * pi * needle.bore * needle.bore;
  for (const double inside : {1.0, 50.0, 400.0}) {
    const double choked = discharge * mouth * std::sqrt(2 * inside / drawn_density);
    for (const double suction : {13e3, 80e3}) {
      needle.suction = suction;
      EXPECT_NEAR(drawn_by(needle, inside, 0, drawn_density, 1), choked, 1e-12 * choked);
    }
  }
  EXPECT_EQ(drawn_by(needle, 0, 1e-9, drawn_density, 1), 0);
  EXPECT_EQ(drawn_by(needle, -20, 1e-9, drawn_density, 1), 0) << "it is slack";
  const double compliance = 2e-9, start = 900;
  double p = start, sum = 0;
  for (int k = 0; k < 5000; ++k) {
    const double out = drawn_by(needle, p, compliance, drawn_density, 1e-3);
    sum += out;
    p -= out / compliance;
  }
  EXPECT_NEAR(sum, compliance * start, 1e-12 * sum) << "all that its wall presses out, and then no more";
}

TEST(NeedleLaw, TheLengthOfStepsChangesLittle) {
  InstrumentDefinition needle = needle_at("right_subcostal");
  needle.bore = 0.8e-3;
  // Against dp/dt = -Q / C: of bore and suction alone an exponential, but for what the mouth takes.
  const double compliance = 2e-9, start = 4e3;
  const auto drawn = [&](int steps) {
    double p = start, sum = 0;
    for (int k = 0; k < steps; ++k) {
      const double out = drawn_by(needle, p, compliance, drawn_density, 0.5 / steps);
      sum += out;
      p -= out / compliance;
    }
    return sum;
  };
  EXPECT_NEAR(drawn(500), drawn(4000), 1e-5 * drawn(4000));
}

// ---- a needle in a world

/// A needle over a ball: straight down on its top.
struct Needling {
  World world;
  Vec3 top, trocar;
  std::vector<WorldEvent> events = {};

  explicit Needling(const SceneDefinition& scene, const std::string& place = "ball.fundus", int threads = 1)
      : world(World::create(scene, nullptr, threads).value()),
        top(world.landmark(place)),
        trocar(world.port_position(scene.instruments[0].port)) {}

  testing::AssertionResult step(const Vec3& tip, InstrumentAction action, int times = 1) {
    const InstrumentGeometry geometry = instrument_geometry(InstrumentType::aspiration_needle);
    for (int k = 0; k < times; ++k) {
      const Result<StepReport> done = world.step({{pose_reaching(trocar, tip, 0, 0, geometry)}, {action}});
      if (!done) return testing::AssertionFailure() << to_text(done.failure());
      events.insert(events.end(), done->events.begin(), done->events.end());
    }
    return testing::AssertionSuccess();
  }
  Vec3 above(double height) const { return top + height * (trocar - top).normalized(); }
  /// Pushed on the top by 2 mm.
  testing::AssertionResult push() {
    for (const double height : {20e-3, 5e-3, 1e-3, -1e-3, -2e-3})
      if (testing::AssertionResult there = step(above(height), InstrumentAction::none); !there) return there;
    return step(above(-2e-3), InstrumentAction::none, 2);
  }
  testing::AssertionResult draw(int times) { return step(above(-2e-3), InstrumentAction::aspirate, times); }
  const WorldEvent* last(EventKind kind) const {
    for (auto event = events.rbegin(); event != events.rend(); ++event)
      if (event->kind == kind) return &*event;
    return nullptr;
  }
  int count(EventKind kind) const {
    return static_cast<int>(
        std::count_if(events.begin(), events.end(), [&](const WorldEvent& e) { return e.kind == kind; }));
  }
  double volume() const { return world.field().organs[0].state.volume; }
  LostState booked() const { return world.report().lost.empty() ? LostState{} : world.report().lost.front(); }
};

SceneDefinition needle_scene(double pinhole = 0.3e-3) {
  SceneDefinition scene = test::ball_scene();
  scene.instruments = {needle_at("right_subcostal")};
  scene.instruments[0].pinhole = pinhole;
  return scene;
}

TEST(Needle, DrawsATenseOrganSlackAndAllOfItIsCounted) {
  CALOT_SLOW_WHEN_SANITIZED("a ball drawn slack");
  Needling needling(needle_scene());
  const double start = needling.volume(), tense = needling.world.report().organs[0].pressure;
  ASSERT_TRUE(needling.push());
  double before = start;
  for (int k = 0; k < 60; ++k) {
    ASSERT_TRUE(needling.draw(1));
    const LostState booked = needling.booked();
    EXPECT_NEAR(needling.volume() + booked.bile + booked.aspirated, start, 1e-9 * start) << k;
    EXPECT_NEAR(needling.world.report().organs[0].volume, needling.volume(), 1e-6 * start) << k;
    EXPECT_EQ(booked.bile, 0) << "the needle is in its hole";
    EXPECT_LE(needling.volume(), before) << k;
    before = needling.volume();
  }
  EXPECT_EQ(needling.count(EventKind::puncture), 1);
  EXPECT_EQ(needling.count(EventKind::empty_aspiration), 0);
  EXPECT_EQ(needling.last(EventKind::puncture)->organ, "ball");
  EXPECT_LT(needling.world.report().organs[0].pressure, 0.1 * tense) << "and no suction draws on";
  const double drawn = needling.booked().aspirated;
  EXPECT_GT(drawn, 0.2e-6);
  EXPECT_EQ(needling.world.report().instruments[0].aspirated, drawn);
  ASSERT_TRUE(needling.draw(5));
  EXPECT_LT(needling.booked().aspirated - drawn, 0.02 * drawn) << "it is slack";

  ASSERT_TRUE(needling.step(needling.above(-2e-3), InstrumentAction::none));
  const WorldEvent* told = needling.last(EventKind::aspirated);
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(told->instrument, "left");
  EXPECT_EQ(told->organ, "ball");
  EXPECT_DOUBLE_EQ(told->value, needling.booked().aspirated / units::mL);
  EXPECT_DOUBLE_EQ(told->time, needling.world.report().time);
}

TEST(Needle, DrawsByItsLawAtThePressureThere) {
  Needling needling(needle_scene());
  ASSERT_TRUE(needling.push() && needling.draw(1));
  ASSERT_EQ(needling.count(EventKind::puncture), 1);
  EXPECT_EQ(needling.booked().aspirated, 0) << "it went in when the step ended";
  const Field& field = needling.world.field();
  const Organ& ball = field.organs[0];
  const Vec3 mouth = ball.body->skin_point(field.tools[0].needle.point, ball.state.x);
  const double pressure = shell_of(ball)->bile()->pressure_at(mouth, ball.state.datum_pressure);
  const double density = ball.definition.bile.density;
  ASSERT_TRUE(needling.draw(1));
  const double duration = 1 / needling.world.scene().solver.rate;
  // Its pressure falls in that step: so much less than with none of its wall's give, and more than from its end.
  const double stiff = drawn_by(needling.world.scene().instruments[0], pressure, 0, density, duration);
  const double now = shell_of(ball)->bile()->pressure_at(mouth, ball.state.datum_pressure);
  const double least = drawn_by(needling.world.scene().instruments[0], now, 0, density, duration);
  EXPECT_LT(needling.booked().aspirated, stiff);
  EXPECT_GT(needling.booked().aspirated, least);
  EXPECT_LT(stiff - least, 0.5 * stiff) << "a band that says something";
}

TEST(Needle, LeavesAPinholeThatLeaksUnlessItIsSealed) {
  for (const double pinhole : {0.5e-3, 0.0}) {
    Needling needling(needle_scene(pinhole));
    const double start = needling.volume();
    ASSERT_TRUE(needling.push() && needling.draw(3));
    ASSERT_TRUE(needling.step(needling.above(20e-3), InstrumentAction::none, 5));
    const LostState booked = needling.booked();
    EXPECT_EQ(needling.count(EventKind::bile_leak), pinhole > 0 ? 1 : 0);
    EXPECT_EQ(booked.bile > 0, pinhole > 0);
    EXPECT_NEAR(needling.volume() + booked.bile + booked.aspirated, start, 1e-9 * start);
    EXPECT_EQ(needling.world.field().organs[0].openings.size(), pinhole > 0 ? 1u : 0u);
  }
}

TEST(Needle, OnceMoreThroughItsOwnHoleMakesNoOther) {
  Needling needling(needle_scene());
  ASSERT_TRUE(needling.push() && needling.draw(2));
  ASSERT_TRUE(needling.step(needling.above(-2e-3), InstrumentAction::none, 2));
  ASSERT_TRUE(needling.draw(2));
  EXPECT_EQ(needling.count(EventKind::puncture), 2);
  EXPECT_EQ(needling.count(EventKind::aspirated), 1);
  EXPECT_EQ(needling.world.field().organs[0].openings.size(), 1u);
}

TEST(Needle, DrawnAwayFromItsHoleItIsOut) {
  Needling needling(needle_scene());
  ASSERT_TRUE(needling.push() && needling.draw(2));
  ASSERT_TRUE(needling.step(needling.above(0.5 * needle_depth), InstrumentAction::aspirate));
  EXPECT_EQ(needling.count(EventKind::aspirated), 0) << "not as far as it is deep";
  ASSERT_TRUE(needling.step(needling.above(1.5 * needle_depth), InstrumentAction::aspirate, 2));
  EXPECT_EQ(needling.count(EventKind::aspirated), 1);
  EXPECT_EQ(needling.count(EventKind::empty_aspiration), 1) << "it draws on, and draws air";
}

TEST(Needle, AspiratingAirIsAnEventAndChangesNothing) {
  Needling needling(needle_scene());
  const double start = needling.volume();
  ASSERT_TRUE(needling.step(needling.above(5e-3), InstrumentAction::aspirate, 4));
  ASSERT_EQ(needling.count(EventKind::empty_aspiration), 1) << "once, where it begins";
  EXPECT_EQ(needling.last(EventKind::empty_aspiration)->organ, "");
  EXPECT_FALSE(event_row(EventKind::empty_aspiration).error);
  EXPECT_EQ(needling.volume(), start);
  ASSERT_TRUE(needling.step(needling.above(5e-3), InstrumentAction::none));
  ASSERT_TRUE(needling.step(needling.above(5e-3), InstrumentAction::aspirate));
  EXPECT_EQ(needling.count(EventKind::empty_aspiration), 2);
  ASSERT_TRUE(needling.push());
  EXPECT_EQ(needling.count(EventKind::puncture), 0) << "what does not draw goes through no wall";
}

TEST(Needle, AspiratingLiverIsAnEventThatNamesIt) {
  SceneDefinition scene = needle_scene();
  OrganDefinition liver;
  liver.name = "liver";
  liver.shape = LobeShape{};
  scene.anatomy.organs = {liver};
  scene.laparoscope.look_at = "liver.edge";
  scene.ports = default_ports();
  const Vec3 place = World::create(scene).value().landmark("liver.upper_side");
  const Vec3 out = World::create(scene).value().landmark_normal("liver.upper_side");
  scene.ports.push_back({"over_liver", place + 100e-3 * out});
  scene.instruments[0].port = "over_liver";
  Needling needling(scene, "liver.upper_side");
  ASSERT_TRUE(needling.push() && needling.draw(3));
  ASSERT_EQ(needling.count(EventKind::empty_aspiration), 1);
  EXPECT_EQ(needling.last(EventKind::empty_aspiration)->organ, "liver");
  EXPECT_EQ(needling.count(EventKind::puncture), 0);
  EXPECT_TRUE(needling.world.report().lost.empty());
}

TEST(Needle, IsInTheStateAndItsHashWhateverTheThreads) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2}) {
    Needling needling(needle_scene(), "ball.fundus", threads);
    ASSERT_TRUE(needling.push() && needling.draw(2));
    const FieldState in = needling.world.state();
    EXPECT_GE(in.tools[0].needle.record, 0);
    const auto differs = [&](const char* what, auto&& change) {
      FieldState changed = in;
      change(changed.tools[0].needle);
      ASSERT_TRUE(needling.world.restore(in));
      const std::uint64_t hash = needling.world.state_hash();
      ASSERT_TRUE(needling.world.restore(changed));
      EXPECT_NE(needling.world.state_hash(), hash) << what;
    };
    differs("in what", [](NeedleState& n) { n.record = -1; });
    differs("where", [](NeedleState& n) { ++n.point; });
    differs("drawn", [](NeedleState& n) { n.drawn += 1e-12; });
    differs("ever drawn", [](NeedleState& n) { n.drawn_ever += 1e-12; });
    differs("in nothing", [](NeedleState& n) { n.empty ^= true; });
    for (int again = 0; again < 2; ++again) {
      ASSERT_TRUE(needling.world.restore(in));
      ASSERT_TRUE(needling.draw(3));
      hashes.push_back(needling.world.state_hash());
    }
  }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

}  // namespace
}  // namespace calot
