#pragma once
// How a gamepad moves a hand: a small file says which stick does what. Nothing here talks to a device.

#include <array>
#include <string>
#include <vector>

#include "window/hand_control.h"

namespace calot {

/// As the system's gamepad mapping gives it: axes from -1 to 1 (triggers: -1 is let go), in the order of their names.
struct GamepadState {
  std::array<float, 6> axes{0, 0, 0, 0, -1, -1};
  std::array<bool, 15> buttons{};
};
const std::vector<std::string>& gamepad_axes();     ///< "left_x", ... "right_trigger"
const std::vector<std::string>& gamepad_buttons();  ///< "a", ... "dpad_left"

/// What an axis does: nothing within its dead zone, then in proportion up to `speed` at its end.
struct AxisUse {
  int axis = -1;            ///< none
  double dead_zone = 0.15;  ///< share of its way
  double speed = 0;         ///< m/s or rad/s at its end; negative: the other way round
};

struct GamepadMap {
  AxisUse right{0, 0.15, 60e-3}, up{1, 0.15, -60e-3}, deeper{3, 0.15, -60e-3}, roll{2, 0.15, 2.5};
  AxisUse close{5, 0.05, 2.0}, open{4, 0.05, 2.0};
  /// Buttons; while the clutch is held the hand stays.
  int clutch = 4, next_hand = 3, laparoscope = 5, activate = 0, exchange = 1, menu = 7, time_out = 11;
  int bail_out = 6;  ///< with the clutch held: nobody ends an operation by a slip
};

/// From a device file's text (JSON, schema calot.device/1); what it leaves out stays as above. Fails (usage) with all that
/// is wrong.
Result<GamepadMap> read_gamepad_map(const std::string& text, const std::string& file);
/// Such a file of this map.
std::string gamepad_map_text(const GamepadMap& map);

/// What it asks for in dt seconds. `before` is its state then, for buttons that count when they go down.
HandMotion gamepad_motion(const GamepadMap& map, const GamepadState& state, const GamepadState& before,
                          double dt);

}  // namespace calot
