#include "process/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "session/json.h"

namespace calot {
namespace {

const auto program_start = std::chrono::steady_clock::now();

bool colours() {
  const char* no_color = std::getenv("NO_COLOR");
  return isatty(STDOUT_FILENO) != 0 && (no_color == nullptr || *no_color == '\0');
}

std::string wrapped(const char* code, const std::string& text) {
  return colours() ? fmt::format("\033[{}m{}\033[0m", code, text) : text;
}

const char* to_text(FailureKind kind) {
  switch (kind) {
    case FailureKind::usage:
      return "usage";
    case FailureKind::scenario:
      return "scenario";
    case FailureKind::simulation:
      return "simulation";
    case FailureKind::resource:
      return "resource";
    case FailureKind::interrupted:
      return "interrupted";
    case FailureKind::internal:
      return "internal";
  }
  return "internal";
}

std::string failure_json(const Failure& failure, const std::string& next) {
  const OrderedJson json = {{"schema", "calot.failure/1"},
                            {"kind", to_text(failure.kind)},
                            {"exit_code", static_cast<int>(exit_code(failure.kind))},
                            {"problems", problems_json(failure)},
                            {"next", next}};
  return json_text(json);
}

}  // namespace

std::string bold(const std::string& text) { return wrapped("1", text); }
std::string green(const std::string& text) { return wrapped("32", text); }
std::string red(const std::string& text) { return wrapped("31", text); }

void print(const std::string& line) { std::printf("%s\n", line.c_str()); }

ExitCode print_failure(const Failure& failure, const std::string& next, bool json) {
  if (json) print(failure_json(failure, next));
  std::fflush(stdout);
  std::fprintf(stderr, "%s\n", calot::to_text(failure).c_str());
  if (!next.empty()) std::fprintf(stderr, "Next: %s\n", next.c_str());
  return exit_code(failure.kind);
}

ProgressLine::ProgressLine() : enabled_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

bool ProgressLine::due() { return enabled_ && (last_ < 0 || seconds_since_start() - last_ > 0.1); }

void ProgressLine::show(const std::string& text) {
  std::fprintf(stderr, "\r\033[K%s", text.c_str());
  std::fflush(stderr);
  shown_ = true;
  last_ = seconds_since_start();
}

std::string table(const std::vector<std::vector<std::string>>& rows, const std::string& alignment) {
  std::vector<std::size_t> widths(alignment.size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += "  ";
      line += alignment[i] == 'r' ? fmt::format("{:>{}}", row[i], widths[i])
                                  : fmt::format("{:<{}}", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

double seconds_since_start() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - program_start).count();
}

std::string shell_word(const std::string& word) {
  const char* safe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!word.empty() && word.find_first_not_of(safe) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string shell_words(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + shell_word(word);
  return out;
}

}  // namespace calot
