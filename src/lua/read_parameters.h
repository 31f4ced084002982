#pragma once
// An exercise's params, and the values that the user chose for them.

#include "lua/read_exercise.h"

namespace calot {

/// The value of every parameter: chosen or default. Problems of the declaration go to `check`, those of the
/// choice to `usage`. `params` may be null.
std::map<std::string, ParameterValue> read_parameters(FieldCheck& check, const Value* params,
                                                      const std::map<std::string, std::string>& chosen,
                                                      std::vector<Problem>& usage);

}  // namespace calot
