#pragma once
// The window in which a person operates: picture, what is asked, forces, menu. It fills the mailbox of a session that
// runs in another thread, and shows what that puts up to be seen. Use it from the process's main thread.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/offscreen.h"
#include "window/gamepad.h"
#include "window/live_view.h"

namespace calot {

struct WindowOptions {
  std::string title;
  int width = 0, height = 0;                      ///< px, of the window; 0: as the picture and the panel need
  int picture_width = 960, picture_height = 540;  ///< px, of the picture that is drawn and scaled
  std::optional<DrawQuality> quality;             ///< none: live where a processor draws, else golden
  LiveMode mode = LiveMode::practice;
  std::vector<LiveInstrument> instruments;
  GamepadMap gamepad;
};

/// What mouse and keys did since the last turn.
struct WindowEvents {
  double right = 0, down = 0;  ///< px, of the pointer
  double wheel = 0;            ///< notches, away from the hand
  bool next_hand = false, laparoscope = false, exchange = false, menu = false, click = false;
  bool time_out = false, bail_out = false;
};

struct DeviceRow {
  std::string name;
  bool usable = false;  ///< has a gamepad mapping
};

class OperateWindow {
 public:
  /// Fails (resource) without a display or OpenGL 3.3, and says what to do; internal where a shader does not compile.
  static Result<OperateWindow> open(WindowOptions options, LiveMailbox& mailbox);
  OperateWindow(OperateWindow&&) noexcept;
  OperateWindow& operator=(OperateWindow&&) noexcept;
  ~OperateWindow();

  /// One turn: events, hands into the mailbox, picture. `newest` may be null: the picture stays. False once the window is
  /// closed; until the session is over that gives it up.
  Result<bool> turn(std::shared_ptr<const LiveView> newest);
  /// The session is over, and this is what came of it: it is shown until the window is closed.
  void set_result(const std::string& lines);

  /// Events to come, added to those of the devices: as if somebody had moved.
  WindowEvents& events();
  /// As the menu's first button does.
  void go_on();
  /// Ends a turn that waits for something to happen; from any thread, while a window is open.
  static void wake();
  /// As who closes the window.
  void close();
  /// The window's picture as it is shown, without the panel.
  Image shown() const;
  std::string description() const;  ///< what draws
  bool in_software() const;         ///< a processor does, no graphics card
  const DrawQuality& quality() const;

 private:
  struct Impl;
  explicit OperateWindow(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// What is plugged in. Fails (resource) without a display.
Result<std::vector<DeviceRow>> list_devices();

}  // namespace calot
