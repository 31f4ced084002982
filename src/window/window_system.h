#pragma once
// What the window system gives: a window with OpenGL, and what is plugged in. The only header that needs GLFW's.

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <memory>
#include <string>
#include <vector>

#include "render/gl_context.h"
#include "window/gamepad.h"

namespace calot {

/// Why there is no window (resource), and what to do.
Failure no_window(const std::string& what);

/// GLFW as long as somebody needs it.
class Glfw {
 public:
  static Result<std::shared_ptr<Glfw>> start();
  Glfw(const Glfw&) = delete;
  Glfw& operator=(const Glfw&) = delete;
  ~Glfw();

 private:
  Glfw() = default;
};

/// A window whose OpenGL 3.3 is current, or none.
GLFWwindow* make_window(int width, int height, const std::string& name);

class WindowContext : public GlContext {
 public:
  explicit WindowContext(GLFWwindow* window) : window_(window) {}
  bool make_current() override;
  GlLoader loader() const override;

 private:
  GLFWwindow* window_;
};

/// Of the first two there are: the surgeon's, and that of who holds the laparoscope.
std::vector<GamepadState> read_gamepads();

}  // namespace calot
