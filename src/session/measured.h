#pragma once
// What a session was scored from. Its recording holds it, so that it can be scored again, with other benchmarks too,
// without simulating.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "session/exercise.h"
#include "session/json_fields.h"
#include "session/progress.h"

namespace calot {

struct Measured {
  std::map<std::string, double> metrics;
  Progress progress;               ///< steps, events, notes; its own metrics are among those above
  std::vector<std::string> notes;  ///< what could not be measured or is less accurate, and why
};

/// Of all that decides what is measured besides the inputs and the program: the exercise's text and modules, its mesh
/// files, parameters and seed, and how motion is processed.
std::uint64_t exercise_hash(const ExerciseDefinition& exercise);

OrderedJson measured_json(const Measured& measured);
/// From the members that nobody took yet; what is wrong is added to `problems`, the reader's own.
Measured read_measured(JsonFields& fields, std::vector<std::string>& problems);

}  // namespace calot
