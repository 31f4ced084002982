#include "tools/events.h"

#include <algorithm>

namespace calot {

const std::vector<EventRow>& event_rows() {
  using enum EventKind;
  static const std::vector<EventRow> rows = {
      {contact, "contact",
       "an instrument, or the end of the laparoscope as it is moved, begins to touch tissue", "", true, true},
      {grasp, "grasp", "jaws close on a fold and hold it", "", true, true},
      {empty_grasp, "empty_grasp", "jaws close and hold nothing", "", true, false, true},
      {release, "release", "what was held is let go, by opening or because it slipped off", "", true, true},
      {slip, "slip", "what is held begins to slide through the jaws; with its pull then", "force_N", true,
       true, true},
      {activation, "activation", "current begins to flow in an instrument; with the organ it touches", "",
       true, true},
      {overforce, "overforce",
       "the force on an instrument's jaws, or on what its shaft ends in, rises above its force_limit; what "
       "leans on its shaft does not count",
       "force_N", true, true, true},
      {overstretch, "overstretch", "an organ's wall is stretched beyond its overstretch", "stretch", false,
       true, true},
      {tear, "tear", "strands of a tissue begin to tear; with the share of them that is torn", "share", false,
       true},
      {parted, "parted", "the last strand of a tissue is torn", "", false, true},
      {divided, "divided", "strands of a tissue are divided by an instrument's current; with their area",
       "area_mm2", true, true},
      {dry_activation, "dry_activation",
       "current has flowed in an instrument for a quarter of a second while it touched nothing", "", true,
       false, true},
      {clip, "clip", "a clip is set on a duct or a vessel; with the share of its width that it leaves open",
       "opening", true, true},
      {clip_dropped, "clip_dropped",
       "a clip falls: fired with no duct or vessel between its legs, or, with the cause slipped, drawn off a "
       "tube's end",
       "", true, false, true},
      {cut, "cut",
       "blades divide a duct or a vessel, at a share of its length, or a share of a tissue's strands",
       "share", true, true},
      {cut_unclipped, "cut_unclipped",
       "what is divided has no shut clip on the patient's side: it was cut before it was clipped", "share",
       true, true, true},
      {perforation, "perforation",
       "a hollow organ's wall is opened: blades close on it, current flows into it, jaws pinch it too hard, "
       "or "
       "it is "
       "stretched too far; its cause says which",
       "", true, true, true},
      {cut_liver, "cut_liver", "blades close on the liver", "", true, true, true},
      {empty_cut, "empty_cut", "blades close and cut nothing", "", true, false, true},
      {injury, "injury",
       "what should be kept is cut, clipped, burnt or thrust at; its text says what that is called (the "
       "injury of the "
       "organ or the ground)",
       "", true, true, true},
      {activation_on_clip, "activation_on_clip",
       "current flows in an instrument that touches a clip: it loosens, and burns what it holds", "", true,
       true, true},
      {activation_beside, "activation_beside",
       "current flows nearer to an organ than its keep_clear; with the distance", "distance_mm", true, true,
       true},
      {time_out, "time_out", "who operates stops and says what has been seen; its text is what was said", "",
       false, false},
      {bail_out, "bail_out",
       "who operates ends the operation otherwise than planned; its text says how: subtotal, convert", "",
       false, false},
      {bile_leak, "bile_leak",
       "bile begins to leave a divided duct or a hole in a wall; at its rate, with what made the opening",
       "rate_mL_min", true, true},
      {bleeding, "bleeding", "a divided artery begins to bleed; at its rate, with what divided it",
       "rate_mL_min", true, true},
      {leak_stopped, "leak_stopped", "a leak or a bleeding is shut or has run dry; with what it lost",
       "lost_mL", false, true},
      {exchange, "exchange", "an instrument comes in through its port; its text says for which", "", true,
       false},
      {blocked_exchange, "blocked_exchange",
       "an instrument cannot come in through its port; its text says why", "", true, false},
      {puncture, "puncture", "a needle that draws is pushed through a hollow organ's wall", "", true, true},
      {aspirated, "aspirated",
       "a needle is drawn out of a hollow organ, or draws no more; with what it drew out", "volume_mL", true,
       true},
      {empty_aspiration, "empty_aspiration",
       "a needle begins to draw and is in nothing hollow: in air, or in the organ that it touches", "", true,
       true},
      {clash, "clash",
       "two instruments begin to press on each other; with the force at the tip, its text says which is met",
       "force_N", true, false},
      {step_done, "step_done", "a step of the exercise ends as done", "duration_s", false, false},
      {step_timeout, "step_timeout", "a step of the exercise reaches its limit", "duration_s", false, false,
       true},
      {step_missed, "step_missed", "a step of the exercise can no longer be done; its text says why",
       "duration_s", false, false, true},
      {raw_surface, "raw_surface",
       "current has taken the capsule off more than 1 mm^2 of the liver in one piece; with that area",
       "area_mm2", true, true, true},
      {turn, "turn",
       "what is held begins to turn about the shaft between the jaws, which hold it on; with its pull then",
       "force_N", true, true},
  };
  return rows;
}

const EventRow& event_row(EventKind kind) { return event_rows()[static_cast<std::size_t>(kind)]; }

namespace {

const std::vector<std::string>& cause_names() {
  static const std::vector<std::string> names = {
      "", "scissors", "current", "clip", "pinch", "overstretch", "opened", "slipped", "thrust"};
  return names;
}

}  // namespace

std::string to_text(EventCause cause) { return cause_names()[static_cast<std::size_t>(cause)]; }

std::optional<EventCause> event_cause_called(const std::string& name) {
  const auto found = std::find(cause_names().begin() + 1, cause_names().end(), name);
  if (found == cause_names().end()) return std::nullopt;
  return static_cast<EventCause>(found - cause_names().begin());
}

std::vector<std::string> event_cause_names() { return {cause_names().begin() + 1, cause_names().end()}; }

std::string to_text(EventKind kind) { return event_row(kind).name; }

std::optional<EventKind> event_called(const std::string& name) {
  const auto found = std::find_if(event_rows().begin(), event_rows().end(),
                                  [&](const EventRow& row) { return row.name == name; });
  return found == event_rows().end() ? std::nullopt : std::optional<EventKind>(found->kind);
}

std::vector<std::string> event_names() {
  std::vector<std::string> names;
  for (const EventRow& row : event_rows()) names.emplace_back(row.name);
  return names;
}

}  // namespace calot
