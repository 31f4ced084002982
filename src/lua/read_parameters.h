#pragma once
// An exercise's params, and the values that the user chose for them.

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "anatomy/field_check.h"
#include "script/value.h"
#include "session/exercise.h"

namespace calot {

using ParameterValue = std::variant<double, bool, std::string>;
using Parameters = std::map<std::string, ParameterValue>;

struct ReadParameters {
  Parameters values;                             ///< of every parameter: chosen or default
  std::vector<ParameterDefinition> definitions;  ///< ordered by name
  std::vector<Problem> usage;                    ///< what is wrong with what the user chose
};

/// Problems of the declaration go to `check`. `params` may be null; `chosen` are values as the user wrote them.
ReadParameters read_parameters(FieldCheck& check, const Value* params,
                               const std::map<std::string, std::string>& chosen);

/// Pushes the table p that scene, steps, demo and a score's function are given.
void push_parameters(lua_State* L, const Parameters& parameters);

}  // namespace calot
