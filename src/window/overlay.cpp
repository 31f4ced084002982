#include "window/overlay.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

namespace calot {
namespace {

const ImVec4 red(0.9f, 0.15f, 0.1f, 1), amber(0.95f, 0.7f, 0.2f, 1), green(0.3f, 0.75f, 0.35f, 1),
    grey(0.65f, 0.65f, 0.65f, 1);
const ImVec2 wide(-1, 0);

void text(const std::string& line) { ImGui::TextUnformatted(line.c_str()); }
void wrapped(const std::string& line) {
  ImGui::PushTextWrapPos(0);
  text(line);
  ImGui::PopTextWrapPos();
}
void coloured(const ImVec4& colour, const std::string& line) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  wrapped(line);
  ImGui::PopStyleColor();
}

std::string clock_text(double time) {
  return fmt::format("{:d}:{:04.1f}", static_cast<int>(time / 60), time - 60 * static_cast<int>(time / 60));
}

/// The recording's: red while steps are taken.
void lay_out_light(bool runs) {
  const float side = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddCircleFilled(ImVec2(at.x + side / 2, at.y + side / 2), 0.4f * side,
                                              ImGui::GetColorU32(runs ? red : grey));
  ImGui::Dummy(ImVec2(side, side));
  ImGui::SameLine();
  coloured(runs ? red : grey, runs ? "recording" : "time stands still");
}

void lay_out_hand(const HandView& hand, bool selected) {
  if (hand.waits) return coloured(grey, "  " + hand.name + " waits outside");
  coloured(selected ? ImVec4(1, 1, 1, 1) : grey,
           fmt::format("{}{}{}", selected ? "> " : "  ", hand.name,
                       hand.holds.empty() ? "" : " holds " + hand.holds));
  if (!(hand.limit > 0)) return;
  const double share = hand.force / hand.limit;
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, share > 1 ? red : share > 0.7 ? amber : green);
  ImGui::ProgressBar(static_cast<float>(std::clamp(share, 0.0, 1.0)), wide,
                     fmt::format("{:.1f} of {:g} N", hand.force, hand.limit).c_str());
  ImGui::PopStyleColor();
}

void lay_out_step(const OverlayState& state, const LiveView& view) {
  text(fmt::format("{} of {}", clock_text(view.time), clock_text(view.time_limit)));
  ImGui::Spacing();
  if (!view.step.empty()) {
    wrapped(fmt::format("{}. {}", view.step_number, view.step));
    if (view.step_limit > 0)
      ImGui::ProgressBar(static_cast<float>(std::clamp(view.step_time / view.step_limit, 0.0, 1.0)), wide,
                         fmt::format("{:.0f} of {:g} s", view.step_time, view.step_limit).c_str());
  }
  if (state.mode == LiveMode::practice && !view.hint.empty()) coloured(amber, view.hint);
}

std::optional<MenuChoice> lay_out_menu(const OverlayState& state) {
  std::optional<MenuChoice> chosen;
  const auto button = [&](const char* label, MenuChoice choice) {
    if (ImGui::Button(label, wide)) chosen = choice;
  };
  if (!state.result.empty()) {
    wrapped(state.result);
    button("Close", MenuChoice::close);
    return chosen;
  }
  button(state.started ? "Go on (click)" : "Begin (click)", MenuChoice::go_on);
  if (state.started) {
    button("Time-out (T)", MenuChoice::time_out);
    button("Bail out: subtotal", MenuChoice::subtotal);
    button("Bail out: convert to open", MenuChoice::convert);
  }
  if (state.started && state.mode == LiveMode::practice) button("Begin again", MenuChoice::restart);
  button(state.mode == LiveMode::exam ? "Give up: scored as it stands" : "Give up", MenuChoice::abandon);
  return chosen;
}

}  // namespace

std::optional<MenuChoice> lay_out(const OverlayState& state, const LiveView& view, float height) {
  ImGui::SetNextWindowPos(ImVec2(0, 0));
  ImGui::SetNextWindowSize(ImVec2(panel_width, height));
  ImGui::Begin("panel", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  if (state.result.empty()) lay_out_light(state.runs);
  wrapped(state.title);
  coloured(grey, to_text(state.mode));
  ImGui::Separator();
  lay_out_step(state, view);
  ImGui::Separator();
  for (std::size_t i = 0; i < view.hands.size(); ++i)
    lay_out_hand(view.hands[i], static_cast<int>(i) == state.selected);
  if (state.out_of_reach) coloured(amber, "The tip cannot go there: it is out of reach of its port.");
  if (!view.last_event.empty()) coloured(grey, view.last_event);
  ImGui::Separator();
  std::optional<MenuChoice> chosen;
  if (state.menu || !state.result.empty()) chosen = lay_out_menu(state);
  ImGui::Separator();
  coloured(
      grey,
      "mouse: tip in the view's plane\nwheel: deeper, back\nleft, right button: close, open\nQ, E: roll\n"
      "Tab: the other hand\nX: exchange the instrument\nC: the laparoscope, and back\nSpace: activate, or "
      "fire\nShift: finely\nEsc: "
      "menu");
  coloured(grey, fmt::format("{:.0f} pictures a second", state.pictures_a_second));
  ImGui::End();
  return chosen;
}

}  // namespace calot
