// Where bile and blood go that have left the organs.

#include "liquid/spill.h"

#include <gtest/gtest.h>

#include "field_rig.h"
#include "liquid/drops.h"
#include "liquid/films.h"
#include "support/long_run.h"

namespace calot {
namespace {

constexpr double ball_foot = 30e-3;  // m, above the ground

/// A ball over a plane that slopes down along x.
Field ball_over_slope(double slope = 0.2) {
  OrganDefinition ball = test::held_ball();
  ball.neck.z() += ball_foot;
  ball.fundus.z() += ball_foot;
  Field field = test::make_field(ball, 1e-6, Vec3::UnitZ());
  field.ground.push_back({"ground", Plane{Vec3::Zero(), Vec3(slope, 0, 1).normalized()}, 0, false});
  field.up = Vec3::UnitZ();
  field.middle = Vec3(0, 0, ball_foot);
  return field;
}

void drip(Field& field, const Vec3& at, double volume, Carries liquid = Carries::blood) {
  field.spill.drops.push_back({liquid, at, Vec3::Zero(), volume});
}

void wait(Field& field, double time) {
  for (int k = 0; k < time * 50 - 0.5; ++k) spill(field, 0.02);
}

const Film* film_on_ground(const Field& field) {
  for (const Film& film : field.spill.films)
    if (film.on < 0) return &film;
  return nullptr;
}

/// Mean place of what lies on a film's surface, m.
Vec3 middle_of(const Field& field, const Film& film) {
  const WetSurface surface = wet_surface(field, film.on);
  Vec3 sum = Vec3::Zero();
  double volume = 0;
  for (const WetPoint& wet : film.wet) {
    sum += (wet.volume[0] + wet.volume[1]) * surface.at[wet.point];
    volume += wet.volume[0] + wet.volume[1];
  }
  return sum / volume;
}

TEST(Spills, ADropFallsFreelyAndSpreadsWhereItLands) {
  Field field = ball_over_slope(0);
  drip(field, Vec3(40e-3, 0, 50e-3), 10e-9);
  spill(field, 0.05);
  ASSERT_EQ(field.spill.drops.size(), 1u);
  EXPECT_NEAR(field.spill.drops[0].at.z(), 50e-3 - 0.5 * units::standard_gravity * 0.05 * 0.05, 1e-9);
  wait(field, 0.1);
  EXPECT_TRUE(field.spill.drops.empty());
  const Film* film = film_on_ground(field);
  ASSERT_NE(film, nullptr);
  EXPECT_LT((middle_of(field, *film) - Vec3(40e-3, 0, 0)).norm(), 1e-3);
  EXPECT_GT(film->wet.size(), 8u) << "10 mm^3 lie no thicker than a millimetre";
  EXPECT_NEAR(field.spill.lying(Carries::blood), 10e-9, 1e-18);
}

TEST(Spills, AFilmRunsDownASlopeAndOffAnUndersideAndNothingIsLost) {
  CALOT_SLOW_WHEN_SANITIZED("thousands of wet points for some seconds");
  Field field = ball_over_slope();
  const Vec3 top(2e-3, 0, ball_foot + 45e-3);
  for (int k = 0; k < 90; ++k)
    drip(field, top + Vec3(0, 0, 1e-3 * k), 10e-9, k % 2 ? Carries::bile : Carries::blood);
  double lowest_yet = 1;
  for (int k = 0; k < 12; ++k) {
    wait(field, 0.25);
    EXPECT_NEAR(field.spill.lying(Carries::blood), 450e-9, 1e-15) << k;
    EXPECT_NEAR(field.spill.lying(Carries::bile), 450e-9, 1e-15) << k;
    for (const Film& film : field.spill.films)
      for (const WetPoint& wet : film.wet)
        for (double volume : wet.volume) ASSERT_GE(volume, -1e-20);
    for (const Film& film : field.spill.films) {
      const WetSurface surface = wet_surface(field, film.on);
      for (const WetPoint& wet : film.wet) {
        if (field.up.dot(surface.normals[wet.point]) > 0) continue;
        const double clings = 1e-3 * surface.mesh->areas[wet.point], one_drop = 10e-9;
        EXPECT_LT(wet.volume[0] + wet.volume[1], clings + one_drop) << "more would not hang there";
      }
    }
    if (film_on_ground(field) != nullptr || field.spill.films.empty()) continue;
    const double height = middle_of(field, field.spill.films[0]).z();
    EXPECT_LT(height, lowest_yet) << k;
    lowest_yet = height;
  }
  // The ball keeps a thin film; the ground has the rest, which has run on from below it.
  const Film* ground = film_on_ground(field);
  ASSERT_NE(ground, nullptr);
  double on_ground = 0;
  for (const WetPoint& wet : ground->wet) on_ground += wet.volume[0] + wet.volume[1];
  EXPECT_GT(on_ground, 100e-9);
  const double then = middle_of(field, *ground).x();
  wait(field, 0.5);
  EXPECT_GT(middle_of(field, *film_on_ground(field)).x(), then);
}

TEST(Spills, WhatLiesLevelComesToRestAndStaysAsItIs) {
  CALOT_SLOW_WHEN_SANITIZED("thousands of wet points for some seconds");
  Field field = ball_over_slope(0);
  for (int k = 0; k < 20; ++k) drip(field, Vec3(40e-3, 0, 5e-3), 10e-9);
  wait(field, 8);
  const Film before = *film_on_ground(field);
  wait(field, 0.1);
  const Film& after = *film_on_ground(field);
  ASSERT_EQ(before.wet.size(), after.wet.size());
  double change = 0, deepest = 0;
  const WetSurface surface = wet_surface(field, after.on);
  for (std::size_t k = 0; k < before.wet.size(); ++k) {
    change = std::max(change, std::abs(after.wet[k].volume[1] - before.wet[k].volume[1]));
    deepest = std::max(deepest, after.wet[k].volume[1] / surface.mesh->areas[after.wet[k].point]);
  }
  EXPECT_EQ(change, 0);
  EXPECT_LT(deepest, 0.4e-3) << "200 mm^3 in a puddle";
}

/// Drops on the ground and on top of the ball, and what they became when nothing of it moves any more.
Field with_films_at_rest() {
  Field field = ball_over_slope(0);
  drip(field, Vec3(40e-3, 0, 5e-3), 10e-9);
  drip(field, Vec3(0, 0, ball_foot + 45e-3), 2e-9, Carries::bile);
  for (int k = 0; k < 3000; ++k)
    if (spill(field, 0.02) == 0 && field.spill.drops.empty()) return field;
  ADD_FAILURE() << "after a minute they still flow";
  return field;
}

void expect_same(const Film& film, const Film& other) {
  EXPECT_EQ(film.on, other.on);
  ASSERT_EQ(film.wet.size(), other.wet.size());
  for (std::size_t k = 0; k < film.wet.size(); ++k) {
    EXPECT_EQ(film.wet[k].point, other.wet[k].point);
    EXPECT_EQ(film.wet[k].volume, other.wet[k].volume);
  }
}

TEST(Spills, FilmsAtRestCostNothing) {
  Field field = with_films_at_rest();
  ASSERT_EQ(field.spill.films.size(), 2u) << "on the ball and on the ground";
  for (int k = 0; k < 20; ++k) EXPECT_EQ(spill(field, 0.02), 0) << "looks at what they do";
  EXPECT_EQ(spill(field, 0.013), 2) << "in parts of another length each film is looked at once";
  EXPECT_EQ(spill(field, 0.013), 0);
}

TEST(Spills, FilmsAtRestAreWhatTheyWereIfTheyWereLookedAt) {
  Field field = with_films_at_rest(), looked_at = field;
  for (int k = 0; k < 20; ++k) {
    spill(field, 0.02);
    for (Film& film : looked_at.spill.films) film.rest.reset();
    EXPECT_EQ(spill(looked_at, 0.02), 2);
  }
  for (std::size_t k = 0; k < 2; ++k) expect_same(field.spill.films[k], looked_at.spill.films[k]);
}

TEST(Spills, FilmsAtRestFlowAgainWhereWhatCarriesThemTilts) {
  Field field = with_films_at_rest();
  const double then = middle_of(field, *film_on_ground(field)).x();
  field.up = Vec3(-0.5, 0, 1).normalized();
  EXPECT_GT(spill(field, 0.02), 0);
  wait(field, 2);
  EXPECT_GT(middle_of(field, *film_on_ground(field)).x(), then);
}

TEST(Spills, AFilmAtRestFlowsAgainWhereItsOrganTurnsAndNotOnWhatItLeft) {
  Field field = with_films_at_rest();
  VecX& x = field.organs[0].state.x;
  const VecX before = x;
  const Mat3 turn = Eigen::AngleAxisd(1.2, Vec3::UnitX()).toRotationMatrix();
  for (Eigen::Index k = 0; k < x.size(); k += 3) x.segment<3>(k) = turn * before.segment<3>(k);
  EXPECT_EQ(spill(field, 0.02), 4) << "four parts of a step, and the ground's film still lies";
  x = before;
  EXPECT_GT(spill(field, 0.02), 0) << "what has flowed meanwhile was never at rest there";
}

TEST(Spills, AFilmAtRestFlowsAgainWhereMoreLandsOnIt) {
  Field field = with_films_at_rest();
  const Film before = *film_on_ground(field);
  drip(field, Vec3(40e-3, 0, 1e-3), 10e-9);
  wait(field, 1);
  EXPECT_GT(film_on_ground(field)->wet.size(), before.wet.size()) << "thicker, it wets more";
}

TEST(Spills, WhatFallsPastEverythingIsCounted) {
  Field field = ball_over_slope();
  field.ground.clear();
  drip(field, Vec3(60e-3, 0, 0), 7e-9, Carries::bile);
  wait(field, 0.6);
  EXPECT_TRUE(field.spill.drops.empty());
  EXPECT_EQ(field.spill.out_of_sight[0], 7e-9);
}

TEST(Spills, WhatFallsAwayIsFarFromTheFieldWhereverItsOriginIs) {
  Field field = ball_over_slope(0);
  field.middle = Vec3(1, 0, ball_foot);
  const Vec3 above = field.middle + Vec3(40e-3, 0, 20e-3);
  drip(field, above, 10e-9);
  drop_clip(field, ClipSize::ml, above, Vec3::UnitX());
  wait(field, 0.2);
  EXPECT_NEAR(field.spill.lying(Carries::blood), 10e-9, 1e-18);
  EXPECT_NE(film_on_ground(field), nullptr);
  EXPECT_EQ(field.spill.clips.size(), 1u);
}

}  // namespace
}  // namespace calot
