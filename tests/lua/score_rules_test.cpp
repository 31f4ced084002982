// An author's own rules: what they see and answer, and that no mistake in one goes unsaid.

#include <gmock/gmock.h>

#include <limits>

#include "lua/scenario_files.h"
#include "session/scoring.h"

namespace calot {
namespace {

using test::Folder;
using test::line_of;
using test::ScenarioText;
using testing::ElementsAre;
using testing::HasSubstr;

/// A score of one rule, with this body.
ScenarioText ruled(const std::string& body, const std::string& head = "") {
  ScenarioText text;
  text.head = head;
  text.params = "{ hard = { type = 'boolean', default = true } }";
  text.steps = "t:step('look', 'Look') t:note('views', 3)";
  text.score = "calot.score.weighted { { calot.score.rule(function(run)\n" + body +
               "\nend), name = 'own', weight = 1 } }";
  return text;
}

/// A cut at 2 s before a clip at 3 s.
Progress cut_then_clip() {
  Progress progress;
  progress.begin_step(0, "look", "", {0});
  progress.add_event(
      {EventKind::cut, 2, "blades", "gallbladder.patient", 0.5, Vec3(1, 2, 3), EventCause::blades});
  progress.add_event({EventKind::clip, 3, "applier", "gallbladder", 0});
  progress.add_note({4, "", "views", 3.0, ""});
  progress.end_step(5, "done");
  return progress;
}

struct Ruled {
  Folder folder;
  std::unique_ptr<ExerciseScript> script;
  explicit Ruled(const ScenarioText& text, const std::map<std::string, std::string>& modules = {}) {
    for (const auto& [name, source] : modules) folder.write(name, source);
    Result<std::unique_ptr<ExerciseScript>> loaded = test::load_text(folder, text.text());
    EXPECT_TRUE(loaded) << to_text(loaded.failure());
    if (loaded) script = std::move(loaded).value();
  }
  Result<Score> judged(const Progress& progress = cut_then_clip()) const {
    std::map<std::string, double> metrics = progress.metrics();
    metrics["total.time_s"] = 5;
    return score(script->definition(), metrics, progress);
  }
};

std::string answered(const std::string& body) {
  const Ruled exercise(ruled(body));
  if (!exercise.script) return "not loaded";
  const Result<Score> score = exercise.judged();
  if (!score) return to_text(score.failure());
  return fmt::format("{:g} {}", score->parts.at(0).fraction, score->parts.at(0).explanation);
}

TEST(ScoreRules, GiveTheShareTheReasonAndTheTimesBehindIt) {
  const Ruled exercise(
      ruled("local cuts, clips = run:times('cut'), run:times('clip')\n"
            "if #cuts > 0 and cuts[1] < (clips[1] or math.huge) then\n"
            "  return 0.25, 'it was cut before it was clipped', { clips[1], cuts[1] } end\n"
            "return 1, 'clips came first'"));
  const Result<Score> wrong = exercise.judged();
  ASSERT_TRUE(wrong) << to_text(wrong.failure());
  EXPECT_EQ(wrong->total, 25);
  EXPECT_EQ(wrong->parts[0].explanation, "it was cut before it was clipped");
  EXPECT_EQ(wrong->parts[0].times, (std::vector<double>{2, 3}));
  Progress right;
  right.add_event({EventKind::clip, 3, "applier", "gallbladder", 0});
  EXPECT_EQ(exercise.judged(right)->total, 100);
}

TEST(ScoreRules, SeeEventsStepsMetricsNotesAndParameters) {
  EXPECT_EQ(
      answered(
          "local e = run.events[1]\n"
          "assert(e.event == 'cut' and e.time == 2 and e.instrument == 'blades' and e.value == 0.5)\n"
          "assert(e.place[2] == 2 and e.cause == 'scissors' and e.step == 'look' and e.text == nil)\n"
          "assert(run:count('cut', 'gallbladder') == 1 and run:count('clip', 'gallbladder.specimen') == 0)\n"
          "assert(run.steps[1].name == 'look' and run.steps[1].outcome == 'done')\n"
          "assert(run.metrics['total.time_s'] == 5 and run.metrics['left.grasps'] == nil)\n"
          "assert(run.notes.views == 3 and run.params.hard == true)\n"
          "return 1, 'all of it'"),
      "1 all of it");
}

TEST(ScoreRules, AreAskedInAStateOfTheirOwnAndAnswerTheSameEachTime) {
  const Ruled exercise(
      ruled("calls = calls + 1\nreturn calls / 10, tostring(math.random())", "local calls = 0"));
  const Result<Score> one = exercise.judged(), two = exercise.judged();
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->total, 10);
  EXPECT_EQ(two->total, 10) << "nothing is left of what it did before";
  EXPECT_EQ(one->parts[0].explanation, two->parts[0].explanation);
}

TEST(ScoreRules, CannotReachTheWorldThatTheStepsSaw) {
  ScenarioText text = ruled("return 1, type(saved.t)", "local saved = {}");
  text.steps += "\nsaved.t = t";
  EXPECT_EQ(Ruled(text).judged()->parts.at(0).explanation, "nil");
}

TEST(ScoreRules, AnErrorInOneIsReportedAtItsLine) {
  const ScenarioText text = ruled("local e = run.events[1]\nlocal x = e.time.hours\nreturn 1, 'x'");
  const Ruled exercise(text);
  const Result<Score> score = exercise.judged();
  ASSERT_FALSE(score);
  EXPECT_EQ(score.failure().kind, FailureKind::scenario);
  EXPECT_EQ(score.failure().problems.at(0).place.line, line_of(text.text(), "e.time.hours"));
  EXPECT_THAT(score.failure().problems[0].message, HasSubstr("index a number value"));
}

TEST(ScoreRules, AnAnswerThatIsNoneIsAnErrorAtTheRulesLine) {
  struct Wrong {
    std::string returned, said;
  };
  // Wrong only when something has happened: found when it is asked.
  for (const Wrong& wrong : {Wrong{"0 / 0, 'x'", "the share"},
                             {"1.5, 'x'", "the share 1.5, which is not within 0 and 1"},
                             {"-0.1, 'x'", "the share -0.1"},
                             {"'1', 'x'", "no share but string"},
                             {"1", "no reason"},
                             {"1, ''", "no reason"},
                             {"1, 'x', 3", "times that are number"},
                             {"1, 'x', { 1, -2 }", "a time, the 2."},
                             {"1, string.rep('x', 501)", "a reason of 501 bytes"}}) {
    const ScenarioText text =
        ruled("if run:count('cut') == 0 then return 1, 'nothing' end\nreturn " + wrong.returned);
    const Ruled exercise(text);
    ASSERT_TRUE(exercise.script) << wrong.returned;
    const Result<Score> score = exercise.judged();
    ASSERT_FALSE(score) << wrong.returned;
    EXPECT_EQ(score.failure().problems.at(0).place.line, line_of(text.text(), "score.rule"));
    EXPECT_THAT(score.failure().problems[0].message, HasSubstr(wrong.said));
  }
}

TEST(ScoreRules, ALoopWithoutEndIsAResourceFailureAtItsLine) {
  const ScenarioText text = ruled("if run:count('cut') > 0 then\nwhile true do end end\nreturn 1, 'x'");
  const Ruled exercise(text);
  const Result<Score> score = exercise.judged();
  ASSERT_FALSE(score);
  EXPECT_EQ(score.failure().kind, FailureKind::resource);
  EXPECT_EQ(score.failure().problems.at(0).place.line, line_of(text.text(), "while true"));
}

// Authors write on while a demo plays.
TEST(ScoreRules, AreThoseThatWereReadWhateverBecomesOfTheirFiles) {
  const std::map<std::string, std::string> modules{{"share.lua", "return 0.25"}, {"more.lua", "return 0.5"}};
  const Ruled exercise(ruled("return share + require('more'), 'as it was'", "local share = require 'share'"),
                       modules);
  exercise.folder.write("test.lua", ruled("return 1, 'y'").text());
  for (const auto& module : modules) std::filesystem::remove(exercise.folder.write(module.first, "return 1"));
  const Result<Score> judged = exercise.judged();
  ASSERT_TRUE(judged) << to_text(judged.failure());
  EXPECT_EQ(judged->total, 75);
  EXPECT_EQ(judged->parts.at(0).explanation, "as it was");
}

}  // namespace
}  // namespace calot
