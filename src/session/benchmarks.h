#pragma once
// Other benchmarks than an exercise's own, such as a clinic's, kept in a table with a name and a version.

#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "session/exercise.h"

namespace calot {

/// What replaces figures of one part of the score; the others stay.
struct PartBenchmark {
  std::string part;  ///< its name in the score
  std::optional<double> novice, expert, each;
  Place place;  ///< where the author wrote it
};

struct BenchmarkTable {
  std::string name, exercise;  ///< `exercise`: the id of what it is for
  int version = 1;
  std::string calibration = "uncalibrated";  ///< where the figures come from
  std::optional<double> pass, cap;           ///< points of 100
  std::vector<PartBenchmark> parts;
  Place place;                    ///< the file
  std::uint64_t source_hash = 0;  ///< of its text and modules
};

/// Replaces the exercise's figures. What does not fit the exercise comes back, each at the author's line; the exercise
/// is then of no use.
std::vector<Problem> apply(const BenchmarkTable& table, ExerciseDefinition& exercise);

}  // namespace calot
