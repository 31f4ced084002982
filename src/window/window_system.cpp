#include "window/window_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "window/operate_window.h"

namespace calot {
namespace {

constexpr std::size_t most_gamepads = 2;

std::string last_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason is given";
}

}  // namespace

Failure no_window(const std::string& what) {
  return fail(
      FailureKind::resource, fmt::format("{}: {}", what, last_error()),
      "on a machine with a screen set DISPLAY; else move the instruments by a program, with --no-window and "
      "--input, or call `xvfb-run calot operate ...` to try the window without a screen");
}

Result<std::shared_ptr<Glfw>> Glfw::start() {
  if (glfwInit() != GLFW_TRUE) return no_window("no window can be opened");
  return std::shared_ptr<Glfw>(new Glfw);
}

Glfw::~Glfw() { glfwTerminate(); }

bool WindowContext::make_current() {
  if (glfwGetCurrentContext() != window_) glfwMakeContextCurrent(window_);
  return glfwGetCurrentContext() == window_;
}

GlLoader WindowContext::loader() const { return &glfwGetProcAddress; }

GLFWwindow* make_window(int width, int height, const std::string& name) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  GLFWwindow* window = glfwCreateWindow(width, height, name.c_str(), nullptr, nullptr);
  if (window != nullptr) glfwMakeContextCurrent(window);
  return window;
}

std::vector<GamepadState> read_gamepads() {
  std::vector<GamepadState> pads;
  for (int pad = GLFW_JOYSTICK_1; pad <= GLFW_JOYSTICK_LAST && pads.size() < most_gamepads; ++pad) {
    GLFWgamepadstate raw;
    if (glfwJoystickIsGamepad(pad) != GLFW_TRUE || glfwGetGamepadState(pad, &raw) != GLFW_TRUE) continue;
    GamepadState& state = pads.emplace_back();
    std::copy(std::begin(raw.axes), std::end(raw.axes), state.axes.begin());
    for (std::size_t i = 0; i < state.buttons.size(); ++i) state.buttons[i] = raw.buttons[i] == GLFW_PRESS;
  }
  return pads;
}

Result<std::vector<DeviceRow>> list_devices() {
  const Result<std::shared_ptr<Glfw>> library = Glfw::start();
  if (!library) return library.failure();
  std::vector<DeviceRow> rows;
  for (int pad = GLFW_JOYSTICK_1; pad <= GLFW_JOYSTICK_LAST; ++pad) {
    if (glfwJoystickPresent(pad) != GLFW_TRUE) continue;
    const bool usable = glfwJoystickIsGamepad(pad) == GLFW_TRUE;
    const char* name = usable ? glfwGetGamepadName(pad) : glfwGetJoystickName(pad);
    rows.push_back({name != nullptr ? name : "without a name", usable});
  }
  return rows;
}

}  // namespace calot
