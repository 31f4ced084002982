#pragma once
// Plays a session: input -> world step -> recording -> events -> script, until the steps have ended.

#include <atomic>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "session/exercise.h"
#include "session/progress.h"
#include "session/recording.h"
#include "session/step_profile.h"
#include "session/step_table.h"
#include "session/trace.h"

namespace calot {

/// Wall-clock times, which no result depends on.
struct SessionTiming {
  double wall_s = 0;        ///< of the loop, frames included
  double simulation_s = 0;  ///< inside World::step
  double slowest_s = 0;  ///< the most of it in any simulated second: of the seconds 0 to 1, 1 to 2 ... begun
  double frames_s = 0;   ///< inside the frame callback
  std::vector<double> step_s;  ///< inside World::step, one a step
  int substeps = 0, newton_iterations = 0;
  int steps_cut_short = 0;   ///< whose motion was not followed to the end (SolveStatistics::cut_short)
  int steps_unbalanced = 0;  ///< that ended in no balance
  double assembly_s = 0, factorisation_s = 0, solve_s = 0, contact_s = 0;
};

/// Called at rest (time 0), after each step. It may look but not touch, so rendering cannot change the state.
using StepObserver = std::function<void(const World& world, const Progress& progress, bool last)>;

struct SessionOptions {
  const std::atomic<bool>* stop = nullptr;  ///< set: the session ends as interrupted before its next step
  bool end_with_source = false;             ///< a replay ends where its recording does
  double until = std::numeric_limits<double>::infinity();  ///< s: the session ends then as if its source had
  /// How that is recorded; empty: as source_ended. Of a replay of what was broken off: how that was.
  std::string source_end;
  RecordingWriter* recording = nullptr;
  StepTable* table = nullptr;
  std::vector<ProfiledStep>* profile = nullptr;  ///< gets what each step took
  StepObserver observer;
};

/// bailed_out: who operated ended the operation otherwise than planned; it is scored as any.
enum class SessionEnd { steps_done, time_limit, source_ended, interrupted, failed, bailed_out };

/// "done", "time_limit", "source_ended", "interrupted", "failed", "bail_out".
std::string to_text(SessionEnd end);

struct SessionResult {
  SessionEnd end = SessionEnd::steps_done;
  Failure failure;  ///< of the world, the script, the source or a file, where end is failed
  Progress progress;
  Traces traces;
  std::map<std::string, double> metrics;  ///< measured when it ended
  /// State hash after each step; the rest state's first.
  std::vector<std::uint64_t> state_hashes;
  SessionTiming timing;
  std::vector<std::string> notes;  ///< what could not be measured or is less accurate, and why
  std::vector<std::string> rest;   ///< which organs lie elsewhere at the start than they are drawn
};

SessionResult run_session(World& world, ExerciseScript& script, InputSource& source,
                          const SessionOptions& options);

}  // namespace calot
