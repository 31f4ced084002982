#include "window/gamepad.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/suggest.h"
#include "base/units.h"
#include "session/json_fields.h"

namespace calot {
namespace {

constexpr const char* device_schema = "calot.device/1";
constexpr int first_trigger = 4;

struct AxisRow {
  const char* name;
  AxisUse GamepadMap::*use;
  const char* speed;  ///< its key
  double unit;
};
constexpr double mm_s = 1e-3, deg_s = units::deg;
const std::array axis_rows = {
    AxisRow{"right", &GamepadMap::right, "mm_s", mm_s},   AxisRow{"up", &GamepadMap::up, "mm_s", mm_s},
    AxisRow{"deeper", &GamepadMap::deeper, "mm_s", mm_s}, AxisRow{"roll", &GamepadMap::roll, "deg_s", deg_s},
    AxisRow{"close", &GamepadMap::close, "deg_s", deg_s}, AxisRow{"open", &GamepadMap::open, "deg_s", deg_s}};
const std::array<std::pair<const char*, int GamepadMap::*>, 8> button_rows = {
    {{"clutch", &GamepadMap::clutch},
     {"next_hand", &GamepadMap::next_hand},
     {"laparoscope", &GamepadMap::laparoscope},
     {"activate", &GamepadMap::activate},
     {"exchange", &GamepadMap::exchange},
     {"menu", &GamepadMap::menu},
     {"time_out", &GamepadMap::time_out},
     {"bail_out", &GamepadMap::bail_out}}};

/// Place of a name in a list; says so where it is none.
int place_of(JsonFields& fields, const std::string& key, const std::vector<std::string>& names) {
  const std::string name = fields.text(key);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  fields.wrong(key, fmt::format("is \"{}\"; {}", shortened(name, 40), suggestion(name, names)));
  return -1;
}

void read_axis(const Json& json, const AxisRow& row, AxisUse& use, std::vector<std::string>& problems) {
  JsonFields fields(json, problems, std::string("axes.") + row.name + ".");
  if (fields.has("axis")) use.axis = place_of(fields, "axis", gamepad_axes());
  if (fields.has("dead_zone")) use.dead_zone = fields.number("dead_zone", 0, 0.9);
  if (fields.has(row.speed)) use.speed = row.unit * fields.number(row.speed, -1000, 1000);
  fields.expect_no_others();
}

/// From its rest (0) to its end (1), the dead zone taken off.
double deflection(const AxisUse& use, const GamepadState& state) {
  if (use.axis < 0) return 0;
  double value = state.axes[static_cast<std::size_t>(use.axis)];
  if (!std::isfinite(value)) return 0;
  if (use.axis >= first_trigger) value = 0.5 * (value + 1);
  const double size = std::min(1.0, std::abs(value));
  if (size <= use.dead_zone) return 0;
  return std::copysign((size - use.dead_zone) / (1 - use.dead_zone), value);
}

}  // namespace

const std::vector<std::string>& gamepad_axes() {
  static const std::vector<std::string> names = {"left_x",  "left_y",       "right_x",
                                                 "right_y", "left_trigger", "right_trigger"};
  return names;
}

const std::vector<std::string>& gamepad_buttons() {
  static const std::vector<std::string> names = {
      "a",     "b",          "x",           "y",       "left_bumper", "right_bumper", "back",     "start",
      "guide", "left_thumb", "right_thumb", "dpad_up", "dpad_right",  "dpad_down",    "dpad_left"};
  return names;
}

Result<GamepadMap> read_gamepad_map(const std::string& text, const std::string& file) {
  std::vector<std::string> problems;
  std::string broken;
  GamepadMap map;
  const Json json = parse_json(text, broken);
  if (!broken.empty()) {
    problems.push_back(broken);
  } else {
    JsonFields fields(json, problems);
    if (const std::string schema = fields.text("schema"); problems.empty() && schema != device_schema)
      fields.wrong("schema", fmt::format("is not {}", device_schema));
    const Json axes = fields.has("axes") ? fields.any("axes") : Json::object();
    JsonFields uses(axes, problems, "axes.");
    for (const AxisRow& row : axis_rows)
      if (uses.has(row.name)) read_axis(uses.any(row.name), row, map.*row.use, problems);
    uses.expect_no_others();
    const Json pressed = fields.has("buttons") ? fields.any("buttons") : Json::object();
    JsonFields buttons(pressed, problems, "buttons.");
    for (const auto& [name, button] : button_rows)
      if (buttons.has(name)) map.*button = place_of(buttons, name, gamepad_buttons());
    buttons.expect_no_others();
    fields.expect_no_others();
  }
  if (problems.empty()) return map;
  Failure failure{FailureKind::usage, {}};
  for (std::string& problem : problems)
    failure.problems.push_back(
        {{file, 0, {}}, std::move(problem), "`calot operate --devices` prints a file to start from"});
  return failure;
}

std::string gamepad_map_text(const GamepadMap& map) {
  OrderedJson json = {
      {"schema", device_schema}, {"axes", OrderedJson::object()}, {"buttons", OrderedJson::object()}};
  for (const AxisRow& row : axis_rows) {
    const AxisUse& use = map.*row.use;
    json["axes"][row.name] = {{"axis", gamepad_axes()[static_cast<std::size_t>(use.axis)]},
                              {"dead_zone", use.dead_zone},
                              {row.speed, std::round(use.speed / row.unit)}};
  }
  for (const auto& [name, button] : button_rows)
    json["buttons"][name] = gamepad_buttons()[static_cast<std::size_t>(map.*button)];
  return json_text(json);
}

HandMotion gamepad_motion(const GamepadMap& map, const GamepadState& state, const GamepadState& before,
                          double dt) {
  const auto down = [](const GamepadState& pad, int button) {
    return button >= 0 && pad.buttons[static_cast<std::size_t>(button)];
  };
  const auto way = [&](const AxisUse& use) { return use.speed * deflection(use, state) * dt; };
  HandMotion motion;
  const auto pressed = [&](int button) { return down(state, button) && !down(before, button); };
  motion.next_hand = pressed(map.next_hand);
  motion.laparoscope = pressed(map.laparoscope);
  motion.exchange = pressed(map.exchange);
  motion.activate = down(state, map.activate);
  motion.time_out = pressed(map.time_out);
  motion.bail_out = down(state, map.clutch) && pressed(map.bail_out);
  if (down(state, map.clutch)) return motion;
  motion.in_view = Vec3(way(map.right), way(map.up), way(map.deeper));
  motion.roll = way(map.roll);
  motion.jaw = way(map.open) - way(map.close);
  return motion;
}

}  // namespace calot
