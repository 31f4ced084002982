#pragma once
// An author's own rules of the score: Lua functions that see a session which has ended, as plain tables.

#include <map>
#include <string>
#include <vector>

#include "lua/read_parameters.h"
#include "script/lua_headers.h"
#include "script/sandbox.h"
#include "session/exercise.h"

namespace calot {

/// What a rule sees.
struct RuleRun {
  const ExerciseDefinition& exercise;
  const std::map<std::string, double>& metrics;
  const Progress& progress;
  const Parameters& parameters;
  /// Of all metrics there may be: to ask for another one is a mistake; null: it then is only not measured.
  const std::vector<std::string>* metric_names = nullptr;
};

inline constexpr std::size_t longest_reason = 500;  ///< bytes

/// `rule` is a registry reference. Fails (scenario, at the author's line) for what the function raises, and for an
/// answer that is no share of 0 to 1, a reason, and times or none; resource where a limit is reached.
/// `yes_no`: the share is true or false.
Result<RuleAnswer> ask_rule(Sandbox& sandbox, int rule, const RuleRun& run, bool yes_no = false);

/// What is certainly wrong with a rule, found by asking it of a session without events and metrics: names that do not
/// exist, an answer of the wrong kind. What it raises itself may be because nothing happened.
std::optional<Failure> try_rule(Sandbox& sandbox, int rule, const RuleRun& nothing, bool yes_no = false);

/// Pushes a list of them, as run.events has it.
void push_events(lua_State* L, const std::vector<SessionEvent>& events);

// Methods of the run that a rule is given: run:count(event, organ), run:times(event, organ).
int count_events_of_run(lua_State* L);
int times_of_events_of_run(lua_State* L);

}  // namespace calot
