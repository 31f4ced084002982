#pragma once
// What a script may use before it is stopped. Every limit ends in FailureKind::resource, the last one in an
// exit.

#include <cstddef>
#include <cstdint>

namespace calot {

struct ScriptLimits {
  std::size_t memory = std::size_t{256} << 20;  ///< bytes held by the Lua state and by copies of its values
  std::int64_t instructions_per_call = 10'000'000;    ///< each time the simulator calls into the script
  std::int64_t instructions_per_second = 20'000'000;  ///< of simulated time, all calls together
  std::int64_t instructions_per_run = 4'000'000'000;  ///< all calls together
  /// Wall time (s) of all calls in one simulated second. Only library calls that hardly ever return, such as a
  /// pattern that backtracks for ever, can last that long; nothing inside Lua can stop them, so the process ends
  /// with `exit_code`.
  double call_seconds = 5.0;
  int exit_code = 7;
};

}  // namespace calot
