#include "app/usage_error.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "base/suggest.h"
#include "process/terminal.h"

namespace calot {
namespace {

/// The command whose words were parsed, such as that of `golden test`; the program itself where none was named.
const CLI::App& chosen_command(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? app : chosen_command(*chosen.front());
}

/// "calot golden test --help".
std::string help_of(const CLI::App& app) {
  std::string words = "--help";
  for (const CLI::App* command = &chosen_command(app); command != &app; command = command->get_parent())
    words.insert(0, command->get_name() + " ");
  return "calot " + words;
}

/// The options that --help shows, as "--name".
std::vector<std::string> shown_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// The known name that is nearest to a word, as a question; empty where none is near.
std::string nearest(const CLI::App& command, const std::string& word) {
  const bool option = word.starts_with('-');
  const std::string near = option ? closest_name(word.substr(0, word.find('=')), shown_options(command))
                                  : closest_name(word, commands_of(command));
  return near.empty() ? "" : fmt::format("did you mean \"{}\"?", near);
}

}  // namespace

std::vector<std::string> unexpected_words(const CLI::App& app) {
  std::vector<std::string> words = app.remaining(true);
  std::erase(words, "--");
  return words;
}

ExitCode explain_usage_error(const CLI::App& app, const CLI::Error& error) {
  const std::vector<std::string> words = unexpected_words(app);
  const Failure failure =
      words.empty() ? fail(FailureKind::usage, error.what())
                    : fail(FailureKind::usage, fmt::format("not expected: {}", fmt::join(words, " ")),
                           nearest(chosen_command(app), words.front()));
  return print_failure(failure, help_of(app));
}

}  // namespace calot
