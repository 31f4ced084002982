#pragma once
// How the commands that play a session begin and end: parameters, what is printed, exit code.

#include <optional>

#include "app/commands.h"
#include "play/play.h"

namespace calot {

/// "WIDTHxHEIGHT"; a failure (usage) where it is none that can be drawn.
std::optional<Failure> read_size(const std::string& text, PlayRequest& request);
/// "key=value" each; a failure (usage) names the first that is not.
std::optional<Failure> read_params(const std::vector<std::string>& pairs, PlayRequest& request);

/// What is printed of a session and what comes next where it did not end well.
struct Conclusion {
  std::string again;          ///< the command that plays it again
  std::string after_mending;  ///< the command that looks for the script's other mistakes
  std::string after_error;    ///< the command to run where the simulation could not follow
};

/// What a played session prints, and its exit code.
ExitCode conclude(const Played& played, const SessionCommand& command, const Conclusion& conclusion);

}  // namespace calot
