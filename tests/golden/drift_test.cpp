// Where bits cannot be equal, what became of a session decides of the frames that drifted, and of no others.

#include <gtest/gtest.h>

#include <filesystem>

#include "goldens/session_judge.h"
#include "support/paths.h"
#include "support/text_files.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

constexpr Course expert{.score = 99, .steps_done = 4, .errors = 1};

/// A frame of 16 x 16 pixels at a time, s.
Frame drawn(double time, unsigned char level) {
  Frame frame;
  frame.time = time;
  frame.state_hash = level;
  frame.image.width = frame.image.height = 16;
  frame.image.rgb.assign(3 * 16 * 16, level);
  return frame;
}

/// A black golden of a build for other processors.
Golden from_elsewhere(double time) {
  Golden golden = make_golden(drawn(time, 0));
  golden.sidecar.make.instruction_set = "another one";
  golden.sidecar.course = expert;
  return golden;
}

SessionResult ended(SessionEnd end) {
  SessionResult session;
  session.end = end;
  return session;
}

/// A frame that has drifted, judged by what became of its session.
Judgement drifted(const Course& here, SessionEnd end = SessionEnd::steps_done) {
  const Golden golden = from_elsewhere(1);
  Judgement judgement = judge(golden, make_golden(drawn(1, 200)));
  EXPECT_EQ(judgement.verdict, Verdict::drifted);
  EXPECT_FALSE(judgement.passed) << "nothing is known of the session yet";
  judge_course(judgement, golden.sidecar.course, here, ended(end));
  return judgement;
}

TEST(Drift, PassesWhereTheSessionTookTheGoldensCourse) {
  EXPECT_TRUE(drifted(expert).passed);
  const Judgement judgement = drifted({.score = 97.5, .steps_done = 4, .errors = 0});
  EXPECT_TRUE(judgement.passed);
  EXPECT_EQ(judgement.verdict, Verdict::drifted);
  for (const char* said :
       {"here 97.5 points, steps done: 4, errors: 0", "golden 99.0 points, steps done: 4, errors: 1",
        "256 pixels differ", "another one"})
    EXPECT_NE(judgement.message.find(said), std::string::npos) << judgement.message;
}

TEST(Drift, FailsWhereTheSessionDidOtherStepsOrMadeMoreErrors) {
  EXPECT_FALSE(drifted({.score = 99, .steps_done = 3, .errors = 1}).passed);
  EXPECT_FALSE(drifted({.score = 99, .steps_done = 5, .errors = 1}).passed);
  EXPECT_FALSE(drifted({.score = 99, .steps_done = 4, .errors = 2}).passed);
}

TEST(Drift, FailsWhereTheScoreIsMoreThanTwoPointsOff) {
  EXPECT_TRUE(drifted({.score = 97, .steps_done = 4, .errors = 1}).passed);
  EXPECT_FALSE(drifted({.score = 96, .steps_done = 4, .errors = 1}).passed);
  EXPECT_FALSE(same_course({.score = 90}, {.score = 93}));
}

TEST(Drift, PassesWithoutAScoreOnlyWhereTheGoldenHasNone) {
  EXPECT_TRUE(same_course({}, {}));
  EXPECT_FALSE(same_course({.score = 0}, {}));
  EXPECT_FALSE(same_course({}, {.score = 0}));
}

TEST(Drift, FailsWhereTheSessionDidNotEndByItsSteps) {
  for (const SessionEnd end : {SessionEnd::time_limit, SessionEnd::source_ended, SessionEnd::interrupted,
                               SessionEnd::failed, SessionEnd::bailed_out}) {
    const Judgement judgement = drifted(expert, end);
    EXPECT_FALSE(judgement.passed) << to_text(end);
    EXPECT_NE(judgement.message.find("(ended as " + to_text(end)), std::string::npos) << judgement.message;
  }
}

TEST(Drift, IsNotWhereBitsAreEqualOrNothingHasMovedOrThePictureHasAnotherSize) {
  Golden equal_bits = from_elsewhere(1);
  equal_bits.sidecar.make = this_make();
  EXPECT_EQ(judge(equal_bits, make_golden(drawn(1, 200))).verdict, Verdict::physics_changed);
  EXPECT_EQ(judge(from_elsewhere(0), make_golden(drawn(0, 200))).verdict, Verdict::physics_changed);
  Golden larger = from_elsewhere(1);
  larger.image.height = 17;
  larger.image.rgb.resize(3 * 16 * 17);
  EXPECT_EQ(judge(larger, make_golden(drawn(1, 200))).verdict, Verdict::physics_changed);
  EXPECT_EQ(judge(from_elsewhere(1), make_golden(drawn(1, 2))).verdict, Verdict::same_picture);
  EXPECT_EQ(judge(from_elsewhere(1), make_golden(drawn(1, 0))).verdict, Verdict::same);
}

/// Goldens of a session that ends after 2 s, where frames are declared at 0, 1 and 3 s.
class DriftedSession : public ::testing::Test {
 protected:
  void SetUp() override {
    played_.exercise.golden.at = {0, 1, 3};
    played_.report.score.parts.resize(1);
    played_.report.score.total = *expert.score;
    played_.report.score.steps_done = static_cast<std::size_t>(expert.steps_done);
    const WorldEvent dropped{.kind = EventKind::clip_dropped};
    ASSERT_TRUE(event_row(dropped.kind).error);
    played_.session.progress.add_event(dropped);
  }

  void store(const std::string& name, const Golden& golden) {
    ASSERT_TRUE(write_golden(folder_ / name, golden));
  }
  /// Draws the first two frames, the second with another picture, and ends the session.
  void play() {
    SessionJudge judge("small", folder_, {"t000.00s", "t001.00s", "t003.00s"},
                       [&](const GoldenResult& result) { results_.push_back(result); });
    Frame rest = drawn(0, 0), moved = drawn(1, 200);
    rest.name = "t000.00s";
    moved.name = "t001.00s";
    judge.see(rest);
    judge.see(moved);
    judged_before_the_end_ = results_.size();
    judge.end(played_);
  }

  const test::Folder home_;
  const fs::path folder_ = home_.path();
  Played played_;
  std::vector<GoldenResult> results_;
  std::size_t judged_before_the_end_ = 0;
};

TEST_F(DriftedSession, DecidesWhenItHasEndedOfWhatDriftedAndOfWhatItDidNotReach) {
  store("t000.00s", from_elsewhere(0));
  store("t001.00s", from_elsewhere(1));
  store("t003.00s", from_elsewhere(3));
  play();
  EXPECT_EQ(judged_before_the_end_, 1u) << "a frame that has not drifted does not wait";
  ASSERT_EQ(results_.size(), 3u);
  const Verdict expected[] = {Verdict::same, Verdict::drifted, Verdict::drifted};
  for (std::size_t i = 0; i < results_.size(); ++i) {
    EXPECT_EQ(results_[i].judgement.verdict, expected[i]) << results_[i].frame;
    EXPECT_TRUE(results_[i].judgement.passed) << results_[i].frame << ": " << results_[i].judgement.message;
  }
  EXPECT_NE(results_[2].judgement.message.find("ended before this picture"), std::string::npos);
  results_.clear();
  played_.session.progress.add_event({.kind = EventKind::clip_dropped});
  play();
  ASSERT_EQ(results_.size(), 3u);
  EXPECT_TRUE(results_[0].judgement.passed);
  EXPECT_FALSE(results_[1].judgement.passed) << "one error more";
  EXPECT_FALSE(results_[2].judgement.passed) << "one error more";
}

TEST_F(DriftedSession, ExcusesNoFrameThatItDidNotReachWithTheSameBits) {
  Golden unreached = from_elsewhere(3);
  unreached.sidecar.make = this_make();
  store("t003.00s", unreached);
  play();
  ASSERT_EQ(results_.size(), 3u);
  EXPECT_EQ(results_[2].judgement.verdict, Verdict::not_played);
  EXPECT_FALSE(results_[2].judgement.passed);
}

}  // namespace
}  // namespace calot
