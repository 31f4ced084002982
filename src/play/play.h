#pragma once
// Plays one scenario from file to report: what run, replay and golden share.

#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "render/image.h"
#include "render/scene.h"
#include "session/exercise.h"
#include "session/live.h"
#include "session/recording.h"
#include "session/report.h"
#include "session/runner.h"

namespace calot {

/// A picture as it comes; nobody keeps it.
struct Frame {
  std::string name;  ///< "t010.00s" at a golden time, a golden moment's name, "end" at the end
  double time = 0;   ///< s
  std::uint64_t state_hash = 0, source_hash = 0;
  std::string renderer;  ///< what drew it
  Image image;
};

struct PlayRequest {
  std::filesystem::path scenario;
  std::map<std::string, std::string> params;
  std::uint64_t seed = 1;
  int threads = 1;       ///< that share the work of a step: no bit depends on it
  bool dry_run = false;  ///< read and check the scenario, and play nothing: what comes of it is then empty
  bool render = true, end_frame = true;
  bool golden_pictures = true;                             ///< draw those of the exercise
  double until = std::numeric_limits<double>::infinity();  ///< s: the session ends then as if its source had
  int width = 960, height = 540;                           ///< px
  std::vector<double> at;                                  ///< s, of pictures besides the golden ones
  bool write = false;  ///< write report, frames, table and recording into `output`
  std::filesystem::path
      output;                 ///< folder, of which an earlier session's files are replaced; empty: out/<id>
  bool overwrite = false;     ///< without `output`: replace what out/<id> holds instead of taking out/<id>-2
  bool show_progress = true;  ///< on a terminal
  bool profile = false;       ///< write profile.csv and profile.svg too (session/step_profile.h)
  const Recording* replay = nullptr;  ///< play these inputs instead of the scenario's demo
  LiveSource* live = nullptr;         ///< let these hands move the instruments instead
  /// Who operates, and by what; the session, its time and its machine are play's to name. A replay keeps its recording's.
  Attempt attempt = {.source = "demo"};
  /// Called at rest and after each step.
  std::function<void(const World&, const Progress&)> on_state;
  /// Called with the scene of each golden frame, before it is drawn.
  std::function<void(const Scene&, const std::string& frame)> on_scene;
  /// Asked at rest, after each step and at the end: what a picture of that state is to be called; empty: none is drawn.
  std::function<std::string(const Progress&)> moment;
  /// Called with each picture when it has been drawn; after a failure none is drawn, and play fails with it.
  std::function<std::optional<Failure>(const Frame&)> on_picture;
};

struct Played {
  ExerciseDefinition exercise;
  SessionResult session;
  SessionReport report;
  std::string json;                   ///< the report
  std::vector<std::string> pictures;  ///< their frames' names
  bool rendered = false;
  std::filesystem::path output;  ///< where it was written; empty: nowhere
};

/// When a picture is drawn, and what it is called.
struct GoldenFrame {
  double time = 0;  ///< s
  std::string name;
};
/// An exercise's golden times and those `at` (s) besides, ascending; of those that round to the same hundredth of a
/// second, the first.
std::vector<GoldenFrame> golden_frames(const ExerciseDefinition& exercise, const std::vector<double>& at);
/// What all of an exercise's golden pictures are called: those at times, then those at moments.
std::vector<std::string> golden_names(const ExerciseDefinition& exercise);

/// A scenario's path as others can use it: below the project, else below the present folder, else its file's name.
std::string portable_path(const std::filesystem::path& scenario);

/// Reads and checks a scenario, with the project's modules and assets.
Result<std::unique_ptr<ExerciseScript>> load_scenario(const PlayRequest& request);
/// Whether a file runs and returns something that is no exercise.
bool is_module(const std::filesystem::path& file);

/// Reads and checks a scenario without playing it.
Result<ExerciseDefinition> load_definition(const std::filesystem::path& scenario);

/// Fails where no session could be played; a session that failed on its way is a value (see session.end).
Result<Played> play(const PlayRequest& request);

}  // namespace calot
