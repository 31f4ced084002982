// The field of liver_bed.lua: a gallbladder in its areolar plane, beside the stumps of duct and artery; and what becomes of
// it when it is free.

#include <gtest/gtest.h>

#include "lua/scenario_files.h"
#include "session/runner.h"
#include "sim/random_acts.h"
#include "support/long_run.h"

namespace calot {
namespace {

// Four seconds an act, and a suite has an hour.
TEST(BedField, ActsOfWhateverHandsAreFollowedOrSayWhy) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of steps of a whole field");
  LoadOptions options;
  options.modules = std::filesystem::path(source_dir()) / "scripts/lua";
  const auto loaded = load_exercise(source_dir() + "/scenarios/liver_bed.lua", options);
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  test::perform(loaded.value()->definition().scene, 11, test::cases(15, 700), 0.1);
}

/// A grasper takes a gallbladder's pouch, the assistant lets its fundus go, and nothing else holds it: the hand presses it
/// on the fat and the left lobe, and opens.
test::ScenarioText pressed_on_the_ground() {
  test::ScenarioText text;
  text.head = "local anatomy = require 'anatomy'\n";
  text.scene =
      "return { anatomy = anatomy.standard { without = { 'cystic_plate', 'triangle_fat', 'artery_fat', "
      "'hilar_fat',\n"
      "   'cystic_node', 'cystic_artery', 'cystic_duct', 'right_hepatic_artery' } },\n"
      " instruments = { left = { port = 'right_subcostal', pinch_force = 12 * N } },\n"
      " laparoscope = { look_at = 'gallbladder.infundibulum' }, solver = { motion = 'dynamic', rate = 25 } }";
  text.steps =
      "t:step('lay', 'Lay it down')\n"
      "t:wait_until(function() return t.left:holds('gallbladder') end)\nt:wait(0.4 * s)\n"
      "t:release('gallbladder', 'assistant')\n"
      "t:wait_until(function() return not t.left:holds('gallbladder') end)\nt:wait(2 * s)";
  text.demo =
      "t.left:approach('gallbladder.infundibulum', { speed = 60 * mm / s, depth = 7 * mm })\n"
      "t.left:close()\n"
      "t.left:move_by({ 0, 9 * mm, 42 * mm }, { speed = 30 * mm / s })\n"
      "t.left:move_to({ -60 * mm, 120 * mm, 0 }, { speed = 60 * mm / s })\n"
      "t.left:move_to({ 70 * mm, 140 * mm, -30 * mm }, { speed = 60 * mm / s })\n"
      "t.left:move_by({ 0, 0, -55 * mm }, { speed = 40 * mm / s })\n"
      "t.left:open()";
  return text;
}

// Without the core of self_barrier the field stands still for good, 1,000 off balance.
TEST(BedField, AGallbladderThatIsLetGoWhereItIsPressedOnTheGroundComesFree) {
  if (!test::long_run() || test::sanitized) GTEST_SKIP() << "left to scripts/test --long: most of a minute";
  const test::Folder folder;
  Result<std::unique_ptr<ExerciseScript>> script = test::load_text(folder, pressed_on_the_ground().text());
  ASSERT_TRUE(script) << to_text(script.failure());
  Result<World> world = World::create(script.value()->definition().scene);
  ASSERT_TRUE(world) << to_text(world.failure());
  std::vector<ProfiledStep> profile;
  SessionOptions options;
  options.profile = &profile;
  const SessionResult result = run_session(world.value(), *script.value(), script.value()->demo(), options);
  ASSERT_EQ(result.end, SessionEnd::steps_done) << to_text(result.failure);
  int in_a_row = 0, longest = 0;
  for (const ProfiledStep& step : profile) {
    in_a_row = step.statistics.balanced ? 0 : in_a_row + 1;
    longest = std::max(longest, in_a_row);
  }
  EXPECT_LE(longest, 5) << "steps in a row that end in no balance";
  EXPECT_EQ(in_a_row, 0) << "it is in balance in the end";
}

}  // namespace
}  // namespace calot
