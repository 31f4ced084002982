#include "base/status.h"

#include <fmt/format.h>

namespace calot {

void keep_first(std::vector<Problem>& problems) {
  constexpr std::size_t most = 100;
  if (problems.size() <= most) return;
  problems[most - 1] = {problems[most - 1].place,
                        fmt::format("and {} more problems from here on", problems.size() - most + 1),
                        {}};
  problems.resize(most);
}

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
