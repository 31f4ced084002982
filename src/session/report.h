#pragma once
// The report of a session as versioned JSON. Field names carry their unit; a reader may rely on every key of
// schema calot.report/1, and ignores keys it does not know.

#include <string>

#include "session/attempt.h"
#include "session/exercise.h"
#include "session/json.h"
#include "session/live.h"
#include "session/runner.h"
#include "session/scoring.h"

namespace calot {

struct SessionReport {
  Score score;
  bool aborted = false;  ///< the session was cut: its parts are kept, but it has no total
  /// Whether there is a total: it came to its end, and the exercise has a score.
  bool has_total() const { return !aborted && !score.parts.empty(); }
  double start_to_first_frame_s = -1;  ///< of the process; negative: no frame was drawn
  std::optional<LiveFigures> live;     ///< of a session that was operated
  Attempt attempt;                     ///< who operated, when and by what
};

/// Total (null unless `has_total`), outcome, steps, the gates that were tripped (of these, critical events once more) and
/// parts, each with its reason.
OrderedJson score_json(const ExerciseDefinition& exercise, const Score& score, bool has_total);

/// Pretty-printed, keys in a fixed order, with a final line end.
std::string report_json(const ExerciseDefinition& exercise, const SessionResult& session,
                        const SessionReport& report);

/// The session's events, a row each (RFC 4180): time_s, event, step, instrument, organ, value, unit, x_mm, y_mm, z_mm,
/// cause, text. What there is none of is empty.
std::string events_csv(const Progress& progress);

/// Simulated seconds a wall-clock second, frames included: above 1 is faster than real time.
double real_time_factor(const SessionResult& session);

}  // namespace calot
