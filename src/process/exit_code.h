#pragma once
// What the program tells its caller; scripts and CI rely on these numbers.

#include "base/status.h"

namespace calot {

enum class ExitCode {
  ok = 0,
  mismatch = 1,     ///< a picture or state differs, a recording has no end, or a score is below --fail-below
  interrupted = 2,  ///< by SIGINT or SIGTERM; what was done so far is written
  internal = 3,     ///< a fault of the program
  usage = 4,        ///< arguments, paths, files that cannot be read or written
  nothing_selected = 5,  ///< no scenario or golden matched
  scenario = 6,          ///< an error in the author's file
  resource = 7,          ///< a script reached a limit, or the machine lacks something
  simulation = 8,        ///< the simulation could not follow
};

inline ExitCode exit_code(FailureKind kind) {
  switch (kind) {
    case FailureKind::usage:
      return ExitCode::usage;
    case FailureKind::scenario:
      return ExitCode::scenario;
    case FailureKind::simulation:
      return ExitCode::simulation;
    case FailureKind::resource:
      return ExitCode::resource;
    case FailureKind::interrupted:
      return ExitCode::interrupted;
    case FailureKind::internal:
      return ExitCode::internal;
  }
  return ExitCode::internal;
}

}  // namespace calot
