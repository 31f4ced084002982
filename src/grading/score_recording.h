#pragma once
// One recording's score: from what it holds where the exercise is still the one that was played, else by simulating.

#include <filesystem>
#include <map>
#include <string>

#include "play/play.h"
#include "session/benchmarks.h"
#include "session/json.h"
#include "session/recording.h"

namespace calot {

/// Looks on while recordings are simulated.
struct ScoreWatcher {
  std::function<void(const ExerciseDefinition&, PlayRequest&)> begin;  ///< may ask for pictures
  std::function<void(const Recording&, const Played&)> end;            ///< of one that was not interrupted
  /// Of one that is scored from what it holds: it then is not simulated.
  std::function<void(const Recording&, const ExerciseDefinition&)> held = {};
};

struct ScoreRequest {
  std::filesystem::path exercise;
  std::optional<BenchmarkTable> benchmarks;  ///< instead of the exercise's own
  bool verify = false;                       ///< simulate, and compare with what the recording holds
  bool keyed = false;                        ///< key() is going to be asked
  /// Every recording is then simulated too, though it be scored from what it holds, unless the watcher takes that.
  std::optional<ScoreWatcher> watcher;
};

/// Scores recordings of one exercise. An entry of calot.scores/3 is an object of
///   file         as it was named
///   failure      a list of problems where there is no score, with the exit_code of their kind; then nothing follows
///   session      of the recording; session_of()
///   source, mode, trainee, attempt, began, machine   as in session/attempt.h; null where it is not known
///   recorded     the versions by which the recording was written: schema, measures and scoring; 0 where it does not say
///   measures     the version by which the metrics below were measured
///   from         "recording" or "simulation"; why: why it was simulated, else null
///   verified     with `verify`: true, false, or null where nothing can be said; differences: in words, what differs
///   end          how the session ended, "cut" where the recording has no end
///   whole        it came to its end; else it is scored up to stopped_at_s, and unfinished or unsafe
///   stopped_at_s
///   params       of the exercise, as it was played
///   score, metrics, steps, notes   as in calot.report/1
///   copy_of      the file that counts instead, of the same session: put there by mark_copies
class RecordingScorer {
 public:
  /// Reads the exercise with its parameters' defaults. Fails as load_scenario does, or where the benchmarks do not fit.
  static Result<RecordingScorer> create(ScoreRequest request);

  const ExerciseDefinition& exercise() const { return standard_.definition; }
  /// A hash of all that decides a recording's entry but its name: its text, the exercise, the benchmarks and this
  /// program. Empty where it cannot be scored.
  std::string key(const std::string& file);
  OrderedJson score(const std::string& file);

 private:
  struct Exercise {
    ExerciseDefinition definition;  ///< with the benchmarks
    std::uint64_t hash = 0;         ///< exercise_hash
  };

  explicit RecordingScorer(ScoreRequest request) : request_(std::move(request)) {}
  Result<Exercise> load(const std::map<std::string, std::string>& params, std::uint64_t seed) const;
  Result<const Exercise*> exercise_of(const RecordingHeader& header);
  std::optional<Failure> add_score(const Recording& recording, OrderedJson& entry);
  /// Why what the recording holds is not enough; none where it is.
  std::optional<std::string> why_simulate(const Recording& recording, const Exercise& exercise) const;
  /// Fails (interrupted) too.
  Result<Played> replay(const Recording& recording, const Exercise& exercise) const;
  std::optional<Failure> simulate(const Recording& recording, const Exercise& exercise,
                                  OrderedJson& entry) const;

  ScoreRequest request_;
  Exercise standard_;
  std::uint64_t key_base_ = 0;
  std::map<std::string, Exercise> known_;  ///< by parameters and seed
};

/// What a simulation measured otherwise than the recording says, by the same exercise (its exercise_hash) and version of
/// measures; nothing where those differ, or where the recording does not say.
std::vector<std::string> measured_otherwise(const Recording& recording, std::uint64_t exercise,
                                            const SessionResult& session);

/// The entry of a recording that has no score.
OrderedJson failed_entry(const std::string& file, const Failure& failure);

}  // namespace calot
