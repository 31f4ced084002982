// Hands that achieve nothing earn nothing, in every shipped exercise that has a score.

#include <gtest/gtest.h>

#include <cmath>

#include "play/play.h"
#include "session/scoring.h"
#include "support/long_run.h"
#include "support/paths.h"

namespace calot {
namespace {

/// Turns all instruments about their ports and back, where they are: in the air.
class Waving final : public InputSource {
 public:
  /// `angle`: rad; nothing moves with 0.
  explicit Waving(double angle) : angle_(angle) {}

  Result<std::optional<StepInput>> next(const World& world, double dt) override {
    if (first_.empty())
      for (const InstrumentState& state : world.report().instruments) first_.push_back(state.pose);
    StepInput input;
    const double t = world.report().time + dt;
    for (std::size_t i = 0; i < first_.size(); ++i) {
      InstrumentPose& pose = input.instruments.emplace_back(first_[i]);
      if (world.report().instruments[i].waits) continue;
      pose.pitch += angle_ * std::sin(2 * t);
      pose.yaw += angle_ * (std::cos(3 * t) - 1);
    }
    return std::optional(input);
  }

 private:
  double angle_;
  std::vector<InstrumentPose> first_;
};

struct Idle {
  std::string scenario;
  std::map<std::string, std::string> params = {};
  bool takes_minutes = false;
};

class IdleHands : public ::testing::TestWithParam<Idle> {};
INSTANTIATE_TEST_SUITE_P(Shipped, IdleHands,
                         ::testing::Values(Idle{"grasp_and_traction"}, Idle{"liver_edge"},
                                           Idle{"camera_navigation", {}, true}, Idle{"bleeding_control"},
                                           Idle{"peg_transfer"}, Idle{"clip_and_divide"}, Idle{"exposure"},
                                           Idle{"clip_and_divide", {{"structure", "cystic_artery"}}, true},
                                           Idle{"dissect_to_critical_view", {}, true},
                                           Idle{"critical_view", {}, true}, Idle{"liver_bed", {}, true},
                                           Idle{"fundus_first", {}, true}));

void expect_nothing(const Idle& idle, double angle) {
  PlayRequest request;
  request.scenario = source_dir() + "/scenarios/" + idle.scenario + ".lua";
  request.params = idle.params;
  const Result<std::unique_ptr<ExerciseScript>> script = load_scenario(request);
  ASSERT_TRUE(script) << to_text(script.failure());
  const ExerciseDefinition& exercise = script.value()->definition();
  Result<World> world = World::create(exercise.scene, nullptr, 1);
  ASSERT_TRUE(world) << to_text(world.failure());
  Waving hands(angle);
  const SessionResult session = run_session(world.value(), *script.value(), hands, {});
  ASSERT_TRUE(session.end == SessionEnd::steps_done || session.end == SessionEnd::time_limit)
      << to_text(session.failure);
  EXPECT_GT(session.traces.time.back(), 0.5 * exercise.time_limit) << "no step ended by waiting for it";
  for (const SessionEvent& event : session.progress.events())
    EXPECT_NE(event.kind, EventKind::contact) << event.instrument << " is not in the air";
  const Result<Score> scored = score(exercise, session.metrics, session.progress);
  ASSERT_TRUE(scored) << to_text(scored.failure());
  EXPECT_EQ(scored->total, 0);
  EXPECT_EQ(scored->steps_done, 0u);
  EXPECT_EQ(scored->outcome, AttemptOutcome::unfinished);
  EXPECT_EQ(scored->missing, exercise.step_names);
  const Result<Score> at_once = score(exercise, {}, Progress());
  ASSERT_TRUE(at_once) << to_text(at_once.failure());
  EXPECT_EQ(at_once->total, 0) << "an end at once";
}

TEST_P(IdleHands, ThatWaveInTheAirEarnNothing) {
  if (GetParam().takes_minutes && !test::long_run()) GTEST_SKIP() << "takes minutes";
  expect_nothing(GetParam(), 0.03);
}

TEST_P(IdleHands, ThatDoNothingEarnNothing) {
  if (!test::long_run()) GTEST_SKIP() << "waits for minutes, as waving hands do";
  expect_nothing(GetParam(), 0);
}

}  // namespace
}  // namespace calot
