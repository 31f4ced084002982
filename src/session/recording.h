#pragma once
// A recording: every input of a session with the state hash it led to, one JSON object a line.
//
//   line 1
//   {"schema":"calot.recording/1","scenario":...,"file":...,"source_hash":...,"seed":...,"params":{...},
//               "rate_Hz":50,"instruments":["left"],"toolchain":...,"instruction_set":...,"state_hash":...}
//   each step  {"time_s":0.02,"poses":[[pitch,yaw,insertion,roll,jaw],...],"state_hash":"..."}   (rad, m)
//   last line  {"end":"done","steps":1234}
//
// Numbers have the fewest digits that read back as the same bits, so a replay is bit-exact. Each line is
// flushed: an interrupted run loses nothing, and a recording without its last line is still a recording.

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "base/status.h"
#include "session/exercise.h"

namespace calot {

struct RecordingHeader {
  std::string scenario;  ///< id
  std::string file;      ///< the scenario's path as the session was given it
  std::uint64_t source_hash = 0;
  std::uint64_t seed = 0;
  std::map<std::string, std::string> params;
  double rate = 0;  ///< steps a second
  std::vector<std::string> instruments;
  std::string toolchain, instruction_set;
  std::uint64_t state_hash = 0;  ///< at rest, before the first step
};

struct RecordedStep {
  double time = 0;  ///< s, at the end of the step
  StepInput input;
  std::uint64_t state_hash = 0;  ///< after the step
};

struct Recording {
  RecordingHeader header;
  std::vector<RecordedStep> steps;
  std::string end;  ///< how the session ended; empty where the last line is missing
};

/// The header for a session about to start.
RecordingHeader recording_header(const ExerciseDefinition& exercise, const World& world);

class RecordingWriter {
 public:
  /// Fails (usage) where the file cannot be written.
  static Result<RecordingWriter> create(const std::string& path, const RecordingHeader& header);
  /// False once a write has failed (disk full).
  bool write(const RecordedStep& step);
  bool finish(const std::string& end);

 private:
  std::ofstream out_;
  int steps_ = 0;
};

/// Failures (usage) name file and line. A last line cut short is dropped, as the run was killed there.
Result<Recording> read_recording(const std::string& path);

/// The inputs of a recording, which must outlive it. Ends with the recording.
class ReplaySource : public InputSource {
 public:
  explicit ReplaySource(const Recording& recording) : recording_(recording) {}
  Result<std::optional<StepInput>> next(const World& world, double dt) override;

 private:
  const Recording& recording_;
  std::size_t step_ = 0;
};

}  // namespace calot
