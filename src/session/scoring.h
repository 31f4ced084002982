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

struct ScoredPart {
  ScorePart definition;
  /// The metric's value, or the number of events. No value: never measured, which earns 0 points.
  std::optional<double> measured;
  double fraction = 0;        ///< earned, 0 to 1
  double points = 0;          ///< 100 * weight * fraction
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
      false;            ///< every declared step ended as done, or the operation by a bail-out that completes
  bool passed = false;  ///< completed, no gate that fails, total >= pass
};

/// The first gate that fails the exercise; null: none.
const TrippedGate* failing_gate(const Score& score);

/// Fails as ScoreRules::judge does.
Result<Score> score(const ExerciseDefinition& exercise, const std::map<std::string, double>& metrics,
                    const Progress& progress);

}  // namespace calot
