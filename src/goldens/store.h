#pragma once
// Golden images: what a frame should look like, with what it takes to know why it does not.
//
// golden/<scenario>/<frame>.png with <frame>.json beside it, where <scenario> is the scenario's path below
// scenarios/ without ".lua" (process/project.h, scenario_name).

#include <filesystem>
#include <optional>
#include <string>

#include "goldens/course.h"
#include "play/play.h"
#include "render/image_compare.h"

namespace calot {

struct GoldenSidecar {
  int width = 0, height = 0;  ///< px
  double time = 0;            ///< s
  /// For pictures by another renderer, toolchain or instruction set. A build for plain x86-64 draws what has not drifted
  /// with up to 768 other pixels, those more than 2 of 255 off in patches of at most 5: this is half as much again. What drew
  /// the golden must draw it again exactly.
  CompareTolerance tolerance = {
      .small_delta = 0, .differing_pixels = 1200, .large_delta = 2, .blob_pixels = 8};
  std::string renderer;
  std::uint64_t scenario_hash = 0, state_hash = 0;
  Make make;
  Course course;  ///< of the session that drew it
};

struct Golden {
  GoldenSidecar sidecar;
  Image image;
};

/// Reads picture and sidecar; `stem` is the path without extension. Fails (usage) naming the file that is
/// wrong, and every key that is.
Result<Golden> read_golden(const std::filesystem::path& stem);
Result<std::string> write_golden(const std::filesystem::path& stem, const Golden& golden);
/// The sidecar alone.
Result<std::string> write_sidecar(const std::filesystem::path& stem, const GoldenSidecar& sidecar);

/// The golden that this frame would become, but for its course, which is known when the session has ended.
Golden make_golden(const Frame& frame);

}  // namespace calot
