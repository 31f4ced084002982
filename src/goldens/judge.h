#pragma once
// What a frame is, held against its golden. The state hash is compared first: if it differs, physics changed (or what else
// decides bits, which the sidecar names); if only pixels differ, rendering changed; a different hash with equal pixels passes
// with a notice when the make differs and fails otherwise. Where bits cannot be equal and the picture differs beyond its
// tolerance, what became of the session decides.

#include <optional>
#include <string>

#include "goldens/store.h"

namespace calot {

enum class Verdict {
  same,
  same_picture,
  drifted,  ///< other bits moved it beyond the tolerance, or ended the session before: its course decides
  physics_changed,
  rendering_changed,
  missing,      ///< no golden is stored
  unreadable,   ///< its files are broken
  stale,        ///< the scenario declares no such frame
  no_scenario,  ///< the scenario is gone
  not_played,   ///< the session ended before
};

/// "same", "same picture", "drifted", "physics changed", "rendering changed", "missing", "unreadable", "stale", "no scenario",
/// "not played".
std::string to_text(Verdict verdict);

struct Judgement {
  Verdict verdict = Verdict::same;
  bool passed = true;
  std::string message;                        ///< one sentence
  std::optional<ImageDifference> difference;  ///< where both pictures exist and have one size
};

/// Holds a frame against its golden; `actual` is the frame as a golden. Exactly where both were made alike,
/// else by the golden's tolerance; a pass by tolerance carries a message. What drifted has not passed yet.
Judgement judge(const Golden& golden, const Golden& actual);

/// A frame that was not drawn, as its session ended before; of other bits it drifted.
Judgement judge_undrawn(const Golden& golden, const SessionResult& session);

/// What drifted passes where its session did all steps and took the golden's course (same_course).
void judge_course(Judgement& drifted, const Course& golden, const Course& here, const SessionResult& session);

}  // namespace calot
