#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/play.h"
#include "app/project.h"
#include "app/terminal.h"
#include "session/metrics.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

struct Checked {
  std::string file;
  std::optional<ExerciseDefinition> exercise;
  Failure failure;
};

/// Files as named; of a folder, its scenarios.
std::vector<std::string> files_of(const std::vector<std::string>& names) {
  std::vector<std::string> files;
  std::error_code error;
  for (const std::string& name : names) {
    if (!fs::is_directory(name, error)) {
      files.push_back(name);
      continue;
    }
    std::vector<std::string> inside;
    for (const fs::directory_entry& entry : fs::directory_iterator(name, error)) {
      if (entry.path().extension() == ".lua") inside.push_back(entry.path().string());
    }
    std::sort(inside.begin(), inside.end());
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}

/// Loads the scenario and brings its world to rest: an organ that cannot be filled is found here too.
Checked check(const std::string& file) {
  Checked checked;
  checked.file = file;
  Result<ExerciseDefinition> exercise = load_definition(file);
  if (!exercise) {
    checked.failure = exercise.failure();
    return checked;
  }
  const Result<World> world = World::create(exercise->scene);
  if (world)
    checked.exercise = std::move(exercise).value();
  else
    checked.failure = world.failure();
  return checked;
}

nlohmann::ordered_json checked_json(const Checked& checked) {
  nlohmann::ordered_json json = {{"file", checked.file}, {"ok", checked.exercise.has_value()}};
  if (checked.exercise) {
    const ExerciseDefinition& exercise = *checked.exercise;
    json["scenario"] = exercise.id;
    json["title"] = exercise.title;
    json["steps"] = exercise.step_names;
    json["metrics"] = metric_names(exercise);
  }
  json["problems"] = nlohmann::json::array();
  for (const Problem& problem : checked.failure.problems) {
    json["problems"].push_back({{"file", problem.place.file},
                                {"line", problem.place.line},
                                {"path", problem.place.path},
                                {"message", problem.message},
                                {"hint", problem.hint}});
  }
  return json;
}

/// Only in a scenario are there lines to mend.
std::string next_after(ExitCode code, const std::string& first_bad) {
  const std::string again = "calot check " + shell_word(first_bad);
  if (code == ExitCode::usage) return "calot check --help";
  return code == ExitCode::scenario ? "mend the lines named above, then: " + again : again;
}

}  // namespace

ExitCode check_command(const CheckCommand& command) {
  const std::vector<std::string> files = files_of(command.scenarios);
  if (files.empty()) {
    print_failure(fail(FailureKind::usage, "there is no scenario in " + command.scenarios.front()),
                  "calot new NAME", command.json);
    return ExitCode::nothing_selected;
  }
  const std::atomic<bool>& stop = interrupt_flag();
  ExitCode code = ExitCode::ok;
  std::string first_bad;
  std::size_t done = 0;
  nlohmann::ordered_json json = {{"schema", "calot.check/1"}, {"scenarios", nlohmann::json::array()}};
  for (const std::string& file : files) {
    if (stop) break;
    const Checked checked = check(file);
    ++done;
    json["scenarios"].push_back(checked_json(checked));
    if (checked.exercise) {
      if (!command.json) print(fmt::format("{}  {}: {}", green("ok"), file, checked.exercise->title));
      std::fflush(stdout);
      continue;
    }
    std::fflush(stdout);
    std::fprintf(stderr, "%s\n", to_text(checked.failure).c_str());
    if (first_bad.empty()) first_bad = file;
    if (code == ExitCode::ok) code = exit_code(checked.failure.kind);
  }
  json["interrupted"] = done < files.size();
  if (command.json) print(json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  std::fflush(stdout);
  if (done < files.size()) {
    std::fprintf(stderr, "Interrupted: %zu of %zu scenarios were checked.\nNext: calot check %s\n", done,
                 files.size(), shell_word(files[done]).c_str());
    return ExitCode::interrupted;
  }
  if (code != ExitCode::ok) std::fprintf(stderr, "Next: %s\n", next_after(code, first_bad).c_str());
  return code;
}

}  // namespace calot
