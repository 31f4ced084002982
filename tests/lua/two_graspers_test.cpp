// Two graspers that close on one fold press with their pinch each, whichever is named, and so balanced, first.

#include "lua/played_text.h"
#include "support/long_run.h"

namespace calot {
namespace {

/// Two graspers close side by side on the fundus: `a` from the patient's right and `b` from the left, or the other way round.
test::ScenarioText both_close() {
  test::ScenarioText text;
  text.params = "{ swapped = { type = 'boolean', default = false } }";
  text.scene =
      "local right = { type = 'atraumatic_grasper', port = 'right_subcostal', pinch_force = 1 * N }\n"
      "local left = { type = 'atraumatic_grasper', port = 'left_upper', pinch_force = 1 * N }\n"
      "return { anatomy = calot.anatomy('standard'), laparoscope = { look_at = 'gallbladder.fundus' },\n"
      " instruments = p.swapped and { a = left, b = right } or { a = right, b = left },\n"
      " solver = { motion = 'dynamic', rate = 25, extensions = { levels = 1 } } }";
  const std::string named = "local right, left = t.a, t.b if p.swapped then right, left = left, right end\n";
  text.steps =
      named +
      "t:step('close', 'Close on the fundus')\n"
      "t:wait_until(function() return right:holds('gallbladder') and left:holds('gallbladder') end)\n"
      "t:wait(0.6 * s)\n"
      "t:note('right', right:force('jaws')) t:note('left', left:force('jaws'))\n"
      "for i, axis in ipairs { 'x', 'y', 'z' } do\n"
      "  t:note(axis, t:place('gallbladder.fundus')[i] / mm)\n"
      "end";
  text.demo =
      named +
      "local function grasp(hand, side)\n"
      "  hand:approach('gallbladder.fundus', { offset = { side * 5 * mm, 0, 0 }, speed = 40 * mm / s })\n"
      "end\n"
      "t:together(function() grasp(right, -1) end, function() grasp(left, 1) end)\n"
      "t:together(function() right:close() end, function() left:close() end)";
  return text;
}

/// The most angles of jaws that a step tried: one at each halt of theirs, unless they met their pinch.
int most_trials(const std::vector<ProfiledStep>& profile) {
  int out = 0;
  for (const ProfiledStep& step : profile)
    for (const auto& [tool, trials] : step.statistics.jaw_trials) out = std::max(out, trials);
  return out;
}

TEST(TwoGraspers, OnOneFoldFindOneAnswerWhicheverIsNamedFirst) {
  CALOT_SLOW_WHEN_SANITIZED("two sessions with jaws that press");
  test::PlayedText played[2];
  for (const bool swapped : {false, true}) {
    std::vector<ProfiledStep> profile;
    SessionOptions options;
    options.profile = &profile;
    ASSERT_NO_FATAL_FAILURE(
        test::play_text(both_close(), played[swapped], options, {{"swapped", swapped ? "true" : "false"}}));
    EXPECT_GT(most_trials(profile), 5) << "else no pinch was met";
  }
  for (const char* hand : {"right", "left"}) {
    const double force = played[0].noted(hand);
    EXPECT_GT(force, 0.5) << hand << " N: it presses";
    EXPECT_NEAR(played[1].noted(hand), force, 0.04 * force) << hand << ": each meets its pinch within 2%";
  }
  for (const char* axis : {"x", "y", "z"})
    EXPECT_NEAR(played[1].noted(axis), played[0].noted(axis), 0.1) << axis << " of the fundus, mm";
}

}  // namespace
}  // namespace calot
