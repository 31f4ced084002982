#pragma once
// What a command over many recordings begins and ends with: which they are, and what is said of each.

#include <optional>
#include <string>
#include <vector>

#include "process/exit_code.h"
#include "session/json.h"

namespace calot {

/// Recordings by the names of files, and of folders with all below them; each once, though it may have been named twice:
/// a trainee counts once in a class.
std::vector<std::string> recordings_of(const std::vector<std::string>& names);

/// What to say where there are none.
Failure no_recordings(const std::vector<std::string>& names);

/// The failure of the first one that cannot be read.
std::optional<Failure> first_unreadable(const std::vector<std::string>& recordings);

/// Logs how many were simulated, for which reason.
void tell_why(const std::vector<OrderedJson>& entries);

/// Says on stderr what a reader of the scores has to know of single recordings; the exit code that follows from them.
ExitCode judge(const std::vector<OrderedJson>& entries, const std::string& exercise_file,
               std::optional<double> fail_below);

}  // namespace calot
