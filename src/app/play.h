#pragma once
// Plays one scenario from file to report: what run, replay and golden share.

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "render/image.h"
#include "render/scene.h"
#include "session/recording.h"
#include "session/report.h"
#include "session/runner.h"

namespace calot {

struct PlayRequest {
  std::filesystem::path scenario;
  std::map<std::string, std::string> params;
  std::uint64_t seed = 1;
  bool render = true;
  int width = 960, height = 540;      ///< px
  std::vector<double> at;             ///< s, of frames besides the golden ones
  bool write = false;                 ///< write report, frames, table and recording into `output`
  std::filesystem::path output;       ///< folder; empty: out/<scenario id>
  const Recording* replay = nullptr;  ///< play these inputs instead of the scenario's demo
  /// Called with the scene of each golden frame, before it is drawn.
  std::function<void(const Scene&, const std::string& frame)> on_frame;
};

struct Frame {
  std::string name;  ///< "t010.00s" at a golden time, "end" at the end
  double time = 0;   ///< s
  std::uint64_t state_hash = 0;
  Image image;
};

struct Played {
  ExerciseDefinition exercise;
  SessionResult session;
  SessionReport report;
  std::string json;                 ///< the report
  std::vector<double> frame_times;  ///< s, asked for: golden ones and the request's, ascending
  std::vector<Frame> frames;
  std::string renderer;          ///< what drew them; empty without rendering
  std::filesystem::path output;  ///< where it was written; empty: nowhere
};

/// Reads and checks a scenario without playing it.
Result<ExerciseDefinition> load_definition(const std::filesystem::path& scenario);

/// Fails where no session could be played; a session that failed on its way is a value (see session.end).
Result<Played> play(const PlayRequest& request);

std::string frame_name(double golden_time);

}  // namespace calot
