#include "base/status.h"

#include <fmt/format.h>

namespace calot {

std::string to_text(const Problem& problem) {
  const Place& place = problem.place;
  std::string at = place.file;
  if (!at.empty() && place.line > 0) at = fmt::format("{}:{}", at, place.line);
  return fmt::format("{}{}{}{}{}{}", at, at.empty() ? "" : ": ", place.path, place.path.empty() ? "" : ": ",
                     problem.message, problem.hint.empty() ? "" : fmt::format(" ({})", problem.hint));
}

std::string to_text(const Failure& failure) {
  std::string text;
  for (const Problem& problem : failure.problems) {
    if (!text.empty()) text += '\n';
    text += to_text(problem);
  }
  return text;
}

}  // namespace calot
