#pragma once
// Golden images: what a frame should look like, with what it takes to know why it does not.
//
// golden/<scenario>/<frame>.png with <frame>.json beside it, where <scenario> is the scenario's path below
// scenarios/ without ".lua" (process/project.h, scenario_name). The state hash is compared first: if it differs, physics
// changed (or what else decides bits, which the sidecar names); if only pixels differ, rendering changed; a different
// hash with equal pixels passes with a notice when the make differs and fails otherwise.

#include <filesystem>
#include <optional>
#include <string>

#include "play/play.h"
#include "render/image_compare.h"

namespace calot {

struct GoldenSidecar {
  int width = 0, height = 0;  ///< px
  double time = 0;            ///< s
  /// For pictures by another renderer, toolchain or instruction set: other processors move some hundred
  /// pixels by 1 of 255. What drew the golden must draw it again exactly.
  CompareTolerance tolerance = {
      .small_delta = 0, .differing_pixels = 500, .large_delta = 2, .blob_pixels = 4};
  std::string renderer;
  std::uint64_t scenario_hash = 0, state_hash = 0;
  Make make;
};

struct Golden {
  GoldenSidecar sidecar;
  Image image;
};

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

/// Reads picture and sidecar; `stem` is the path without extension. Fails (usage) naming the file that is
/// wrong, and every key that is.
Result<Golden> read_golden(const std::filesystem::path& stem);
Result<std::string> write_golden(const std::filesystem::path& stem, const Golden& golden);

/// The golden that this frame would become.
Golden make_golden(const Frame& frame);

/// Holds a frame against its golden; `actual` is the frame as a golden. Exactly where both were made alike,
/// else by the golden's tolerance; a pass by tolerance carries a message.
Judgement judge(const Golden& golden, const Golden& actual);

}  // namespace calot
