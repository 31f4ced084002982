#pragma once
// What can happen in a session, one row a kind: who raises it says the kind, and score, report, metrics and reference
// know the rest from here.

#include <optional>
#include <string>
#include <vector>

#include "geometry/state_members.h"

namespace calot {

enum class EventKind {
  contact,
  grasp,
  empty_grasp,
  release,
  slip,
  activation,
  overforce,
  overstretch,
  tear,
  parted,
  divided,
  dry_activation,
  clip,
  clip_dropped,
  cut,
  cut_unclipped,
  perforation,
  cut_liver,
  empty_cut,
  injury,
  activation_on_clip,
  activation_beside,
  time_out,
  bail_out,
  bile_leak,
  bleeding,
  leak_stopped,
  exchange,
  blocked_exchange,
  puncture,
  aspirated,
  empty_aspiration,
  clash,
  step_done,
  step_timeout,
  step_missed,
  raw_surface,
  turn,
};
constexpr EventKind last_of(EventKind) { return EventKind::turn; }

struct EventRow {
  EventKind kind;
  const char* name;
  const char* doc;
  const char*
      value;  ///< what its value is, with the unit, as the report's key: "force_N"; empty: it has none
  bool of_instrument, of_organ;
  bool error = false;  ///< who operates well does not cause it, whatever the exercise
};

/// What did it.
enum class EventCause { none, blades, current, clip, pinch, stretch, opening, slipping, thrust };
constexpr EventCause last_of(EventCause) { return EventCause::thrust; }
/// "scissors", "current", "clip", "pinch", "overstretch", "opened", "slipped", "thrust"; of none empty.
std::string to_text(EventCause cause);
std::optional<EventCause> event_cause_called(const std::string& name);
/// But for none.
std::vector<std::string> event_cause_names();

/// In the order of the kinds.
const std::vector<EventRow>& event_rows();
const EventRow& event_row(EventKind kind);
std::string to_text(EventKind kind);
std::optional<EventKind> event_called(const std::string& name);
std::vector<std::string> event_names();
inline bool ends_a_step(EventKind kind) {
  return kind == EventKind::step_done || kind == EventKind::step_timeout || kind == EventKind::step_missed;
}

struct WorldEvent {
  EventKind kind = EventKind::contact;
  double time = 0;                 ///< s
  std::string instrument;          ///< may be empty
  std::string organ;               ///< or tissue; may be empty
  double value = 0;                ///< as the kind's row says, else 0
  std::optional<Vec3> place = {};  ///< m, patient's frame; none where it has none or it is not known
  EventCause cause = EventCause::none;
  std::string text = {};  ///< an injury's class; what was said at a time-out or a bail-out
};
void visit_members(auto&& visit, MembersOf<WorldEvent> auto& event) {
  auto& [kind, time, instrument, organ, value, place, cause, text] = event;
  visit(kind, time, instrument, organ, value, place, cause, text);
}

}  // namespace calot
