#pragma once
// What a frame is, held against its golden. The state hash is compared first: if it differs, physics changed (or what else
// decides bits, which the sidecar names); if only pixels differ, rendering changed; a different hash with equal pixels passes
// with a notice when the make differs and fails otherwise.

#include <optional>
#include <string>

#include "goldens/store.h"

namespace calot {

enum class Verdict {
  same,
  same_picture,
  physics_changed,
  rendering_changed,
  missing,      ///< no golden is stored
  unreadable,   ///< its files are broken
  stale,        ///< the scenario declares no such frame
  no_scenario,  ///< the scenario is gone
  not_played,   ///< the session ended before
};

/// "same", "same picture", "physics changed", "rendering changed", "missing", "unreadable", "stale", "no scenario",
/// "not played".
std::string to_text(Verdict verdict);

struct Judgement {
  Verdict verdict = Verdict::same;
  bool passed = true;
  std::string message;                        ///< one sentence
  std::optional<ImageDifference> difference;  ///< where both pictures exist and have one size
};

/// Holds a frame against its golden; `actual` is the frame as a golden. Exactly where both were made alike,
/// else by the golden's tolerance; a pass by tolerance carries a message.
Judgement judge(const Golden& golden, const Golden& actual);

}  // namespace calot
