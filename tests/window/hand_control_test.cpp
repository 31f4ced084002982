// How mouse, keys and gamepads move hands, without a window.

#include "window/hand_control.h"

#include <gmock/gmock.h>

#include <limits>

#include "base/units.h"
#include "render/lens.h"
#include "window/gamepad.h"

namespace calot {
namespace {

std::vector<LiveInstrument> two_instruments() {
  SceneDefinition scene;
  for (const char* port : {"right_subcostal", "epigastric"}) {
    InstrumentDefinition instrument;
    instrument.name = port;
    instrument.port = port;
    scene.instruments.push_back(instrument);
  }
  scene.instruments[1].type = InstrumentType::bipolar_electrode;
  return live_instruments(scene);
}

class Hands : public testing::Test {
 protected:
  Hands() {
    camera.position = Vec3(0, 0, -20e-3);
    camera.direction = Vec3(-0.5, 0.8, -0.4).normalized();
  }
  std::vector<LiveInstrument> instruments = two_instruments();
  std::vector<InstrumentPose> poses = {
      {0.3, 0.2, 0.15, 0, 0.4}, {0.1, -0.2, 0.12, 0, 0}, {0.9, 0, 0.1, 0, 0}};
  HandControl hands{instruments, poses};
  SceneCamera camera;
};

TEST_F(Hands, AMotionInTheViewMovesTheSelectedTipByThatAndNoOther) {
  const Vec3 before = hands.tip(0), other = hands.tip(1);
  HandMotion motion;
  motion.in_view = Vec3(3e-3, 2e-3, 1e-3);
  hands.move(motion, camera);
  const Mat3 axes = camera_axes(camera);
  EXPECT_LT((axes * (hands.tip(0) - before) - motion.in_view).norm(), 1e-12);
  EXPECT_EQ(hands.tip(1), other);
  EXPECT_EQ(hands.input().pose.jaw, 0.4) << "a jaw is left as it was";
  EXPECT_EQ(hands.input().instrument, 0);
}

TEST_F(Hands, TheOtherHandIsHeldWhereItWasLeft) {
  const InstrumentPose left = hands.held(0).pose;
  HandMotion motion;
  motion.next_hand = true;
  motion.in_view = Vec3(1e-3, 0, 0);
  hands.move(motion, camera);
  EXPECT_EQ(hands.selected(), 1);
  EXPECT_EQ(hands.held(0).pose, left);
  motion = {};
  motion.next_hand = true;
  hands.move(motion, camera);
  EXPECT_EQ(hands.selected(), 0);
}

TEST_F(Hands, WhatIsExchangedIsInTheSameHandAndHandsPassOverThoseThatWait) {
  instruments[1].definition.port = instruments[0].definition.port;
  HandControl shared(instruments, poses);
  EXPECT_FALSE(shared.exchange()) << "none waits";
  shared.see(poses, {0, 1, 0}, {0, 0, 0});
  HandMotion motion;
  motion.next_hand = true;
  shared.move(motion, camera);
  EXPECT_EQ(shared.selected(), 0) << "the only one that is in";
  const std::optional<LiveInput> wanted = shared.exchange();
  ASSERT_TRUE(wanted);
  EXPECT_EQ(wanted->instrument, 1);
  EXPECT_EQ(wanted->action, InstrumentAction::exchange);
  poses[0].insertion -= 5e-3;
  shared.see(poses, {0, 1, 0}, {0, 0, 0});
  EXPECT_EQ(shared.selected(), 0) << "not yet";
  poses[1] = poses[0];
  shared.see(poses, {1, 0, 0}, {0, 0, 0});
  EXPECT_EQ(shared.selected(), 1);
  EXPECT_EQ(shared.held(1).pose, poses[0]) << "it goes on from there";
}

TEST_F(Hands, WhatIsDrawnBackForAnotherGoesOnFromWhereItWasDrawnTo) {
  const InstrumentPose deep = hands.held(0).pose;
  for (const bool drawn : {true, true, false}) {  // the last view is of where it stopped
    poses[0].insertion -= 20e-3;
    hands.see(poses, {0, 0, 0}, {drawn, 0, 0});
    EXPECT_EQ(hands.held(0).pose, poses[0]);
  }
  poses[0] = deep;
  hands.see(poses, {0, 0, 0}, {0, 0, 0});
  EXPECT_NE(hands.held(0).pose, deep) << "else a hand's own motion is undone";
}

TEST_F(Hands, OutOfReachTheTipStaysAndThatIsSaid) {
  const Vec3 before = hands.tip(0);
  HandMotion motion;
  motion.in_view = Vec3(0, 0, 1);
  hands.move(motion, camera);
  EXPECT_TRUE(hands.out_of_reach());
  EXPECT_EQ(hands.tip(0), before);
  motion.in_view = Vec3(0, 0, 1e-3);
  hands.move(motion, camera);
  EXPECT_FALSE(hands.out_of_reach());
}

TEST_F(Hands, JawsStopAtTheirEndsAndWhatHasNoneHasNoJawAngle) {
  HandMotion motion;
  motion.jaw = 9;
  hands.move(motion, camera);
  EXPECT_EQ(hands.input().pose.jaw, instruments[0].geometry.jaw_opening);
  motion.jaw = -9;
  hands.move(motion, camera);
  EXPECT_EQ(hands.input().pose.jaw, 0);
  motion.next_hand = true;
  motion.jaw = 1;
  hands.move(motion, camera);
  EXPECT_EQ(hands.input().pose.jaw, 0);
}

TEST_F(Hands, OnlyWhatCarriesCurrentActs) {
  HandMotion motion;
  motion.activate = true;
  hands.move(motion, camera);
  EXPECT_EQ(hands.input().action, InstrumentAction::none) << "a grasper";
  motion.next_hand = true;
  hands.move(motion, camera);
  EXPECT_EQ(hands.input().action, InstrumentAction::activate);
  EXPECT_EQ(hands.held(1).action, InstrumentAction::none) << "let go";
}

TEST_F(Hands, TheLaparoscopeIsTakenAndLeftWithoutLosingTheHand) {
  HandMotion take;
  take.laparoscope = true;
  take.in_view = Vec3(2e-3, 0, 0);
  const InstrumentPose left = hands.held(0).pose;
  const Vec3 before = hands.tip(2);
  hands.move(take, camera);
  EXPECT_EQ(hands.selected(), 2);
  EXPECT_EQ(hands.input().instrument, 2);
  EXPECT_LT((camera_axes(camera) * (hands.tip(2) - before) - take.in_view).norm(), 1e-12);
  EXPECT_EQ(hands.held(0).pose, left);
  take.in_view = Vec3::Zero();
  take.jaw = 1;
  take.laparoscope = false;
  hands.move(take, camera);
  EXPECT_EQ(hands.input().pose.jaw, 0) << "it has none";
  take.in_view = Vec3(0, 0, 1);
  hands.move(take, camera);
  EXPECT_TRUE(hands.out_of_reach()) << "its shaft ends, as an instrument's";
  HandMotion back;
  back.laparoscope = true;
  hands.move(back, camera);
  EXPECT_EQ(hands.selected(), 0);
}

TEST_F(Hands, WhoHoldsTheLaparoscopeBesidesDoesNotMoveTheSelectedHand) {
  const InstrumentPose left = hands.held(0).pose;
  const Vec3 before = hands.tip(2);
  HandMotion motion;
  motion.in_view = Vec3(0, 3e-3, 0);
  hands.move_laparoscope(motion, camera);
  EXPECT_EQ(hands.selected(), 0);
  EXPECT_EQ(hands.held(0).pose, left);
  EXPECT_NEAR((hands.tip(2) - before).norm(), 3e-3, 1e-12);
}

TEST_F(Hands, UnderThePointerTheViewTurnsAsFarAsThePointerGoes) {
  HandMotion take;
  take.laparoscope = true;
  hands.move(take, camera);
  // At the depth at which a pixel of the lens's way about the port, 0.1 m behind it, is an angle of one in the picture.
  EXPECT_NEAR((hands.grasped(camera) - camera.position).norm(), 0.1, 1e-12);
}

TEST_F(Hands, WhatTheyAskForAnInstrumentCanAlwaysDo) {
  HandMotion motion;
  for (int i = 0; i < 2000; ++i) {
    const double turn = 0.7 * i;
    motion.in_view = 8e-3 * Vec3(std::sin(turn), std::cos(1.3 * turn), std::sin(0.01 * i));
    motion.roll = 0.1;
    motion.jaw = std::sin(0.1 * turn);
    motion.next_hand = i % 50 == 0;
    motion.laparoscope = i % 70 == 0;
    hands.move(motion, camera);
    const LiveInstrument& instrument = instruments[static_cast<std::size_t>(hands.selected())];
    ASSERT_EQ(check_pose("it", instrument.geometry, hands.input().pose), std::nullopt) << i;
  }
}

TEST_F(Hands, ThePointerTakesTheTipAlongAtItsDepth) {
  // The field's edge at 0.1 m of depth lies half the field's pixels from its middle.
  const Vec3 place = camera.position + 0.1 * camera.direction;
  EXPECT_NEAR(metres_a_pixel(camera, place, 600) * 300, 0.1 * std::tan(0.5 * camera.field_of_view), 1e-12);
}

// ---- gamepads

TEST(Gamepad, NothingMovesWithinDeadZonesOrUnderTheClutchAndTriggersRestAtMinusOne) {
  const GamepadMap map;
  GamepadState state;
  const auto still = [&] {
    const HandMotion motion = gamepad_motion(map, state, {}, 0.1);
    return motion.in_view == Vec3::Zero() && motion.roll == 0 && motion.jaw == 0;
  };
  EXPECT_TRUE(still()) << "nobody touches it";
  state.axes = {0.1f, -0.1f, 0.14f, -0.14f, -0.98f, -0.98f};
  EXPECT_TRUE(still());
  state.axes = {1, -1, 0, 0, -1, 1};
  EXPECT_FALSE(still());
  const HandMotion motion = gamepad_motion(map, state, {}, 0.1);
  EXPECT_NEAR(motion.in_view.x(), 6e-3, 1e-12) << "60 mm/s";
  EXPECT_NEAR(motion.in_view.y(), 6e-3, 1e-12) << "up is -1 on a stick";
  EXPECT_NEAR(motion.jaw, -0.2, 1e-12) << "closes";
  state.buttons[static_cast<std::size_t>(map.clutch)] = true;
  EXPECT_TRUE(still());
  state.axes[0] = std::numeric_limits<float>::quiet_NaN();
  state.buttons = {};
  EXPECT_EQ(gamepad_motion(map, state, {}, 0.1).in_view.x(), 0);
}

TEST(Gamepad, AButtonCountsOnceForEachTimeItGoesDown) {
  const GamepadMap map;
  GamepadState state;
  state.buttons[static_cast<std::size_t>(map.next_hand)] = true;
  EXPECT_TRUE(gamepad_motion(map, state, {}, 0.01).next_hand);
  EXPECT_FALSE(gamepad_motion(map, state, state, 0.01).next_hand);
}

TEST(Gamepad, ABailOutTakesTheClutchTooAndATimeOutDoesNot) {
  const GamepadMap map;
  GamepadState state;
  state.buttons[static_cast<std::size_t>(map.time_out)] = true;
  state.buttons[static_cast<std::size_t>(map.bail_out)] = true;
  EXPECT_TRUE(gamepad_motion(map, state, {}, 0.01).time_out);
  EXPECT_FALSE(gamepad_motion(map, state, state, 0.01).time_out) << "once for each press";
  EXPECT_FALSE(gamepad_motion(map, state, {}, 0.01).bail_out) << "a slip ends no operation";
  state.buttons[static_cast<std::size_t>(map.clutch)] = true;
  EXPECT_TRUE(gamepad_motion(map, state, {}, 0.01).bail_out);
}

TEST(Gamepad, ADeviceFileReadsBackAndChangesOnlyWhatItNames) {
  const Result<GamepadMap> same = read_gamepad_map(gamepad_map_text({}), "pad.json");
  ASSERT_TRUE(same) << to_text(same.failure());
  EXPECT_EQ(gamepad_map_text(same.value()), gamepad_map_text({}));
  const Result<GamepadMap> other = read_gamepad_map(
      R"({"schema":"calot.device/1","axes":{"roll":{"axis":"left_x","deg_s":90}},"buttons":{"clutch":"x"}})",
      "pad.json");
  ASSERT_TRUE(other) << to_text(other.failure());
  EXPECT_EQ(other->roll.axis, 0);
  EXPECT_NEAR(other->roll.speed, 90 * units::deg, 1e-12);
  EXPECT_EQ(other->roll.dead_zone, GamepadMap().roll.dead_zone);
  EXPECT_EQ(other->clutch, 2);
  EXPECT_EQ(other->up.speed, GamepadMap().up.speed);
}

TEST(Gamepad, WhatIsWrongWithADeviceFileIsSaidAllAtOnce) {
  const Result<GamepadMap> wrong = read_gamepad_map(
      R"({"schema":"calot.device/1","axes":{"role":{},"up":{"axis":"left_z","dead_zone":2}},"buttons":{"clutch":"q"}})",
      "pad.json");
  ASSERT_FALSE(wrong);
  const std::string text = to_text(wrong.failure());
  for (const char* said : {"pad.json", "role", "axes.up.axis", "left_z", "dead_zone", "buttons.clutch"})
    EXPECT_THAT(text, testing::HasSubstr(said));
  EXPECT_FALSE(read_gamepad_map("{", "pad.json"));
  EXPECT_FALSE(read_gamepad_map(R"({"schema":"calot.device/2"})", "pad.json"));
  EXPECT_FALSE(read_gamepad_map("[]", "pad.json"));
}

}  // namespace
}  // namespace calot
