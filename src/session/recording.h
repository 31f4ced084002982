#pragma once
// A recording: every input of a session with the state hash it led to, one JSON object a line.
//
//   line 1
//   {"schema":"calot.recording/3","scenario":...,"file":...,"source_hash":...,"exercise_hash":...,"measures":2,"scoring":2,
//               "seed":...,"params":{...},"rate_Hz":50,"instruments":["left"],"session":...,"source":"window",
//               "mode":"practice","trainee":...,"attempt":1,"began":...,"machine":...,"toolchain":...,"instruction_set":...,
//               "mathematics":...,"state_hash":...}
//   each step  {"time_s":0.02,"poses":[[pitch,yaw,insertion,roll,jaw],...],"actions":["activate",...],
//               "laparoscope":[pitch,yaw,insertion,roll],"acts":[{"act":"time_out","text":"landmarks named"}],
//              "state_hash":"..."}
//              (rad, m; actions where an instrument acts, "none" for one that does not; the laparoscope where it moves;
//              acts, time_out and bail_out, where there are some)
//   then       {"measured":{"metrics":{...},"steps":[...],"events":[...],"noted":[...],"notes":[...]}}
//   last line  {"end":"done","steps":1234,"checksum":"..."}   (of all the text before; the end as to_text(SessionEnd), or
//              "cut" of the replay of a recording without this line)
//
// measures and scoring are versions (session/metrics.h, session/scoring.h): by which rules the session was measured and
// its report scored. session to machine are session/attempt.h's; each is left out where it is not known.
//
// What was measured (session/measured.h) may be missing, as in recordings made before it was written: it is found again
// by a replay.
//
// Poses that come from elsewhere need schema, scenario, rate_Hz, instruments and, in each step, time_s and poses; what
// has no state hash is played and not compared.
//
// Older ones are read too. calot.recording/2 has nothing of session to machine but the mode, and was measured and scored by
// version 1; its exercise_hash stands with what was measured. calot.recording/1 has no actions either.
//
// Numbers have the fewest digits that read back as the same bits, so a replay is bit-exact. Each line is
// flushed: an interrupted run loses nothing. A recording without its last line is still a recording, of a run that was
// cut: cut_note says so.

#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/status.h"
#include "session/attempt.h"
#include "session/build_info.h"
#include "session/exercise.h"
#include "session/measured.h"

namespace calot {

struct RecordingHeader {
  std::string scenario;  ///< id
  /// Where the scenario is: below its project or the folder it was played from, else its file's name. May be empty.
  std::string file;
  std::optional<std::uint64_t> source_hash;
  std::optional<std::uint64_t> exercise_hash;  ///< exercise_hash() of what was played
  int measures = 0, scoring = 0;               ///< versions; 0: not said
  std::uint64_t seed = 1;
  std::map<std::string, std::string> params;
  double rate = 0;  ///< steps a second
  std::vector<std::string> instruments;
  Attempt attempt;                          ///< parts may be empty
  Make make;                                ///< parts may be empty
  std::optional<std::uint64_t> state_hash;  ///< at rest, before the first step; without one no step has one
  int version = 3;                          ///< of the schema that it was read from
};

struct RecordedStep {
  double time = 0;  ///< s, at the end of the step
  StepInput input;
  std::optional<std::uint64_t> state_hash;  ///< after the step
};

struct Recording {
  RecordingHeader header;
  std::vector<RecordedStep> steps;
  std::optional<Measured> measured;  ///< of a whole recording only
  std::string end;                   ///< how the session ended; empty where the last line is missing
  std::uint64_t text_hash = 0;       ///< of the lines that were read
};

/// The session's number; of a recording that names none, digits that its text decides, so that copies have the same.
std::string session_of(const Recording& recording);

/// The end of what was played from a recording without one.
inline constexpr const char* cut_end = "cut";
/// Whether a session that ended so was not broken off.
bool came_to_its_end(const std::string& end);
/// Where a recording without an end stops, or what was played from one; none for others.
std::optional<std::string> cut_note(const Recording& recording);

/// The header for a session about to start, by this program's rules; `file` is the scenario's path as it is to be recorded.
RecordingHeader recording_header(const ExerciseDefinition& exercise, const World& world,
                                 const std::string& file, const Attempt& attempt = {});

class RecordingWriter {
 public:
  /// Fails (usage) where the file cannot be written.
  static Result<RecordingWriter> create(const std::string& path, const RecordingHeader& header);
  /// False once a write has failed (disk full).
  bool write(const RecordedStep& step);
  /// After the last step. Left out where it would be longer than a reader takes.
  bool write(const Measured& measured);
  bool finish(const std::string& end);

 private:
  bool add_line(const std::string& line);

  std::ofstream out_;
  Hash written_;
  int steps_ = 0;
};

/// Failures (usage) name file, line and byte. A last line cut short is dropped, as the run was killed there.
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
