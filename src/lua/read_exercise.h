#pragma once
// The table that calot.exercise was given, except for its scene, as definitions.

#include <map>
#include <string>
#include <vector>

#include "anatomy/field_check.h"
#include "lua/read_parameters.h"
#include "script/value.h"
#include "session/exercise.h"

namespace calot {

/// The exercise's table, read; functions as registry references, 0 when there is none.
struct ExerciseTable {
  ExerciseDefinition definition;  ///< without scene and script-declared names; the score's metrics unchecked
  Parameters parameters;
  int scene = 0, steps = 0, demo = 0;
  int score = 0;  ///< gives the score for the parameters; 0 where it is a plain table, and read already
  std::vector<Problem> usage;  ///< what is wrong with the parameters that the user chose
};

/// `chosen` are parameters as the user wrote them. What is unfit becomes problems, with paths from the root.
ExerciseTable read_exercise(FieldCheck& check, const Value& exercise,
                            const std::map<std::string, std::string>& chosen);

/// Reads what the score's function returned, for an exercise of that api.
ScoreDefinition read_score(FieldCheck& check, const Value& score, int api);

/// Checks the metrics, steps and organs that score and pictures name against those that the scene and the declared steps
/// and holds have.
void check_names(FieldCheck& check, const ExerciseDefinition& exercise);

}  // namespace calot
