#pragma once
// What a person sees: results on stdout, everything else on stderr; colour and progress only on a terminal.

#include <string>
#include <vector>

#include "base/status.h"
#include "process/exit_code.h"

namespace calot {

/// Wraps text for stdout in a colour; plain where stdout is no terminal or NO_COLOR is set and not empty.
std::string bold(const std::string& text);
std::string green(const std::string& text);
std::string red(const std::string& text);

/// Results, to stdout, with a line end.
void print(const std::string& line);

/// Problems and the command to run next, to stderr; with `json` also as one object of schema calot.failure/1
/// to stdout. Returns the exit code of the failure's kind.
ExitCode print_failure(const Failure& failure, const std::string& next, bool json = false);

/// One line on stderr that overwrites itself, at most ten times a second; nothing where stderr is no
/// terminal.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  /// True when a line is due; build the text only then.
  bool due();
  void show(const std::string& text);

 private:
  bool enabled_, shown_ = false;
  double last_ = -1;  ///< s
};

/// Rows indented by two, columns two spaces apart; `alignment` has 'l' or 'r' for each column.
std::string table(const std::vector<std::vector<std::string>>& rows, const std::string& alignment);

/// Seconds since the process started to run main.
double seconds_since_start();

/// Quotes a word for the shell where it needs it: for the commands we suggest.
std::string shell_word(const std::string& word);
/// Each so, with blanks between.
std::string shell_words(const std::vector<std::string>& words);

}  // namespace calot
