// Steps and demos keep time: what they do depends on the simulated time, not on the rate.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/log.h"
#include "lua/demo_script.h"
#include "lua/motion.h"
#include "lua/scenario_files.h"
#include "session/runner.h"

namespace calot::scheduler_test {
namespace {

using test::Folder;
using test::line_of;
using test::load_text;
using test::ScenarioText;

constexpr double rounding =
    1e-9;  // of times: the slack of waits; of places: a metre a second over that slack

/// A ball far from every instrument, so that a step of the world is cheap and nothing is in the way.
std::string scene_at(double rate) {
  return "return { anatomy = { organs = { { name = 'ball', shape = { type = 'sphere', radius = 20 * mm }, "
         "nodes = 61,\n"
         "neck = { 0, 0, -400 * mm }, fundus = { 0, 0, -360 * mm }, held = { { landmark = 'bed' } } } } }, "
         "laparoscope = { look_at = 'ball.fundus' },\n"
         "solver = { rate = " +
         std::to_string(rate) +
         " },\ninstruments = { left = { port = 'right_subcostal' }, right = { port = 'epigastric' } } }";
}

struct Moment {
  double time = 0;
  std::vector<InstrumentPose> poses;
  std::vector<Vec3> tips;
};

struct Played {
  std::optional<Failure> failure;
  std::vector<Moment> moments;
  double source_ended = -1, steps_ended = -1;
  Progress progress;
  std::vector<std::string> printed;
  std::string text;  ///< of the scenario
};

/// Plays steps and demo together for `seconds`, on the text's own scene.
Played play_own(const ScenarioText& text, double rate, double seconds) {
  Played played;
  LogSink before = set_log_sink([&](LogLevel, const std::string& line) { played.printed.push_back(line); });
  const Folder folder;
  played.text = text.text();
  Result<std::unique_ptr<ExerciseScript>> script = load_text(folder, played.text);
  if (!script) {
    played.failure = script.failure();
    set_log_sink(std::move(before));
    return played;
  }
  Result<World> world = World::create(script.value()->definition().scene);
  if (!world) {
    played.failure = world.failure();
    set_log_sink(std::move(before));
    return played;
  }
  StepInput input;
  for (const InstrumentState& state : world->report().instruments) input.instruments.push_back(state.pose);
  const double dt = 1 / rate;
  while (world->report().time < seconds - rounding && !played.failure) {
    Result<std::optional<StepInput>> next = script.value()->demo().next(world.value(), dt);
    if (!next) played.failure = next.failure();
    if (next && next.value()) input = *next.value();
    if (next && !next.value() && played.source_ended < 0) played.source_ended = world->report().time;
    if (played.failure) break;
    EXPECT_TRUE(world->step(input));
    Moment moment{world->report().time, input.instruments, {}};
    for (std::size_t i = 0; i < input.instruments.size(); ++i) {
      InstrumentPose closed = input.instruments[i];
      closed.jaw = 0;
      const Vec3 trocar = world->port_position(world->scene().instruments[i].port);
      moment.tips.push_back(tip_position(trocar, closed, {}));
    }
    played.moments.push_back(moment);
    Result<bool> done = script.value()->advance(world.value(), played.progress, dt);
    if (!done) played.failure = done.failure();
    if (done && done.value() && played.steps_ended < 0) played.steps_ended = world->report().time;
  }
  set_log_sink(std::move(before));
  return played;
}

/// On a ball out of reach.
Played play(ScenarioText text, double rate, double seconds) {
  text.scene = scene_at(rate);
  return play_own(text, rate, seconds);
}

ScenarioText with_demo(const std::string& demo) {
  ScenarioText text;
  text.demo = demo;
  return text;
}
ScenarioText with_steps(const std::string& steps) {
  ScenarioText text;
  text.steps = steps;
  text.demo = "";
  text.score = "calot.score.weighted { { calot.score.penalty { event = 'contact' }, weight = 1 } }";
  return text;
}

// ---- travels

TEST(Motion, CoversItsDistanceSmoothlyAndNeverFasterThanAsked) {
  for (const double distance : {0.5e-3, 5e-3, 40e-3}) {
    const double speed = 20e-3, h = 1e-4;
    const Travel travel(distance, speed);
    EXPECT_EQ(travel.share(0), 0);
    EXPECT_EQ(travel.share(travel.duration()), 1);
    double fastest = 0, last_speed = 0, hardest = 0;
    for (double t = 0; t < travel.duration() + h; t += h) {
      const double v = (travel.share(t + h) - travel.share(t)) * distance / h;
      EXPECT_GE(v, -1e-12);  // rounding of shares over h
      fastest = std::max(fastest, v);
      hardest = std::max(hardest, std::abs(v - last_speed) / h);
      last_speed = v;
    }
    EXPECT_LE(fastest, speed * (1 + 1e-9));
    EXPECT_LE(hardest,
              1.5 * speed / 0.2 * 1.01);  // steepest slope of 3 x^2 - 2 x^3, 1% for the finite difference
  }
}

TEST(Motion, LastsAsLongAsItsDistanceAndRampTake) {
  EXPECT_DOUBLE_EQ(Travel(100e-3, 20e-3, 0.2).duration(), 5.2);
  EXPECT_DOUBLE_EQ(Travel(1e-3, 20e-3, 0.2).duration(), 0.4);  // too short for the speed: two ramps
  EXPECT_DOUBLE_EQ(Travel(0, 20e-3, 0.2).duration(), 0);
}

TEST(Motion, OfNoDistanceIsDoneAtOnceAndAlwaysANumber) {
  for (const double ramp : {0.2, 0.15})
    for (const double t : {-1.0, -1e-17, 0.0, 1e-17, 0.1, 1.0}) EXPECT_EQ(Travel(0, 20e-3, ramp).share(t), 1);
  EXPECT_EQ(Travel(0, 0, 0.15).share(-1e-17), 1) << "jaws that are told to turn to where they are";
}

// ---- demo

const char* const busy_demo =
    "t.left:open() t.left:move_by({ 10 * mm, 0, -20 * mm }, { speed = 25 * mm / s })\n"
    "t:together(function() t.left:rotate(40 * deg) t.left:close() end,\n"
    "           function() t.right:wait(0.13 * s) t.right:move_by({ 0, -7 * mm, -9 * mm }) end)\n"
    "t.left:wait(0.037 * s) t.left:move_by({ 0, 3 * mm, 0 })";

TEST(Demo, PathDoesNotDependOnTheRate) {
  const Played coarse = play(with_demo(busy_demo), 25, 4), fine = play(with_demo(busy_demo), 100, 4);
  ASSERT_FALSE(coarse.failure) << to_text(*coarse.failure);
  ASSERT_FALSE(fine.failure) << to_text(*fine.failure);
  for (const Moment& moment : coarse.moments) {
    const auto same = std::find_if(fine.moments.begin(), fine.moments.end(), [&](const Moment& m) {
      return std::abs(m.time - moment.time) < rounding;
    });
    ASSERT_NE(same, fine.moments.end());
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(moment.poses[i].pitch, same->poses[i].pitch, rounding) << moment.time;
      EXPECT_NEAR(moment.poses[i].yaw, same->poses[i].yaw, rounding) << moment.time;
      EXPECT_NEAR(moment.poses[i].insertion, same->poses[i].insertion, rounding) << moment.time;
      EXPECT_NEAR(moment.poses[i].roll, same->poses[i].roll, rounding) << moment.time;
      EXPECT_NEAR(moment.poses[i].jaw, same->poses[i].jaw, rounding) << moment.time;
    }
  }
}

TEST(Demo, MovesByWhatItSays) {
  const Played played = play(with_demo("t.left:move_by({ 10 * mm, -5 * mm, -20 * mm })"), 50, 2);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  const Vec3 moved = played.moments.back().tips[0] - played.moments.front().tips[0];
  // The first moment is one step into the motion, less than a ramp's 0.02 s share of it.
  EXPECT_LT((moved - Vec3(10e-3, -5e-3, -20e-3)).norm(), 0.1e-3);
  EXPECT_EQ(played.moments.back().tips[1], played.moments.front().tips[1]);
}

TEST(Demo, WhatAsksForNoMotionDoesNothing) {
  // It is as if it had not been asked for.
  const auto moves_with = [](const std::string& opened, const std::string& nothing) {
    return with_demo(
        opened + " for k = 1, 8 do t.right:move_by({ 0.37 * mm, (-1) ^ k * k * mm, 0 }, { speed = 0.1 }) " +
        nothing + " end");
  };
  for (const std::string opened : {"", "t.left:open(40 * deg)"}) {
    const std::string turn_to_where_they_are = opened.empty() ? "t.left:close()" : opened;
    for (const double rate : {25.0, 30.0}) {
      const Played without = play(moves_with(opened, ""), rate, 5);
      for (const std::string& nothing : {turn_to_where_they_are, std::string("t.left:rotate(0)"),
                                         std::string("t.left:move_by({ 0, 0, 0 })")}) {
        const Played with = play(moves_with(opened, nothing), rate, 5);
        ASSERT_FALSE(with.failure) << nothing << ": " << to_text(*with.failure);
        ASSERT_EQ(with.moments.size(), without.moments.size());
        for (std::size_t i = 0; i < with.moments.size(); ++i)
          for (int tool : {0, 1}) {
            const InstrumentPose &pose = with.moments[i].poses[tool], &same = without.moments[i].poses[tool];
            EXPECT_NEAR(pose.jaw, same.jaw, rounding) << nothing;
            EXPECT_NEAR(pose.roll, same.roll, rounding) << nothing;
            EXPECT_NEAR(pose.insertion, same.insertion, rounding) << nothing;
          }
      }
    }
  }
}

TEST(Demo, MovesToAPlaceWithTheTipOfItsOpenJaws) {
  const Played played =
      play(with_demo("t.left:open(40 * deg) t.left:move_to({ -60 * mm, 90 * mm, -90 * mm })"), 50, 5);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  const InstrumentPose pose = played.moments.back().poses[0];
  EXPECT_NEAR(pose.jaw, 40 * 3.14159265358979 / 180, rounding);
  const Vec3 trocar(-80e-3, 70e-3, -5e-3);  // right_subcostal
  EXPECT_LT((tip_position(trocar, pose, {}) - Vec3(-60e-3, 90e-3, -90e-3)).norm(), rounding);
}

TEST(Demo, RunsFunctionsSideBySide) {
  const std::string serial = "t.left:move_by({ 0, 0, -20 * mm }) t.right:move_by({ 0, 0, -20 * mm })";
  const std::string parallel =
      "t:together(function() t.left:move_by({ 0, 0, -20 * mm }) end, function() t.right:move_by({ 0, 0, -20 "
      "* mm }) end)";
  const Played one = play(with_demo(serial), 50, 3), both = play(with_demo(parallel), 50, 3);
  const double duration = Travel(20e-3, default_speed).duration();
  EXPECT_NEAR(one.source_ended, 2 * duration, 0.02 + rounding);  // the step in which it ended still has input
  EXPECT_NEAR(both.source_ended, duration, 0.02 + rounding);
  EXPECT_LT((one.moments.back().tips[0] - both.moments.back().tips[0]).norm(), rounding);
  EXPECT_LT((one.moments.back().tips[1] - both.moments.back().tips[1]).norm(), rounding);
}

TEST(Demo, WaitsForConditions) {
  const Played played = play(
      with_demo("t:wait_until(function() return t:time() > 0.99 * s end) t.left:move_by({ 0, 0, -9 * mm })"),
      50, 2);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  for (const Moment& moment : played.moments)
    EXPECT_EQ(moment.poses[0].insertion > played.moments.front().poses[0].insertion,
              moment.time > 1 + rounding)
        << moment.time;
}

TEST(Demo, MovesUntilAConditionHoldsOrItsLimitIsReached) {
  const Played played = play(
      with_demo(
          "print(t.left:move_until(function() return false end, { along = { 0, 0, -3 }, limit = 12 * mm }))\n"
          "local start = t:time()\n"
          "local held, way = t.left:move_until(function() return t:time() > start + 0.99 * s end,\n"
          "  { along = { 0, 0, -1 }, speed = 10 * mm / s, limit = 40 * mm })\n"
          "print(held, way > 8 * mm, way < 10 * mm)\n"
          "t:wait(0.5 * s)"),
      50, 5);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  EXPECT_THAT(played.printed, ::testing::ElementsAre("false\t0.012", "true\ttrue\ttrue"));
  const Vec3 way = played.moments.back().tips[0] - played.moments.front().tips[0];
  EXPECT_LT(way.head<2>().norm(), 1e-6);
  EXPECT_LT(way.z(), -20e-3);
  // It stands where it stopped: the last half second is a wait.
  EXPECT_EQ(played.moments.back().tips[0], played.moments[played.moments.size() - 20].tips[0]);
}

const char* const electrode_scene =
    "return { anatomy = { organs = { { name = 'ball', shape = { type = 'sphere', radius = 20 * mm }, nodes "
    "= 61,\n"
    "neck = { -80 * mm, 75 * mm, -120 * mm }, fundus = { -80 * mm, 75 * mm, -80 * mm }, liver_side = { 0, "
    "1, 0 },\n"
    "held = { { landmark = 'neck', radius = 20 * mm } } } } }, laparoscope = { look_at = 'ball.fundus' },\n"
    "solver = { rate = 50 }, instruments = { left = { port = 'right_subcostal', type = 'bipolar_electrode' "
    "} } }";

TEST(Demo, PressesUntilAForceIsReachedAndStepsSeeWhere) {
  ScenarioText text = with_steps(
      "t:wait_until(function() return t.left:push('tip') > 0.2 * N end)\n"
      "local c, f = t.left:contact(), t.left:force_vector('tip')\n"
      "print(c.part, c.organ, c.landmark, c.force == t.left:force('tip'), f[3] > 0.1, t.left:pull('tip'))\n"
      "print(t.left:touching('shaft'), t.left:contact('shaft'))");
  text.demo =
      "t.left:approach('ball.fundus', { depth = -3 * mm })\n"
      "print(t.left:move_until(function() return t.left:push('tip') > 0.2 * N end, { towards = 'ball.fundus' "
      "}))";
  text.scene = electrode_scene;
  const Played played = play_own(text, 50, 8);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  ASSERT_EQ(played.printed.size(), 3u);
  EXPECT_EQ(played.printed[0], "tip\tball\tball.fundus\ttrue\ttrue\t0.0");
  EXPECT_EQ(played.printed[1], "false\tnil");
  EXPECT_EQ(played.printed[2].substr(0, 5), "true\t") << "the demo asks when the next step begins";
}

TEST(Demo, TissueThatIsTurnedTurnsBackAndTheHandThatFollowsItTakesItsTorqueOff) {
  ScenarioText text = with_steps("t:wait(1 * s)");
  text.demo =
      "t.left:approach('ball.fundus', { depth = 5 * mm })\n"
      "t.left:close()\n"
      "local before = t.left:torque()\n"
      "t.left:rotate(15 * deg)\n"
      "local turned = t.left:torque()\n"
      "t.left:rotate(-15 * deg)\n"
      "print(turned - before, t.left:torque() - before)";
  text.scene = electrode_scene;
  text.scene.replace(text.scene.find(", type = 'bipolar_electrode'"), 28, "");
  const Played played = play_own(text, 50, 8);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  ASSERT_EQ(played.printed.size(), 1u);
  std::istringstream numbers(played.printed[0]);
  double turned = 0, back = 0;
  numbers >> turned >> back;
  EXPECT_LT(turned, -1e-3) << "N m: what holds the fold turns it back";
  EXPECT_LT(std::abs(back), 0.1 * std::abs(turned));
}

TEST(Demo, CurrentFlowsInTheStepsThatEndWithinItsTimeAndStepsSeeIt) {
  ScenarioText text = with_steps(
      "t:wait_until(function() return t.left:active() end) print(t:time())\n"
      "t:wait_until(function() return not t.left:active() end) print(t:time())");
  text.demo = "t:wait(0.1 * s) t.left:activate(0.3 * s) t:wait(0.2 * s)";
  text.scene = electrode_scene;
  const Played played = play_own(text, 50, 0.6);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  EXPECT_THAT(played.printed, ::testing::ElementsAre("0.12", "0.42"));
}

TEST(Demo, CurrentFlowsUntilAMotionEndsAndNotToItsLimit) {
  ScenarioText text = with_steps(
      "t:wait_until(function() return t.left:active() end) print(t:time())\n"
      "t:wait_until(function() return not t.left:active() end) print(t:time())\n"
      "t:wait_until(function() return t.left:active() end) print(t:time())");
  text.demo =
      "t.left:move_until(function() return t:time() > 0.29 * s end, { along = { 0, 0, -1 }, active = true "
      "})\n"
      "t.left:move_until(function() return false end, { along = { 0, 0, -1 }, limit = 1 * mm })\n"
      "t:wait(0.2 * s)";
  text.scene = electrode_scene;
  const Played played = play_own(text, 50, 1.2);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  EXPECT_THAT(played.printed, ::testing::ElementsAre("0.02", "0.32"));
}

TEST(Demo, TakesTimeOutsInTheStepInWhichItIsAndStepsCountTheEvents) {
  const Folder folder;
  ScenarioText text;
  text.scene = scene_at(50);
  text.steps =
      "t:step('look', 'Look')\nt:wait_until(function() return t:count('time_out') == 2 end)\n"
      "t:note('seen', t:time(), 's')\nt:wait(9 * s)";
  text.demo =
      "t:time_out('first') t:wait(0.1 * s) t:time_out() t:wait(0.1 * s) t:bail_out('subtotal') t:wait(1 * s)";
  Result<std::unique_ptr<ExerciseScript>> script = test::load_text(folder, text.text());
  ASSERT_TRUE(script) << to_text(script.failure());
  World world = World::create(script.value()->definition().scene).value();
  const SessionResult result = run_session(world, *script.value(), script.value()->demo(), {});
  EXPECT_EQ(result.end, SessionEnd::bailed_out) << to_text(result.failure);
  std::vector<std::string> acts;
  for (const SessionEvent& event : result.progress.events())
    acts.push_back(fmt::format("{} {:.2f} {}", to_text(event.kind), event.time, event.text));
  EXPECT_THAT(acts,
              ::testing::ElementsAre("time_out 0.02 first", "time_out 0.10 ", "bail_out 0.20 subtotal"));
  EXPECT_NEAR(result.metrics.at("note.seen"), 0.1, 1e-9) << "in the step of the second";
}

TEST(Demo, RefusesASecondMotionWhileItMovesUntilAConditionHolds) {
  const Played played =
      play(with_demo("t:together(function() t.left:move_until(function() return false end) end,\n"
                     "function() t.left:close() end)"),
           50, 1);
  ASSERT_TRUE(played.failure);
  EXPECT_THAT(to_text(*played.failure), ::testing::HasSubstr("another function of t:together"));
}

TEST(Steps, LearnWhatAnInstrumentThatTouchesNothingFeels) {
  ScenarioText text = with_steps(
      "t:wait_until(function() return t.left:grip() == 'open' end)\n"
      "t:wait_until(function() return t.left:grip() == 'empty' end)\n"
      "print(t.left:contact(), t.left:touching('tip'), t.left:force('shaft'), t.left:pull(), "
      "t.left:push('jaws'))\n"
      "local f = t.left:force_vector() print(#f, f[1], f[2], f[3], t.left:holds())");
  text.demo = "t.left:open() t.left:close()";
  const Played played = play(text, 50, 1.5);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  EXPECT_THAT(played.printed, ::testing::ElementsAre("nil\tfalse\t0.0\t0.0\t0.0", "3\t0.0\t0.0\t0.0\tfalse"));
}

TEST(Demo, EndsWhenItsFunctionReturnsAndAtOnceWithoutOne) {
  EXPECT_NEAR(play(with_demo("t:wait(0.5 * s)"), 50, 1).source_ended, 0.5, 0.02 + rounding);
  EXPECT_LE(play(with_demo(""), 50, 0.1).source_ended, 0.02 + rounding);
}

TEST(Demo, RefusesPlacesOutOfReach) {
  const ScenarioText text = with_demo("t:wait(0.1 * s)\nt.left:move_to({ 300 * mm, 0, -300 * mm })");
  const Played played = play(text, 50, 1);
  ASSERT_TRUE(played.failure);
  EXPECT_EQ(played.failure->kind, FailureKind::scenario);
  EXPECT_THAT(to_text(*played.failure), ::testing::HasSubstr("mm from its port"));
}

TEST(Demo, RefusesTwoMotionsOfOneInstrumentAtATime) {
  const Played played = play(with_demo("t:together(function() t.left:move_by({ 0, 0, -20 * mm }) end,\n"
                                       "function() t.left:close() end)"),
                             50, 1);
  ASSERT_TRUE(played.failure);
  EXPECT_THAT(to_text(*played.failure), ::testing::HasSubstr("another function of t:together"));
}

TEST(Demo, CannotBeDrivenFromACoroutineOrPredicateOfItsOwn) {
  for (const char* demo : {"coroutine.wrap(function() t:wait(1 * s) end)()", "coroutine.yield()"}) {
    const Played played =
        play(with_demo("if t:time() < 1e9 then local x = t:time() end\n" + std::string(demo)), 50, 1);
    ASSERT_TRUE(played.failure) << demo;
    EXPECT_EQ(played.failure->kind, FailureKind::scenario);
  }
}

// ---- steps

TEST(Steps, NoteValuesWithTheirTimeAndStep) {
  const Played played = play(with_steps("t:step('a', 'A') t:wait(0.1 * s) t:note('reach', 12.5, 'mm')\n"
                                        "t:note('word', 'well done') t:note('ok', true) t:note('reach', 14)"),
                             50, 0.2);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  const std::vector<Note>& notes = played.progress.notes();
  ASSERT_EQ(notes.size(), 4u);
  EXPECT_EQ(notes[0].name, "reach");
  EXPECT_EQ(notes[0].unit, "mm");
  EXPECT_EQ(notes[0].step, "a");
  EXPECT_NEAR(notes[0].time, 0.1, rounding);
  EXPECT_EQ(std::get<double>(notes[0].value), 12.5);
  EXPECT_EQ(std::get<std::string>(notes[1].value), "well done");
  EXPECT_TRUE(std::get<bool>(notes[2].value));
  EXPECT_EQ(played.progress.metrics().at("note.reach"), 14) << "the last one counts";
  EXPECT_EQ(played.progress.metrics().count("note.ok"), 0u);
}

TEST(Steps, CannotNoteWithoutEnd) {
  const Played played = play(with_steps("for i = 1, 2000 do t:note('n', i) end"), 50, 0.1);
  ASSERT_TRUE(played.failure);
  EXPECT_EQ(played.failure->kind, FailureKind::scenario);
  EXPECT_EQ(played.failure->problems[0].place.line, line_of(played.text, "t:note"));
  EXPECT_THAT(to_text(*played.failure), ::testing::HasSubstr("1000 notes"));
}

/// What steps print of a ball's places, in mm.
TEST(Steps, LearnWherePlacesAreAndHowFarATipIs) {
  const Played played = play(
      with_steps(
          "t:wait(0.1 * s)\n"
          "local function apart(a, b) local sum = 0 a, b = t:place('ball.' .. a), t:place('ball.' .. b)\n"
          "for i = 1, 3 do sum = sum + (a[i] - b[i]) ^ 2 end return math.sqrt(sum) / mm end\n"
          "print(#t:place('ball.fundus'), apart('fundus', 'neck') > 30, apart('fundus', 'neck') < 45)\n"
          "print(apart('free_side', 'body'), apart('liver_side', 'bed'))\n"
          "print(apart('infundibulum', 'neck') < apart('body', 'neck'),\n"
          "      apart('infundibulum', 'body') < apart('infundibulum', 'bed'))\n"
          "local tip, place = t.left:tip(), t:place('ball.fundus')\n"
          "local d = math.sqrt((tip[1] - place[1]) ^ 2 + (tip[2] - place[2]) ^ 2 + (tip[3] - place[3]) ^ 2)\n"
          "print(math.abs(d - t.left:distance('ball.fundus')) < 1e-12, d > 0.2)"),
      50, 0.2);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  EXPECT_THAT(played.printed,
              ::testing::ElementsAre("3\ttrue\ttrue", "0.0\t0.0", "true\ttrue", "true\ttrue"));
}

TEST(Demo, ClearanceIsTheWayThatIsLeftToAnOrgan) {
  const Played played =
      play(with_demo("local from, to = t.left:tip(), { -60 * mm, 90 * mm, -90 * mm }\n"
                     "t.left:move_by({ to[1] - from[1], to[2] - from[2], to[3] - from[3] })\n"
                     "local far, at, goal = t.left:clearance('ball'), t.left:tip(), t:place('ball.fundus')\n"
                     "local share = 20 * mm / t.left:distance('ball.fundus')\n"
                     "t.left:move_by({ share * (goal[1] - at[1]), share * (goal[2] - at[2]),\n"
                     "                 share * (goal[3] - at[3]) })\n"
                     "local way = far - t.left:clearance('ball')\n"
                     "print(far < t.left:distance('ball.fundus') + 20 * mm, way > 15 * mm, way < 20.1 * mm)"),
           50, 8);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  EXPECT_THAT(played.printed, ::testing::ElementsAre("true\ttrue\ttrue"));
}

TEST(Demo, GoesToWhereAPlaceIsByItsOwnReckoning) {
  const Played played =
      play(with_demo("local from, to = t.left:tip(), { -60 * mm, 90 * mm, -90 * mm }\n"
                     "t.left:move_by({ to[1] - from[1], to[2] - from[2], to[3] - from[3] })\n"
                     "print(t.left:distance('ball.fundus') < 0.35, #t:place('ball.neck'))"),
           50, 5);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  EXPECT_THAT(played.printed, ::testing::ElementsAre("true\t3"));
  EXPECT_LT((played.moments.back().tips[0] - Vec3(-60e-3, 90e-3, -90e-3)).norm(), 1e-6);
}

TEST(Steps, BeginAtTimeZeroAndEndAsTheyShould) {
  const Played played = play(with_steps("t:step('a', 'A') t:wait(0.5 * s)\n"
                                        "t:step('b', 'B', { limit = 0.3 * s })\n"
                                        "local held = t:wait_until(function() return false end) print(held)\n"
                                        "print(t:wait_until(function() return true end))\n"
                                        "t:step('c', 'C') print(t:wait_until(function() return true end))"),
                             50, 1.5);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  const std::vector<StepRecord>& steps = played.progress.steps();
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].started, 0);
  EXPECT_EQ(steps[0].outcome, "done");
  EXPECT_NEAR(steps[0].ended, 0.5, rounding);
  EXPECT_EQ(steps[1].outcome, "timeout");
  EXPECT_NEAR(steps[1].ended, 0.8, rounding);
  EXPECT_EQ(steps[2].outcome, "done");
  EXPECT_NEAR(played.steps_ended, 0.8, rounding);
  EXPECT_THAT(played.printed, ::testing::ElementsAre("false", "false", "true"));
}

TEST(Steps, HoldsAddUpTheTimeInTheBandOverInterruptions) {
  // In the band in (0, 0.4] and (0.6, ...]: half a second is reached at 0.7 s, at whatever rate.
  const std::string steps =
      "t:step('hold', 'Hold')\n"
      "print(t:hold('band', function() local now = t:time() return now < 0.41 * s or now > 0.61 * s end, 0.5 "
      "* s))";
  for (const double rate : {25.0, 50.0, 100.0}) {
    const Played played = play(with_steps(steps), rate, 1);
    ASSERT_FALSE(played.failure) << to_text(*played.failure);
    EXPECT_NEAR(played.steps_ended, 0.7, 1 / rate + rounding) << rate;  // seen at the end of a step
    EXPECT_NEAR(played.progress.metrics().at("hold.band.time_in_s"), 0.5, 1 / rate + rounding) << rate;
    EXPECT_THAT(played.printed, ::testing::ElementsAre("true"));
  }
}

TEST(Steps, AHoldThatIsNeverReachedHasNoTimeInIt) {
  const Played played = play(
      with_steps(
          "t:step('a', 'A') t:wait(9 * s)\nt:step('b', 'B') t:hold('c', function() return true end, 1 * s)"),
      50, 0.2);
  EXPECT_EQ(played.progress.metrics().at("b.c.time_in_s"), 0);
}

TEST(Steps, AHoldEndsWithItsStepsLimit) {
  const Played played =
      play(with_steps("t:step('a', 'A', { limit = 0.4 * s })\n"
                      "print(t:hold('b', function() return t:time() < 0.31 * s end, 0.4 * s))"),
           50, 1);
  EXPECT_THAT(played.printed, ::testing::ElementsAre("false"));
  EXPECT_NEAR(played.progress.metrics().at("a.b.time_in_s"), 0.3, rounding);
  EXPECT_NEAR(played.steps_ended, 0.4, rounding);
}

TEST(Steps, SeeTheWorldAsItIs) {
  ScenarioText text = with_steps(
      "t:step('a', 'A') t:wait(0.2 * s)\n"
      "print(string.format('%.12g %.12g %s %s', t:pressure('ball'), t:volume('ball'), t.left:holds(), "
      "t.left:touching()))\n"
      "local tip = t.left:tip() print(string.format('%.12g %.12g %.12g', tip[1], tip[2], tip[3]))");
  const Played played = play(text, 50, 0.3);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  ASSERT_EQ(played.printed.size(), 2u);
  double pressure = 0, volume = 0;
  std::sscanf(played.printed[0].c_str(), "%lf %lf", &pressure, &volume);
  const double ball = 4.0 / 3 * 3.14159265358979 * 20e-3 * 20e-3 * 20e-3;
  EXPECT_NEAR(volume, ball,
              0.05 * ball);  // filled to its unstressed volume; 61 nodes make a ball to a few percent
  EXPECT_THAT(played.printed[0], ::testing::HasSubstr("false false"));
  Vec3 tip;
  std::sscanf(played.printed[1].c_str(), "%lf %lf %lf", &tip.x(), &tip.y(), &tip.z());
  EXPECT_LT((tip - played.moments.front().tips[0]).norm(), rounding);
}

TEST(Steps, SeeWhatIsTorn) {
  ScenarioText text = with_steps(
      "t:step('a', 'A') print(t:torn('stalk'))\n"
      "local all = t:strands('stalk') print(#all > 0 and #all <= 30)\n"
      "for _, one in ipairs(all) do if one.share < 0.3 or one.share > 0.7 or one.from[3] < one.to[3] then "
      "print(one.share) end end\n"
      "local view = t:critical_view { gallbladder = 'stone', plate = 'stalk', neck = 'duct.start', junction "
      "= "
      "'duct.end', hilum = 'stone.centre', lower_part = 1 }\n"
      "print(view.plate.share, view.plate.points, view.structures.count)\n"
      "t:wait(0.1 * s) t:remove('stone') print(t:torn('stalk'), #t:strands('stalk'))");
  text.scene =
      "return { anatomy = { organs = { { name = 'duct', shape = { type = 'tube', points = { { -100 * mm, 70 "
      "* mm, "
      "-100 * mm }, { -60 * mm, 70 * mm, -100 * mm } }, radius = 3 * mm }, held = { { landmark = 'start' }, "
      "{ "
      "name = 'far', landmark = 'end' } } },\n"
      "{ name = 'stone', shape = { type = 'rigid', size = { 20 * mm, 4 * mm, 2 * mm }, rounding = 4 * mm, "
      "centre = { "
      "-80 * mm, 70 * mm, -109 * mm } } } },\n"
      "tissue = { { name = 'stalk', from = 'duct', to = 'stone', start = 0.3, stop = 0.7, strands = 30 } } "
      "},\n"
      "solver = { motion = 'dynamic', rate = 50 }, laparoscope = { look_at = 'duct.middle' },\n"
      "instruments = { left = { port = 'right_subcostal' } } }";
  const Played played = play_own(text, 50, 0.3);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  EXPECT_THAT(played.printed, ::testing::ElementsAre("0.0", "true", "0.0\t0\t0", "1.0\t0"));
}

TEST(Steps, SeeWhatIsRawOfALiver) {
  ScenarioText text =
      with_steps("t:step('a', 'A') print(t:raw('liver')) t:wait(1.8 * s) print(t:raw('liver') > 0)");
  text.scene =
      "return { anatomy = { organs = { { name = 'liver', shape = { type = 'lobe', bed_width = 0, bed_depth = "
      "0 "
      "}, wall = { burn_reach = 5 * mm } } } }, laparoscope = { look_at = 'liver.edge' },\n"
      "instruments = { left = { type = 'bipolar_electrode', port = 'right_subcostal' } } }";
  text.demo = "t.left:approach('liver.edge', { speed = 400 * mm / s }) t.left:activate(0.1 * s)";
  const Played played = play_own(text, 50, 2);
  ASSERT_FALSE(played.failure) << to_text(*played.failure);
  EXPECT_THAT(played.printed, ::testing::ElementsAre("0.0", "true"));
}

TEST(Steps, ErrorsWhileTheyRunNameTheScriptsLines) {
  const ScenarioText text = with_steps(
      "t:step('a', 'A') t:wait_until(function()\n local x = t:time() > 0.1 and nil\n return x + 1 end)");
  const Played played = play(text, 50, 1);
  ASSERT_TRUE(played.failure);
  EXPECT_EQ(played.failure->kind, FailureKind::scenario);
  EXPECT_EQ(played.failure->problems[0].place.line, line_of(played.text, "return x + 1"));
  EXPECT_EQ(to_text(*played.failure).find("[C]"), std::string::npos);
}

TEST(Steps, BudgetsEndThemWhileTheyRunToo) {
  const ScenarioText text =
      with_steps("t:step('a', 'A') t:wait_until(function()\n while t:time() > 0.1 do end return false end)");
  const Played played = play(text, 50, 1);
  ASSERT_TRUE(played.failure);
  EXPECT_EQ(played.failure->kind, FailureKind::resource);
  EXPECT_EQ(played.failure->problems[0].place.line, line_of(played.text, "while t:time()"));
}

TEST(Demo, ActsInALoopAreCountedAndEndAtItsLine) {
  // Lua itself spends a tenth of its budget on this loop.
  const Played played = play(with_demo("for _ = 1, 1e5 do t:time_out('x') end"), 50, 1);
  ASSERT_TRUE(played.failure);
  EXPECT_EQ(played.failure->kind, FailureKind::resource) << to_text(*played.failure);
  EXPECT_EQ(played.failure->problems[0].place.line, line_of(played.text, "for _ = 1"));
}

TEST(Steps, LoopsOfWaitsInWhichNoTimePassesAreRefusedAtTheirLine) {
  ScenarioText text =
      with_steps("t:step('a', 'A')\nwhile true do t:wait_until(function() return true end) end");
  Played played = play(text, 50, 1);
  ASSERT_TRUE(played.failure);
  EXPECT_EQ(played.failure->problems[0].place.line, line_of(played.text, "while true"))
      << to_text(*played.failure);
  EXPECT_THAT(to_text(*played.failure), ::testing::HasSubstr("no time passes"));
  text = with_demo(
      "local late = false\nwhile true do late = late or t:time() > 0.5 t:wait(late and 0 or 0.1) end");
  played = play(text, 50, 1);
  ASSERT_TRUE(played.failure);
  EXPECT_EQ(played.failure->problems[0].place.line, line_of(played.text, "while true"))
      << to_text(*played.failure);
}

TEST(Demo, RehearsedInAWorldFindsPlacesOutOfReach) {
  struct Case {
    const char *demo, *at;
  };
  for (const Case& demo :
       {Case{"\nt.left:move_to({ 300 * mm, 0, -300 * mm })", "move_to"},
        Case{"t:together(function() t.left:move_by({ 0, 0, -100 * mm }) end,\n"
             "function() t.right:close() end)\n"
             "t.left:move_by({ 0, 0, -299 * mm })",
             "-299"},
        Case{"", nullptr}, Case{"t.left:move_by({ 0, 0, -100 * mm })", nullptr},
        Case{"while t.left:force() < 99 * N do t.left:move_by({ 0, 0, -30 * mm }) end", nullptr}}) {
    ScenarioText text = with_demo(demo.demo);
    text.scene = scene_at(50);
    const Folder folder;
    const Result<std::unique_ptr<ExerciseScript>> script = load_text(folder, text.text());
    ASSERT_TRUE(script) << to_text(script.failure());
    const World world = World::create(script.value()->definition().scene).value();
    const std::vector<Problem> problems = script.value()->rehearse(world);
    ASSERT_EQ(problems.size(), demo.at != nullptr ? 1u : 0u) << demo.demo;
    if (demo.at == nullptr) continue;
    EXPECT_EQ(problems[0].place.line, line_of(text.text(), demo.at));
    EXPECT_THAT(problems[0].message, ::testing::HasSubstr("from its port"));
  }
}

TEST(Steps, RefuseToWaitInsidePredicates) {
  const Played played =
      play(with_steps("t:step('a', 'A') t:wait_until(function()\n t:wait(1 * s) return true end)"), 50, 1);
  ASSERT_TRUE(played.failure);
  EXPECT_THAT(to_text(*played.failure), ::testing::HasSubstr("inside a predicate"));
}

TEST(Handles, SayWhenTheirSessionHasEndedOrIsNotRunning) {
  ScenarioText text;
  text.head = "local kept";
  text.steps = "kept = t.left t:step('a', 'A') t:wait(0.1 * s)";
  text.demo = "t:wait(0.3 * s)\nif kept and t:time() < 1e3 then local f = kept:force() end";
  const Played played = play(text, 50, 1);
  ASSERT_TRUE(played.failure);
  EXPECT_THAT(to_text(*played.failure), ::testing::HasSubstr("can no longer be used"));
}

TEST(Handles, OfOneKindAreRefusedByTheMethodsOfAnother) {
  for (const char* demo : {"local close = t.left.close close(t)", "local wait = t.wait wait(5)",
                           "local together = t.together together(t.left, print, print)"}) {
    ScenarioText text = with_demo(demo);
    const Played played = play(text, 50, 0.1);
    ASSERT_TRUE(played.failure) << demo;
    EXPECT_EQ(played.failure->kind, FailureKind::scenario) << demo;
  }
}

TEST(Handles, OfTheSimulatorsCoroutinesCannotBeResumed) {
  ScenarioText text;
  text.head = "local mine";
  text.steps = "mine = coroutine.running() t:step('a', 'A') t:wait(1 * s)";
  text.demo = "t:wait(0.1 * s) if mine then print(coroutine.resume(mine)) end t:wait(1 * s)";
  const Played played = play(text, 50, 0.3);
  EXPECT_FALSE(played.failure);
  EXPECT_THAT(played.printed, ::testing::Contains(::testing::HasSubstr("the simulator resumes")));
}

}  // namespace
}  // namespace calot::scheduler_test
