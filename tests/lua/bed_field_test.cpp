// The field of liver_bed.lua: a gallbladder in its areolar plane, beside the stumps of duct and artery; and what becomes of
// it when it is free.

#include <gtest/gtest.h>

#include "lua/played_text.h"
#include "sim/random_acts.h"
#include "support/long_run.h"

namespace calot {
namespace {

/// Acts of random hands, in an order that the seed gives. A suite has an hour in scripts/test --long, in which 500 acts did
/// not come to their end: four suites.
void act_at_random(std::uint64_t seed) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of steps of a whole field");
  LoadOptions options;
  options.modules = std::filesystem::path(source_dir()) / "scripts/lua";
  const auto loaded = load_exercise(source_dir() + "/scenarios/liver_bed.lua", options);
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  test::perform(loaded.value()->definition().scene, seed, test::cases(3, 250), 0.1);
}
TEST(StandardBedActs, OfWhateverHandsAreFollowedOrSayWhy) { act_at_random(11); }
TEST(StandardBedActsInASecondOrder, OfWhateverHandsAreFollowedOrSayWhy) { act_at_random(12); }
TEST(StandardBedActsInAThirdOrder, OfWhateverHandsAreFollowedOrSayWhy) { act_at_random(13); }
TEST(StandardBedActsInAFourthOrder, OfWhateverHandsAreFollowedOrSayWhy) { act_at_random(14); }

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
  std::vector<ProfiledStep> profile;
  SessionOptions options;
  options.profile = &profile;
  test::PlayedText played;
  ASSERT_NO_FATAL_FAILURE(test::play_text(pressed_on_the_ground(), played, options));
  int in_a_row = 0, longest = 0;
  for (const ProfiledStep& step : profile) {
    in_a_row = step.statistics.balanced ? 0 : in_a_row + 1;
    longest = std::max(longest, in_a_row);
  }
  EXPECT_LE(longest, 5) << "steps in a row that end in no balance";
  EXPECT_EQ(in_a_row, 0) << "it is in balance in the end";
}

/// The assistant's grasper swings the fundus to the patient's left and right, lets it go, takes it again and swings it to the
/// left. Noted each time is the mean tension, mN, of the plane's strands on either side of its middle.
test::ScenarioText swung() {
  test::ScenarioText text;
  text.head =
      "local anatomy = require 'anatomy'\n"
      "local function note(t, when)\n"
      "  local strands, middle, sides = t:strands('cystic_plate'), 0, { left = { 0, 0 }, right = { 0, 0 } }\n"
      "  for _, strand in ipairs(strands) do middle = middle + strand.to[1] / #strands end\n"
      "  for _, strand in ipairs(strands) do\n"
      "    local side = strand.to[1] > middle and sides.left or sides.right\n"
      "    side[1], side[2] = side[1] + 1e3 * strand.tension, side[2] + 1\n"
      "  end\n"
      "  for name, side in pairs(sides) do t:note(when .. '_' .. name, side[1] / math.max(1, side[2])) end\n"
      "end\n";
  text.scene =
      "return { anatomy = anatomy.standard { assistant = false, areolar_plane = true,\n"
      "   prepared = { cystic_plate = 0.5, cystic_duct = 0.4, cystic_artery = { 0.5, 1 } },\n"
      "   without = { 'cystic_node', 'hilar_fat', 'triangle_fat', 'artery_fat' } },\n"
      " instruments = { fundus = { port = 'right_lateral', force_limit = 8 * N, pinch_force = 12 * N } },\n"
      " laparoscope = { look_at = 'gallbladder.fundus' }, solver = { motion = 'dynamic', rate = 25 } }";
  text.steps =
      "local function held() return t.fundus:holds('gallbladder') end\n"
      "t:step('swing', 'Swing the fundus')\n"
      "t:wait_until(held) t:wait(1.7 * s) note(t, 'left')\n"
      "t:wait(2 * s) note(t, 'right')\n"
      "t:wait_until(function() return not held() end)\n"
      "t:wait_until(held) t:wait(1.3 * s) note(t, 'again')";
  text.demo =
      "local f, fast, slow = t.fundus, { speed = 80 * mm / s }, { speed = 25 * mm / s }\n"
      "f:approach('gallbladder.fundus', { speed = 60 * mm / s, depth = 6 * mm }) f:close()\n"
      "f:move_by({ 0, 8 * mm, 15 * mm }, slow) f:move_by({ 20 * mm, 0, 0 }, slow) f:wait(0.4 * s)\n"
      "f:move_by({ -40 * mm, 0, 0 }, slow) f:wait(0.4 * s)\n"
      "f:open() f:move_by({ -15 * mm, -15 * mm, 20 * mm }, fast) f:wait(0.5 * s)\n"
      "f:approach('gallbladder.fundus', { speed = 60 * mm / s, depth = 6 * mm }) f:close()\n"
      "f:move_by({ 20 * mm, 8 * mm, 15 * mm }, slow) f:wait(0.4 * s)";
  return text;
}

TEST(BedField, AFundusThatIsSwungTensesThePlaneOnItsOtherSide) {
  if (!test::long_run() || test::sanitized) GTEST_SKIP() << "left to scripts/test --long: half a minute";
  test::PlayedText played;
  ASSERT_NO_FATAL_FAILURE(test::play_text(swung(), played));
  const auto right_share = [&](const std::string& when) {
    return played.noted(when + "_right") / played.noted(when + "_left");
  };
  EXPECT_GT(right_share("left"), 1.5 * right_share("right"));
  EXPECT_GT(played.noted("right_left"), 1.5 * played.noted("left_left"))
      << "the left side opens on a swing to the right";
  EXPECT_NEAR(right_share("again"), right_share("left"), 0.2 * right_share("left"))
      << "taken anew it does so again";
  EXPECT_GT(played.noted("left_right"), 5) << "mN: the strands are taut";
  EXPECT_EQ(played.tissues.at(0).torn, 0) << "a swing alone divides nothing";
}

}  // namespace
}  // namespace calot
