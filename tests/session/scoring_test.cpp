#include "session/scoring.h"

#include <gmock/gmock.h>

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

/// Of an exercise without rules, whose score cannot fail.
Score scored(const ExerciseDefinition& exercise, const std::map<std::string, double>& metrics,
             const Progress& progress) {
  return score(exercise, metrics, progress).value();
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
  progress.begin_step(0, "only", "", {0});
  progress.end_step(9, "done");
  return progress;
}

TEST(Scoring, EachPartIsItsShareOfTheWayFromNoviceToExpert) {
  // F2: 100 sum w clamp((N - m) / (N - E)); penalties 1 - each n.
  Progress progress = finished();
  progress.add_event(event(EventKind::overforce, 2));
  const Score result =
      scored(exercise(), {{"hold.band.time_in_s", 15}, {"left.path_length_mm", 190}}, progress);
  EXPECT_NEAR(result.parts[0].points, 100 * 0.5 * (6.0 - 15) / (6 - 18), 1e-12);
  EXPECT_NEAR(result.parts[1].points, 100 * 0.2 * (400.0 - 190) / (400 - 120), 1e-12);
  EXPECT_NEAR(result.parts[2].points, 100 * 0.3 * 0.75, 1e-12);
  EXPECT_NEAR(result.total, result.parts[0].points + result.parts[1].points + result.parts[2].points, 1e-12);
}

TEST(Scoring, BeyondTheBenchmarksNothingIsGainedOrLost) {
  for (const auto& [hold, path, expected] :
       {std::tuple{30.0, 50.0, 100.0}, std::tuple{0.0, 900.0, 30.0}, std::tuple{18.0, 120.0, 100.0}}) {
    const Score result =
        scored(exercise(), {{"hold.band.time_in_s", hold}, {"left.path_length_mm", path}}, finished());
    EXPECT_NEAR(result.total, expected, 1e-12);
  }
}

TEST(Scoring, ANovicesVeryValueEarnsZeroNotMinusZero) {
  const Score result = scored(exercise(), {{"hold.band.time_in_s", 6}}, finished());
  EXPECT_EQ(result.parts[0].points, 0);
  EXPECT_FALSE(std::signbit(result.parts[0].points));
}

TEST(Scoring, AValueThatMissesABenchmarkByLittleDoesNotReadAsIfItWereThatBenchmark) {
  // Seconds in the band that are one rounding, or 0.4 ms, short of the expert's.
  const auto explained = [](double hold) {
    return scored(exercise(), {{"hold.band.time_in_s", hold}}, finished()).parts[0].explanation;
  };
  EXPECT_EQ(explained(17.9996),
            "hold.band.time_in_s = 17.9996, between novice 6 (no points) and expert 18 (all points)");
  EXPECT_EQ(explained(18 - 1e-12), "hold.band.time_in_s = 18, as good as expert 18");
  EXPECT_EQ(explained(6 + 1e-12), "hold.band.time_in_s = 6, no better than novice 6");
}

TEST(Scoring, WhatWasNeverMeasuredEarnsNothingAndSaysSo) {
  const Score result = scored(exercise(), {{"left.path_length_mm", 100}}, Progress());
  EXPECT_FALSE(result.parts[0].measured);
  EXPECT_EQ(result.parts[0].points, 0);
  EXPECT_NE(result.parts[0].explanation.find("never measured"), std::string::npos);
  EXPECT_FALSE(result.completed);
}

TEST(Scoring, APenaltyNeverCostsMoreThanItsPart) {
  Progress progress = finished();
  for (int i = 0; i < 9; ++i) progress.add_event(event(EventKind::overforce, i));
  const Score result = scored(exercise(), {}, progress);
  EXPECT_EQ(result.parts[2].points, 0);
  EXPECT_EQ(*result.parts[2].measured, 9);
  EXPECT_EQ(result.parts[2].times, (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(Scoring, ACriticalEventCapsTheTotalAndFailsTheExercise) {
  const std::map<std::string, double> perfect{{"hold.band.time_in_s", 20}, {"left.path_length_mm", 100}};
  EXPECT_TRUE(scored(exercise(), perfect, finished()).passed());
  Progress progress = finished();
  progress.add_event(event(EventKind::overstretch, 3.5, ""));
  const Score result = scored(exercise(), perfect, progress);
  EXPECT_EQ(result.total, 40);
  EXPECT_EQ(result.uncapped, 100);
  EXPECT_FALSE(result.passed());
  ASSERT_EQ(result.gates.size(), 1u);
  EXPECT_EQ(result.gates[0].critical, EventKind::overstretch);
  EXPECT_EQ(result.gates[0].times, (std::vector<double>{3.5}));
}

TEST(Scoring, ALowTotalIsNotRaisedToTheCap) {
  Progress progress = finished();
  progress.add_event(event(EventKind::overstretch, 3.5, ""));
  for (int i = 0; i < 4; ++i) progress.add_event(event(EventKind::overforce, i));
  EXPECT_EQ(scored(exercise(), {}, progress).total, 0);
}

TEST(Scoring, PassingTakesEveryDeclaredStepAndThePassMark) {
  const std::map<std::string, double> perfect{{"hold.band.time_in_s", 20}, {"left.path_length_mm", 100}};
  EXPECT_FALSE(scored(exercise(), perfect, Progress()).passed()) << "no step was done";
  Progress late;
  late.begin_step(0, "only", "", {1});
  late.end_step(1, "timeout");
  EXPECT_FALSE(scored(exercise(), perfect, late).passed());
  EXPECT_FALSE(scored(exercise(), {{"hold.band.time_in_s", 20}}, finished()).total < 80);
  EXPECT_TRUE(scored(exercise(), {{"hold.band.time_in_s", 20}}, finished()).passed())
      << "80 is the pass mark";
  EXPECT_FALSE(scored(exercise(), {{"hold.band.time_in_s", 17}}, finished()).passed());
}

TEST(Scoring, AForcePartPointsAtTheTimesOfItsOwnInstrumentsOverforce) {
  ExerciseDefinition definition = exercise();
  definition.score.parts = {benchmark("left.peak_jaws_force_N", 8, 3, 1)};
  Progress progress = finished();
  progress.add_event(event(EventKind::overforce, 2, "left"));
  progress.add_event(event(EventKind::overforce, 5, "right"));
  EXPECT_EQ(scored(definition, {{"left.peak_jaws_force_N", 9}}, progress).parts[0].times,
            (std::vector<double>{2}));
}

// ---- gates

ExerciseDefinition gated(GateDefinition gate) {
  ExerciseDefinition definition = exercise();
  gate.reason = "because";
  definition.score.gates = {std::move(gate)};
  return definition;
}

GateDefinition gate_on(const std::string& event) {
  GateDefinition gate;
  gate.event = event;
  return gate;
}

WorldEvent on_organ(EventKind kind, double time, const std::string& organ) {
  WorldEvent result = event(kind, time);
  result.organ = organ;
  return result;
}

const std::map<std::string, double> perfect_metrics{{"hold.band.time_in_s", 20},
                                                    {"left.path_length_mm", 100}};

TEST(Gates, AnEventCapsTheTotalForTheReasonThatTheAuthorGives) {
  GateDefinition gate = gate_on("cut");
  gate.organ = "common_duct";
  gate.cap = 25;
  Progress progress = finished();
  progress.add_event(on_organ(EventKind::cut, 2, "cystic_duct"));
  EXPECT_TRUE(scored(gated(gate), perfect_metrics, progress).passed()) << "of another organ";
  progress.add_event(on_organ(EventKind::cut, 3, "common_duct.patient"));
  const Score result = scored(gated(gate), perfect_metrics, progress);
  EXPECT_EQ(result.total, 25);
  EXPECT_EQ(result.uncapped, 100);
  EXPECT_FALSE(result.passed());
  ASSERT_NE(failing_gate(result), nullptr);
  EXPECT_EQ(failing_gate(result)->reason, "because");
  EXPECT_EQ(failing_gate(result)->explanation, "1 x cut of common_duct");
  EXPECT_EQ(failing_gate(result)->times, (std::vector<double>{3}));
}

TEST(Gates, AnActBeforeTheOneThatShouldComeFirstIsFoundInTheOrderOfEvents) {
  GateDefinition gate = gate_on("cut");
  gate.only_after = "clip";
  gate.after_organ = "duct";
  Progress right = finished(), wrong = finished();
  right.add_event(on_organ(EventKind::clip, 2, "duct"));
  right.add_event(on_organ(EventKind::cut, 2, "duct"));
  EXPECT_TRUE(scored(gated(gate), perfect_metrics, right).passed()) << "in one step, but in this order";
  wrong.add_event(on_organ(EventKind::clip, 1, "artery"));
  wrong.add_event(on_organ(EventKind::cut, 2, "duct"));
  wrong.add_event(on_organ(EventKind::clip, 3, "duct"));
  wrong.add_event(on_organ(EventKind::cut, 4, "duct"));
  const Score result = scored(gated(gate), perfect_metrics, wrong);
  EXPECT_EQ(result.total, 40);
  ASSERT_EQ(result.gates.size(), 1u);
  EXPECT_EQ(result.gates[0].times, (std::vector<double>{2})) << "the cut after the clip is none";
  EXPECT_EQ(result.gates[0].explanation, "1 x cut, and no clip of duct before");
}

TEST(Gates, AMetricBeyondItsValueOrNeverMeasuredCountsWithItsEventUnlessThatIsExcused) {
  GateDefinition gate = gate_on("cut");
  gate.metric = "note.critical_view_points";
  gate.below = 5;
  gate.unless = "bail_out";
  std::map<std::string, double> metrics = perfect_metrics;
  Progress progress = finished();
  EXPECT_TRUE(scored(gated(gate), metrics, progress).passed()) << "nothing was cut";
  progress.add_event(on_organ(EventKind::cut, 2, "duct"));
  EXPECT_EQ(scored(gated(gate), metrics, progress).gates.at(0).explanation,
            "1 x cut; note.critical_view_points was never measured");
  metrics[gate.metric] = 4;
  EXPECT_EQ(scored(gated(gate), metrics, progress).gates.at(0).explanation,
            "1 x cut; note.critical_view_points = 4, below 5");
  metrics[gate.metric] = 5;
  EXPECT_TRUE(scored(gated(gate), metrics, progress).passed()) << "5 is not below 5";
  metrics[gate.metric] = 4;
  progress.add_event(event(EventKind::bail_out, 3, ""));
  EXPECT_TRUE(scored(gated(gate), metrics, progress).passed());
  gate = {};
  gate.metric = "left.path_length_mm";
  gate.above = 90;
  EXPECT_FALSE(scored(gated(gate), perfect_metrics, finished()).passed());
}

TEST(Gates, ThatOnlyCapDoNotFailAndComeLast) {
  GateDefinition gate = gate_on("slip");
  gate.fails = false;
  gate.cap = 85;
  ExerciseDefinition definition = gated(gate);
  Progress progress = finished();
  progress.add_event(event(EventKind::slip, 1));
  Score result = scored(definition, perfect_metrics, progress);
  EXPECT_EQ(result.total, 85);
  EXPECT_TRUE(result.passed());
  definition.score.gates.push_back(gate_on("cut"));
  progress.add_event(on_organ(EventKind::cut, 2, "duct"));
  result = scored(definition, perfect_metrics, progress);
  ASSERT_EQ(result.gates.size(), 2u);
  EXPECT_EQ(result.gates[0].event, "cut");
  EXPECT_EQ(result.total, 40);
}

// ---- other families

ScoredPart part_of(const ScorePart& part, const std::map<std::string, double>& metrics,
                   const Progress& progress) {
  ExerciseDefinition definition = test::small_exercise();
  definition.step_names = {"clip", "divide"};
  definition.score.parts = {part};
  return scored(definition, metrics, progress).parts.at(0);
}

/// Of part_of's exercise.
Progress both_done() {
  Progress progress;
  progress.begin_step(0, "clip", "", {0});
  progress.begin_step(4, "divide", "", {0});
  progress.end_step(5, "done");
  return progress;
}

TEST(Scoring, AProcedureEarnsItsStepsLessErrorsByTheirSeverity) {
  // F3: S = max(0, 100 earned / total - sum s_i n_i), minor 2, major 10.
  ScorePart part;
  part.kind = ScorePartKind::procedure;
  part.minor = {EventKind::slip, EventKind::empty_cut};
  part.major = {EventKind::perforation};
  Progress progress;
  progress.begin_step(0, "clip", "", {0});
  progress.end_step(4, "done");
  progress.begin_step(4, "divide", "", {1});
  progress.end_step(5, "timeout");
  EXPECT_DOUBLE_EQ(part_of(part, {}, progress).fraction, 0.5);
  EXPECT_EQ(part_of(part, {}, progress).explanation, "1 of 2 steps done (not divide), no errors");
  for (const double time : {3.0, 1.0}) progress.add_event(event(EventKind::slip, time));
  progress.add_event(event(EventKind::perforation, 2));
  const ScoredPart scored_part = part_of(part, {}, progress);
  EXPECT_DOUBLE_EQ(scored_part.fraction, 0.5 - 0.02 * 2 - 0.1);
  EXPECT_EQ(scored_part.times, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(scored_part.explanation,
            "1 of 2 steps done (not divide), less 14 points; minor, 2 each: 2 x slip; major, 10 each: 1 x "
            "perforation");
  for (int i = 0; i < 9; ++i) progress.add_event(event(EventKind::perforation, 6));
  EXPECT_EQ(part_of(part, {}, progress).fraction, 0);
  part.steps = {"clip"};
  part.major.clear();
  EXPECT_DOUBLE_EQ(part_of(part, {}, progress).fraction, 1 - 0.04) << "only what it names earns";
}

TEST(Scoring, TimeIsLengthenedByErrorsBetweenTheLimitAndTheReference) {
  // F1: clamp((Tmax - T - sum p n) / (Tmax - Tref), 0, 1).
  ScorePart part;
  part.kind = ScorePartKind::time;
  part.reference = 60;
  part.limit = 300;
  part.errors = {EventKind::clip_dropped};
  part.each_s = 20;
  Progress progress = both_done();
  EXPECT_DOUBLE_EQ(part_of(part, {{"total.time_s", 120}}, progress).fraction, 180.0 / 240);
  EXPECT_EQ(part_of(part, {{"total.time_s", 50}}, progress).fraction, 1);
  EXPECT_EQ(part_of(part, {{"total.time_s", 300}}, progress).fraction, 0);
  progress.add_event(event(EventKind::clip_dropped, 2));
  EXPECT_DOUBLE_EQ(part_of(part, {{"total.time_s", 120}}, progress).fraction, 160.0 / 240);
  EXPECT_EQ(part_of(part, {}, progress).explanation, "total.time_s was never measured in this session");
}

TEST(Scoring, TheCriticalViewEarnsItsPointsAndSaysWhetherItIsOne) {
  ScorePart part;
  part.kind = ScorePartKind::critical_view;
  part.metric = "note.critical_view_points";
  Progress progress = both_done();
  progress.add_note({7, "", "critical_view_points", 5.0, ""});
  const ScoredPart five = part_of(part, progress.metrics(), progress);
  EXPECT_DOUBLE_EQ(five.fraction, 5.0 / 6);
  EXPECT_EQ(five.explanation, "the critical view has 5 of 6 points: 5 is satisfactory, this is");
  EXPECT_EQ(five.times, (std::vector<double>{7}));
  EXPECT_THAT(part_of(part, {{part.metric, 4}}, progress).explanation, ::testing::EndsWith("this is not"));
  EXPECT_EQ(part_of(part, {}, progress).fraction, 0);
}

/// Rules as an author's script answers them.
class FixedRules : public ScoreRules {
 public:
  explicit FixedRules(Result<RuleAnswers> answer) : answer_(std::move(answer)) {}
  Result<RuleAnswers> judge(const ExerciseDefinition&, const std::map<std::string, double>&,
                            const Progress&) const override {
    return answer_;
  }

 private:
  Result<RuleAnswers> answer_;
};

TEST(Scoring, RulesGiveTheirPartsShareReasonAndTimesInTheirOrder) {
  ExerciseDefinition definition = exercise();
  ScorePart rule;
  rule.kind = ScorePartKind::rule;
  rule.weight = 0.5;
  definition.score.parts = {rule, benchmark("left.path_length_mm", 400, 120, 0), rule};
  definition.score.rules =
      std::make_shared<FixedRules>(RuleAnswers{{{0.25, "first", {1, 2}}, {1, "second", {}}}, {}});
  const Score result = scored(definition, {}, finished());
  EXPECT_EQ(result.total, 62.5);
  EXPECT_EQ(result.parts[0].explanation, "first");
  EXPECT_EQ(result.parts[0].times, (std::vector<double>{1, 2}));
  EXPECT_EQ(result.parts[2].explanation, "second");
  definition.score.rules = std::make_shared<FixedRules>(fail(FailureKind::scenario, "a rule's error"));
  EXPECT_FALSE(score(definition, {}, finished()));
}

TEST(Scoring, InApi1ABailOutCompletesWhereTheAuthorSaysSo) {
  ExerciseDefinition definition = exercise();
  definition.api = 1;
  Progress progress;
  progress.begin_step(0, "only", "", {0});
  progress.add_event(event(EventKind::bail_out, 3, ""));
  progress.end_step(3, "bail_out");
  EXPECT_FALSE(scored(definition, perfect_metrics, progress).passed());
  definition.score.bail_out_completes = true;
  EXPECT_TRUE(scored(definition, perfect_metrics, progress).passed());
  EXPECT_FALSE(scored(definition, perfect_metrics, Progress()).passed()) << "nobody bailed out";
}

/// Three steps, of which the second was running when a bail-out ended the session.
struct BailedOut {
  ExerciseDefinition definition = exercise();
  Progress progress;

  explicit BailedOut(bool right) {
    definition.step_names = {"first", "second", "third"};
    RuleAnswers answers;
    answers.bail_out = RuleAnswer{right ? 1.0 : 0.0, "so it is", {}};
    definition.score.rules = std::make_shared<FixedRules>(std::move(answers));
    progress.begin_step(0, "first", "", {0});
    progress.begin_step(2, "second", "", {0});
    progress.add_event(event(EventKind::bail_out, 3, ""));
    progress.end_step(3, "bail_out");
  }
};

TEST(Scoring, StepsThatARightBailOutLeftOutDoNotCount) {
  const BailedOut right(true);
  const Score result = scored(right.definition, perfect_metrics, right.progress);
  EXPECT_EQ(result.total, 100);
  EXPECT_EQ(result.outcome, AttemptOutcome::right_bail_out);
  EXPECT_TRUE(result.missing.empty());
  EXPECT_EQ(scored(right.definition, {}, right.progress).outcome, AttemptOutcome::below_mark)
      << "30 points of no error";
}

TEST(Scoring, AWrongBailOutLeavesTheExerciseUnfinishedAndSaysWhy) {
  const BailedOut wrong(false);
  const Score result = scored(wrong.definition, perfect_metrics, wrong.progress);
  EXPECT_NEAR(result.total, 100.0 / 3, 1e-12);
  EXPECT_EQ(result.outcome, AttemptOutcome::unfinished);
  EXPECT_EQ(result.missing, (std::vector<std::string>{"second", "third"}));
  EXPECT_THAT(verdict(result), ::testing::HasSubstr("so it is"));
}

TEST(Scoring, PartsEarnByTheShareOfTheirStepsThatWereDone) {
  ExerciseDefinition definition = exercise();
  definition.step_names = {"first", "second", "third", "fourth"};
  definition.score.parts[1].steps = {"first", "third"};
  definition.score.parts[2].steps = {"second"};
  Progress progress;
  progress.begin_step(0, "first", "", {0});
  progress.begin_step(1, "second", "", {0});
  progress.end_step(2, "timeout");
  progress.begin_step(2, "third", "", {0});
  progress.end_step(3, "missed", "it was too late");
  const Score result = scored(definition, perfect_metrics, progress);
  EXPECT_EQ(result.parts[0].done, 0.25) << "of all";
  EXPECT_EQ(result.parts[1].done, 0.5);
  EXPECT_EQ(result.parts[2].done, 0);
  EXPECT_NEAR(result.total, 100 * (0.5 / 4 + 0.2 / 2), 1e-12);
  EXPECT_THAT(result.parts[1].explanation, ::testing::HasSubstr("1 of 2 steps done (not third)"));
  EXPECT_EQ(result.outcome, AttemptOutcome::unfinished);
  definition.api = 1;
  EXPECT_EQ(scored(definition, perfect_metrics, progress).total, 100)
      << "as it was: whether steps were done or not";
}

TEST(Scoring, WhereNoStepIsAskedForNothingIsEarned) {
  ExerciseDefinition definition = exercise();
  definition.step_names.clear();
  EXPECT_EQ(scored(definition, perfect_metrics, Progress()).total, 0);
  EXPECT_EQ(scored(definition, perfect_metrics, finished()).total, 100)
      << "a step that was not known before counts";
}

TEST(Scoring, UnsafeIsUnsafeHoweverLittleWasDone) {
  Progress progress;
  progress.begin_step(0, "only", "", {0});
  progress.add_event(event(EventKind::overstretch, 1));
  Score result = scored(exercise(), perfect_metrics, progress);
  EXPECT_EQ(result.outcome, AttemptOutcome::unsafe);
  cut_short(result, false);
  EXPECT_EQ(result.outcome, AttemptOutcome::unsafe);
  EXPECT_GT(AttemptOutcome::unsafe, AttemptOutcome::unfinished) << "it stands below whoever was safe";
}

TEST(Scoring, ASessionThatWasCutIsUnfinishedAndOneWhoseSimulationFailedIsNotJudged) {
  Score cut = scored(exercise(), perfect_metrics, finished());
  ASSERT_EQ(cut.outcome, AttemptOutcome::passed);
  cut_short(cut, false);
  EXPECT_EQ(cut.outcome, AttemptOutcome::unfinished);
  EXPECT_FALSE(cut.completed);
  Score failed = scored(exercise(), perfect_metrics, finished());
  cut_short(failed, true);
  EXPECT_EQ(failed.outcome, AttemptOutcome::not_judged);
}

TEST(Scoring, AnExerciseWithoutAScoreIsNotJudged) {
  ExerciseDefinition definition = exercise();
  definition.score = {};
  EXPECT_EQ(scored(definition, {}, finished()).outcome, AttemptOutcome::not_judged);
}

}  // namespace
}  // namespace calot
