// t.laparoscope: what scripts are told of the camera, and how demos move it.

#include <gmock/gmock.h>

#include "base/log.h"
#include "lua/scenario_files.h"
#include "session/runner.h"

namespace calot::laparoscope_script_test {
namespace {

using ::testing::HasSubstr;

/// A ball, and a board behind it.
test::ScenarioText filmed(const std::string& demo, const std::string& horizon = "level") {
  test::ScenarioText text;
  text.scene =
      "return { anatomy = { organs = { { name = 'ball', shape = { type = 'sphere', radius = 15 * mm }, nodes "
      "= 61,\n"
      "neck = { -20 * mm, 100 * mm, -120 * mm }, fundus = { -20 * mm, 100 * mm, -90 * mm },\n"
      "held = { { landmark = 'neck', radius = 15 * mm } } } },\n"
      "ground = { { name = 'board', type = 'box', point = { -20 * mm, 180 * mm, -110 * mm }, size = { 180 * "
      "mm, 10 * mm, 120 * "
      "mm }, radius = 1 * mm } } },\n"
      "laparoscope = { look_at = 'ball.fundus', distance = 80 * mm, horizon = '" +
      horizon +
      "' }, solver = { rate = 25 },\n"
      "instruments = { left = { port = 'right_subcostal' } } }";
  text.steps = "t:step('look', 'Look')\nt:wait_until(function() return t:count('time_out') > 0 end)";
  text.demo = demo + "\nt:time_out()\nt:wait(0.1 * s)";
  return text;
}

struct Filmed {
  std::vector<std::string> said;
  SessionResult session;
};

Filmed film(const test::ScenarioText& text) {
  Filmed out;
  const LogSink before = set_log_sink([&](LogLevel, const std::string& line) { out.said.push_back(line); });
  const test::Folder folder;
  Result<std::unique_ptr<ExerciseScript>> script = test::load_text(folder, text.text());
  EXPECT_TRUE(script) << to_text(script.failure());
  if (script) {
    World world = World::create(script.value()->definition().scene).value();
    out.session = run_session(world, *script.value(), script.value()->demo(), {});
  }
  set_log_sink(before);
  EXPECT_EQ(out.session.end, SessionEnd::steps_done) << to_text(out.session.failure);
  return out;
}

TEST(LaparoscopeInLua, LooksAtAPlaceFromTheDistanceAskedForWithTheHorizonLevel) {
  const Filmed filmed_ball = film(filmed(
      "local scope, ball = t.laparoscope, t:place('ball.fundus')\n"
      "local aside = { ball[1] + 30 * mm, ball[2], ball[3] + 10 * mm }\n"
      "scope:look_at(aside, { distance = 60 * mm })\nt:wait(0.1 * s)\n"
      "local x, y = scope:picture(aside)\n"
      "print(math.abs(x) < 1e-9, math.abs(y) < 1e-9, math.abs(scope:distance(aside) - 60 * mm) < 1e-9)\n"
      "local d, a = scope:direction(), scope:axis()\n"
      "print(('%.3f'):format(math.deg(math.acos(d[1] * a[1] + d[2] * a[2] + d[3] * a[3]))), "
      "scope:horizon())\n"
      "x, y = scope:picture('ball.fundus')\n"
      "print(x < -0.3, scope:touching())"));
  EXPECT_THAT(filmed_ball.said, ::testing::ElementsAre("true\ttrue\ttrue", "30.000\t0.0", "true\tfalse"));
  EXPECT_GT(filmed_ball.session.metrics.at("laparoscope.path_length_mm"), 20);
  EXPECT_EQ(filmed_ball.session.metrics.at("laparoscope.contacts"), 0);
  EXPECT_LT(filmed_ball.session.metrics.at("laparoscope.horizon_off_deg"), 1e-9) << "but for rounding";
}

TEST(LaparoscopeInLua, SeesWhatNothingHidesAndNotWhatIsBehindTissueGroundOrTheEdge) {
  const Filmed seen =
      film(filmed("local p = t:place('ball.fundus')\n"
                  "local function at(x, y, z) return { p[1] + x * mm, p[2] + y * mm, p[3] + z * mm } end\n"
                  "local lens, middle, behind = t.laparoscope:tip(), at(0, 0, -15), {}\n"
                  "for k = 1, 3 do behind[k] = middle[k] + 0.4 * (middle[k] - lens[k]) end\n"
                  "print(t:sees('ball.fundus'), t:sees(behind), t:sees(at(40, 40, -10)), "
                  "t:sees(at(40, 110, -40)))\n"
                  "t.laparoscope:rotate(180 * deg)\n"
                  "print(t:sees('ball.fundus'))"));
  // The top of the ball; behind the ball; beside it, before the board; behind the board.
  EXPECT_THAT(seen.said, ::testing::ElementsAre("true\tfalse\ttrue\tfalse", "false"));
}

TEST(LaparoscopeInLua, AHorizonThatIsHeldTurnsWithTheShaftAndIsMeasured) {
  const std::string demo =
      "t.laparoscope:rotate(20 * deg)\nprint(('%.0f'):format(math.deg(t.laparoscope:roll())), "
      "t.laparoscope:horizon() > 10 * deg)";
  const Filmed level = film(filmed(demo)), held = film(filmed(demo, "held"));
  EXPECT_THAT(level.said, ::testing::ElementsAre("20\tfalse"));
  EXPECT_THAT(held.said, ::testing::ElementsAre("20\ttrue"));
  EXPECT_LT(level.session.metrics.at("laparoscope.horizon_off_deg"), 1e-9) << "but for rounding";
  EXPECT_GT(held.session.metrics.at("laparoscope.horizon_off_deg"), 1);
}

TEST(LaparoscopeInLua, ItsEndThatTouchesTissueIsAnEventOnce) {
  const Filmed close =
      film(filmed("t.laparoscope:move_to('ball.fundus')\nprint(t.laparoscope:touching())\n"
                  "t.laparoscope:move_by({ 0, -40 * mm, 30 * mm })\nprint(t.laparoscope:touching())"));
  EXPECT_THAT(close.said, ::testing::ElementsAre("true", "false"));
  int contacts = 0;
  for (const SessionEvent& event : close.session.progress.events())
    contacts += event.kind == EventKind::contact && event.instrument == "laparoscope" && event.organ == "ball"
                    ? 1
                    : 0;
  EXPECT_EQ(contacts, 1);
  EXPECT_EQ(close.session.metrics.at("laparoscope.contacts"), 1);
}

TEST(LaparoscopeInLua, WhatIsNotAskedToMoveIsInNoInput) {
  const test::Folder folder;
  const auto script = test::load_text(folder, filmed("t.left:move_by({ 0, 0, -5 * mm })").text());
  ASSERT_TRUE(script) << to_text(script.failure());
  World world = World::create(script.value()->definition().scene).value();
  for (int step = 0; step < 5; ++step) {
    const Result<std::optional<StepInput>> input = script.value()->demo().next(world, 0.04);
    ASSERT_TRUE(input && input.value());
    EXPECT_FALSE(input.value()->laparoscope);
    ASSERT_TRUE(world.step(*input.value()));
  }
}

TEST(LaparoscopeInLua, WrongUseIsRefusedAtItsLine) {
  const auto refused = [](const std::string& demo) {
    const test::Folder folder;
    const auto script = test::load_text(folder, filmed(demo).text());
    return script ? std::string() : to_text(script.failure());
  };
  EXPECT_THAT(refused("t.laparoscope:look_at('ball.nowhere')"),
              HasSubstr("unknown landmark \"ball.nowhere\""));
  EXPECT_THAT(refused("t.laparoscope:grip()"), HasSubstr("t.laparoscope has no \"grip\""));
  EXPECT_THAT(refused("t.left.force(t.laparoscope)"), HasSubstr("force is a method of instruments"));
  EXPECT_THAT(refused("t.laparoscope.horizon(t.left)"), HasSubstr("horizon is a method of the laparoscope"));
  EXPECT_THAT(refused("t.laparoscope:look_at({ 0, 0, 0 }, { distance = 0 })"), HasSubstr("distance"));
  EXPECT_THAT(refused("t:sees(7)"), HasSubstr("place"));
  // What a guard may keep from being asked is looked at all the same.
  EXPECT_THAT(
      refused("t:wait_until(function()\nlocal x = t.laparoscope:picture('ball.fundus')\n"
              "return x and t.laparoscope:distance('ball.fundus') < 60 * mm and t:sees('ball.fundis') end)"),
      HasSubstr("unknown landmark \"ball.fundis\""));
}

}  // namespace
}  // namespace calot::laparoscope_script_test
