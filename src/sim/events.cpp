#include "sim/events.h"

#include <algorithm>

namespace calot {

const std::vector<EventRow>& event_rows() {
  using enum EventKind;
  static const std::vector<EventRow> rows = {
      {contact, "contact", "an instrument begins to touch tissue", "", true, true},
      {grasp, "grasp", "jaws close on a fold and hold it", "", true, true},
      {empty_grasp, "empty_grasp", "jaws close and hold nothing", "", true, false},
      {release, "release", "what was held is let go, by opening or because it slipped off", "", true, true},
      {slip, "slip", "what is held begins to slide through the jaws; with the pull that does it", "force_N",
       true, true},
      {activation, "activation", "current begins to flow in an instrument; with the organ it touches", "",
       true, true},
      {overforce, "overforce", "the force on an instrument rises above its force_limit", "force_N", true,
       true},
      {overstretch, "overstretch", "an organ's wall is stretched beyond its overstretch", "stretch", false,
       true},
      {tear, "tear", "strands of a tissue begin to tear; with the share of them that is torn", "share", false,
       true},
      {parted, "parted", "the last strand of a tissue is torn", "", false, true},
      {divided, "divided", "strands of a tissue are divided by an instrument's current; with their area",
       "area_mm2", true, true},
      {dry_activation, "dry_activation",
       "current has flowed in an instrument for a quarter of a second while it touched nothing", "", true,
       false},
      {step_done, "step_done", "a step of the exercise ends as done", "duration_s", false, false},
      {step_timeout, "step_timeout", "a step of the exercise reaches its limit", "duration_s", false, false},
  };
  return rows;
}

const EventRow& event_row(EventKind kind) { return event_rows()[static_cast<std::size_t>(kind)]; }

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
