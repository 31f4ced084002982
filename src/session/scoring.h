#pragma once
// From metrics and events to points: F2 (benchmarked metrics between a novice's and an expert's value) and
// penalties for events, F3 (steps done less weighted errors), F1 (time less penalties) and rules of the author's own,
// weighted; gates cap the total. Every part explains itself.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "session/exercise.h"
#include "session/progress.h"

namespace calot {

/// What a reader of scores by the old arithmetic has to know.
inline constexpr const char* api_1_remark =
    "Scored by api = 1: parts earn points whether their steps were done or not.";

/// Raised with every change of how metrics and events become points and outcomes. 1: any bail-out completed, and there were
/// no outcomes. 2: parts earn by their steps (api 2), and every attempt has an outcome.
inline constexpr int scoring_version = 2;

/// What an attempt was. In the order in which tables show them, the best first.
enum class AttemptOutcome {
  passed,          ///< every step done, no gate that fails, the pass mark reached
  right_bail_out,  ///< the same, but that a bail-out that the exercise judges right took the place of the steps left
  below_mark,  ///< the pass mark was missed
  unfinished,  ///< steps are missing, and no right bail-out
  unsafe,      ///< a gate that fails the exercise, however much was done
  not_judged   ///< the simulation failed, or the exercise has no score: there is no total
};

struct OutcomeRow {
  AttemptOutcome outcome;
  const char* name;   ///< "right_bail_out"
  const char* words;  ///< "right bail-out"
};

/// In the order of the outcomes.
const std::vector<OutcomeRow>& outcome_rows();
/// Its name.
std::string to_text(AttemptOutcome outcome);

struct ScoredPart {
  ScorePart definition;
  /// The metric's value, or the number of events. No value: never measured, which earns 0 points.
  std::optional<double> measured;
  double fraction = 0;        ///< earned of what was done, 0 to 1
  double done = 1;            ///< share of its steps that were done; 1 of procedure and before api 2
  double points = 0;          ///< 100 * weight * fraction * done
  std::vector<double> times;  ///< s, of the events that this part is about, ascending
  std::string explanation;    ///< one sentence
};

/// A gate all of whose conditions hold.
struct TrippedGate {
  std::string reason;                 ///< one sentence, of what was done
  std::optional<EventKind> critical;  ///< it is one of the score's critical events
  std::string event;                  ///< the kind of those behind it; may be empty
  double cap = 40;                    ///< points
  bool fails = true;
  std::vector<double> times;  ///< s, of the events behind it, ascending
  std::string explanation;    ///< what was found
};

struct Score {
  double total = 0;  ///< 0 to 100, capped by gates
  double uncapped = 0;
  std::vector<ScoredPart> parts;
  std::vector<TrippedGate> gates;  ///< those that fail the exercise first
  bool completed =
      false;  ///< every declared step ended as done, or the operation by a bail-out that was right
  std::size_t steps = 0, steps_done = 0;  ///< that there are; done
  std::vector<std::string>
      missing;  ///< steps that should have been done and were not, in the exercise's order
  std::optional<RuleAnswer> bail_out;  ///< what the exercise's rule says of it
  AttemptOutcome outcome = AttemptOutcome::unfinished;
  bool passed() const {
    return outcome == AttemptOutcome::passed || outcome == AttemptOutcome::right_bail_out;
  }
};

/// A hash of all in an exercise that turns figures into points: its steps, parts with their weights and figures, gates, cap and pass mark, and where
/// an author's function judges, the exercise's text. Totals of two digests are of two scores.
std::uint64_t score_digest(const ExerciseDefinition& exercise);

/// What a part judges, with its unit, in words: "left: peak jaws force, N",
/// "overforce events".
std::string part_title(const ScorePart& part);

/// The first gate that fails the exercise; null: none.
const TrippedGate* failing_gate(const Score& score);

/// What an instructor reads: the outcome, and what it follows from: the gate, the missing steps, the wrong bail-out.
std::string verdict(const Score& score);

/// Of a session that did not come to its end: unsafe, or unfinished, or not judged where the simulation failed.
void cut_short(Score& score, bool simulation_failed);

/// Fails as ScoreRules::judge does.
Result<Score> score(const ExerciseDefinition& exercise, const std::map<std::string, double>& metrics,
                    const Progress& progress);

}  // namespace calot
