#pragma once
// What the program says of a command line that it does not understand.

#include <string>
#include <vector>

#include "process/exit_code.h"

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace calot {

/// What a parse met and did not expect, misspelt options above all; known though --help or --version cut the parse short.
std::vector<std::string> unexpected_words(const CLI::App& app);

/// Prints which words were not expected, with the option or command nearest to the first one, or else CLI11's message;
/// and the command that shows help.
ExitCode explain_usage_error(const CLI::App& app, const CLI::Error& error);

}  // namespace calot
