#include "session/scoring.h"

#include <gtest/gtest.h>

#include <cmath>

#include "session/session_for_tests.h"

namespace calot {
namespace {

ScorePart benchmark(const std::string& metric, double novice, double expert, double weight) {
  ScorePart part;
  part.name = part.metric = metric;
  part.novice = novice;
  part.expert = expert;
  part.weight = weight;
  return part;
}

ScorePart penalty(EventKind event, double each, double weight) {
  ScorePart part;
  part.kind = ScorePartKind::penalty;
  part.name = to_text(event);
  part.event = event;
  part.each = each;
  part.weight = weight;
  return part;
}

WorldEvent event(EventKind kind, double time, const std::string& instrument = "left") {
  WorldEvent event;
  event.kind = kind;
  event.time = time;
  event.instrument = instrument;
  return event;
}

/// 0.5 hold time (higher is better), 0.2 path (lower is better), 0.3 overforce penalty.
ExerciseDefinition exercise() {
  ExerciseDefinition definition = test::small_exercise();
  definition.score.parts = {benchmark("hold.band.time_in_s", 6, 18, 0.5),
                            benchmark("left.path_length_mm", 400, 120, 0.2),
                            penalty(EventKind::overforce, 0.25, 0.3)};
  definition.score.critical = {EventKind::overstretch};
  return definition;
}

Progress finished() {
  Progress progress;
  progress.begin_step(0, "only", "", 0);
  progress.end_step(9, "done");
  return progress;
}

TEST(Scoring, EachPartIsItsShareOfTheWayFromNoviceToExpert) {
  // F2: 100 sum w clamp((N - m) / (N - E)); penalties 1 - each n.
  Progress progress = finished();
  progress.add_event(event(EventKind::overforce, 2));
  const Score result =
      score(exercise(), {{"hold.band.time_in_s", 15}, {"left.path_length_mm", 190}}, progress);
  EXPECT_NEAR(result.parts[0].points, 100 * 0.5 * (6.0 - 15) / (6 - 18), 1e-12);
  EXPECT_NEAR(result.parts[1].points, 100 * 0.2 * (400.0 - 190) / (400 - 120), 1e-12);
  EXPECT_NEAR(result.parts[2].points, 100 * 0.3 * 0.75, 1e-12);
  EXPECT_NEAR(result.total, result.parts[0].points + result.parts[1].points + result.parts[2].points, 1e-12);
}

TEST(Scoring, BeyondTheBenchmarksNothingIsGainedOrLost) {
  for (const auto& [hold, path, expected] :
       {std::tuple{30.0, 50.0, 100.0}, std::tuple{0.0, 900.0, 30.0}, std::tuple{18.0, 120.0, 100.0}}) {
    const Score result =
        score(exercise(), {{"hold.band.time_in_s", hold}, {"left.path_length_mm", path}}, finished());
    EXPECT_NEAR(result.total, expected, 1e-12);
  }
}

TEST(Scoring, ANovicesVeryValueEarnsZeroNotMinusZero) {
  const Score result = score(exercise(), {{"hold.band.time_in_s", 6}}, finished());
  EXPECT_EQ(result.parts[0].points, 0);
  EXPECT_FALSE(std::signbit(result.parts[0].points));
}

TEST(Scoring, AValueThatMissesABenchmarkByLittleDoesNotReadAsIfItWereThatBenchmark) {
  // Seconds in the band that are one rounding, or 0.4 ms, short of the expert's.
  const auto explained = [](double hold) {
    return score(exercise(), {{"hold.band.time_in_s", hold}}, finished()).parts[0].explanation;
  };
  EXPECT_EQ(explained(17.9996),
            "hold.band.time_in_s = 17.9996, between novice 6 (no points) and expert 18 (all points)");
  EXPECT_EQ(explained(18 - 1e-12), "hold.band.time_in_s = 18, as good as expert 18");
  EXPECT_EQ(explained(6 + 1e-12), "hold.band.time_in_s = 6, no better than novice 6");
}

TEST(Scoring, WhatWasNeverMeasuredEarnsNothingAndSaysSo) {
  const Score result = score(exercise(), {{"left.path_length_mm", 100}}, Progress());
  EXPECT_FALSE(result.parts[0].measured);
  EXPECT_EQ(result.parts[0].points, 0);
  EXPECT_NE(result.parts[0].explanation.find("never measured"), std::string::npos);
  EXPECT_FALSE(result.completed);
}

TEST(Scoring, APenaltyNeverCostsMoreThanItsPart) {
  Progress progress = finished();
  for (int i = 0; i < 9; ++i) progress.add_event(event(EventKind::overforce, i));
  const Score result = score(exercise(), {}, progress);
  EXPECT_EQ(result.parts[2].points, 0);
  EXPECT_EQ(*result.parts[2].measured, 9);
  EXPECT_EQ(result.parts[2].times, (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(Scoring, ACriticalEventCapsTheTotalAndFailsTheExercise) {
  const std::map<std::string, double> perfect{{"hold.band.time_in_s", 20}, {"left.path_length_mm", 100}};
  EXPECT_TRUE(score(exercise(), perfect, finished()).passed);
  Progress progress = finished();
  progress.add_event(event(EventKind::overstretch, 3.5, ""));
  const Score result = score(exercise(), perfect, progress);
  EXPECT_EQ(result.total, 40);
  EXPECT_EQ(result.uncapped, 100);
  EXPECT_FALSE(result.passed);
  ASSERT_EQ(result.critical.size(), 1u);
  EXPECT_EQ(result.critical[0].times, (std::vector<double>{3.5}));
}

TEST(Scoring, ALowTotalIsNotRaisedToTheCap) {
  Progress progress = finished();
  progress.add_event(event(EventKind::overstretch, 3.5, ""));
  for (int i = 0; i < 4; ++i) progress.add_event(event(EventKind::overforce, i));
  EXPECT_EQ(score(exercise(), {}, progress).total, 0);
}

TEST(Scoring, PassingTakesEveryDeclaredStepAndThePassMark) {
  const std::map<std::string, double> perfect{{"hold.band.time_in_s", 20}, {"left.path_length_mm", 100}};
  EXPECT_FALSE(score(exercise(), perfect, Progress()).passed) << "no step was done";
  Progress late;
  late.begin_step(0, "only", "", 1);
  late.end_step(1, "timeout");
  EXPECT_FALSE(score(exercise(), perfect, late).passed);
  EXPECT_FALSE(score(exercise(), {{"hold.band.time_in_s", 20}}, finished()).total < 80);
  EXPECT_TRUE(score(exercise(), {{"hold.band.time_in_s", 20}}, finished()).passed) << "80 is the pass mark";
  EXPECT_FALSE(score(exercise(), {{"hold.band.time_in_s", 17}}, finished()).passed);
}

TEST(Scoring, AForcePartPointsAtTheTimesOfItsOwnInstrumentsOverforce) {
  ExerciseDefinition definition = exercise();
  definition.score.parts = {benchmark("left.peak_force_N", 8, 3, 1)};
  Progress progress = finished();
  progress.add_event(event(EventKind::overforce, 2, "left"));
  progress.add_event(event(EventKind::overforce, 5, "right"));
  EXPECT_EQ(score(definition, {{"left.peak_force_N", 9}}, progress).parts[0].times, (std::vector<double>{2}));
}

}  // namespace
}  // namespace calot
