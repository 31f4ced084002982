#include <fmt/format.h>

#include <cctype>

#include "app/commands.h"
#include "process/project.h"
#include "process/terminal.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

/// "hold_tight" and "hold_tight.lua" go into scenarios/ where there is one; a path stays a path.
fs::path file_for(const std::string& name) {
  fs::path file(name);
  if (file.extension() != ".lua") file += ".lua";
  std::error_code ignored;
  if (file.has_parent_path() || !fs::is_directory("scenarios", ignored)) return file;
  return "scenarios" / file;
}

/// Letters, digits, - and _, beginning with a letter: the name becomes the exercise's id.
bool fit_name(const std::string& name) {
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name[0])) == 0) return false;
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// An id has small letters, digits and hyphens.
std::string id_for(std::string stem) {
  for (char& c : stem) c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return stem;
}

}  // namespace

ExitCode new_command(const NewCommand& command) {
  const fs::path file = file_for(command.name);
  const std::string stem = file.stem().string();
  if (!fit_name(stem)) {
    return print_failure(fail(FailureKind::usage, fmt::format("\"{}\" is no name for an exercise", stem),
                              "use letters, digits, - and _, and begin with a letter"),
                         "calot new my_exercise");
  }
  std::error_code ignored;
  if (fs::exists(file, ignored)) {
    return print_failure(
        fail(FailureKind::usage, fmt::format("{} exists already; it was left as it is", file.string())),
        "calot check " + shell_word(file.string()));
  }
  const Result<std::string> starter = read_text(project_part("assets/starter_exercise.lua"));
  if (!starter) return print_failure(starter.failure(), "calot doctor");
  if (command.dry_run) return ExitCode::ok;
  const std::string text = replaced(starter.value(), "starter-exercise", id_for(stem));
  const Result<std::string> written = write_text(file, text);
  if (!written) return print_failure(written.failure(), "calot new --help");
  print(fmt::format("Wrote {}\nNext: calot run {}", file.string(), shell_word(file.string())));
  return ExitCode::ok;
}

}  // namespace calot
