#pragma once
// What is written beside the picture, and the menu.

#include <optional>
#include <string>

#include "window/live_view.h"

namespace calot {

struct OverlayState {
  std::string title;  ///< of the exercise
  LiveMode mode = LiveMode::practice;
  int selected = 0;
  bool out_of_reach = false, menu = true, started = false;
  bool runs = false;   ///< steps are taken, and recorded
  std::string result;  ///< lines; not empty: the session is over
  double pictures_a_second = 0;
};

enum class MenuChoice { go_on, time_out, subtotal, convert, restart, abandon, close };

inline constexpr float panel_width = 290;  ///< px

/// Lays out this frame; the menu's button that was pressed.
std::optional<MenuChoice> lay_out(const OverlayState& state, const LiveView& view, float height);

}  // namespace calot
