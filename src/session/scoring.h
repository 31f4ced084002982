#pragma once
// From metrics and events to points: F2 (benchmarked metrics between a novice's and an expert's value) and
// penalties for events, weighted; critical events cap the total. Every part explains itself.

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

struct CriticalEvent {
  EventKind event = EventKind::contact;
  std::vector<double> times;  ///< s
};

struct Score {
  double total = 0;  ///< 0 to 100, capped where a critical event happened
  double uncapped = 0;
  std::vector<ScoredPart> parts;
  std::vector<CriticalEvent> critical;  ///< those that happened
  bool completed = false;               ///< every declared step ended as done
  bool passed = false;                  ///< completed, no critical event, total >= pass
};

Score score(const ExerciseDefinition& exercise, const std::map<std::string, double>& metrics,
            const Progress& progress);

}  // namespace calot
