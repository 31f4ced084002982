#include <fmt/format.h>

#include <algorithm>

#include "app/commands.h"
#include "organs/body_kinds.h"
#include "play/play.h"
#include "process/interrupt.h"
#include "process/project.h"
#include "process/result_files.h"
#include "process/terminal.h"
#include "session/json.h"
#include "session/metrics.h"
#include "session/rest_remarks.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

struct Named {
  std::string file;
  bool found = false;  ///< in a folder: there it may be a module that scenarios require
};

struct Checked {
  std::string file;
  std::optional<ExerciseDefinition> exercise;
  bool module = false;
  Failure failure;
  std::vector<std::string> rest = {};  ///< what lies elsewhere at rest than it is drawn

  bool ok() const { return module || exercise.has_value(); }
};

std::vector<Named> files_of(const std::vector<std::string>& names) {
  std::vector<Named> files;
  std::error_code error;
  for (const std::string& name : names) {
    if (fs::is_directory(name, error)) {
      for (const fs::path& file : files_below(name, ".lua")) files.push_back({file.string(), true});
    } else {
      files.push_back({name, false});
    }
  }
  return files;
}

/// Brings the world to rest and lets the demo try it: what cannot be filled or reached is found here.
std::optional<Failure> build(ExerciseScript& script, std::vector<std::string>& rest) {
  const Result<World> world = World::create(script.definition().scene, &interrupt_flag(), 1, kept_results());
  if (!world) return script.located(world.failure());
  rest = rest_remarks(world.value());
  std::vector<Problem> problems = script.rehearse(world.value());
  if (problems.empty()) return std::nullopt;
  return Failure{FailureKind::scenario, std::move(problems)};
}

Checked check(const Named& named, bool with_world) {
  Checked checked;
  checked.file = named.file;
  checked.module = named.found && is_module(named.file);
  if (checked.module) return checked;
  PlayRequest request;
  request.scenario = named.file;
  const Result<std::unique_ptr<ExerciseScript>> script = load_scenario(request);
  if (!script) {
    checked.failure = script.failure();
    return checked;
  }
  ExerciseDefinition exercise = script.value()->definition();
  const std::optional<Failure> failure = with_world ? build(*script.value(), checked.rest) : std::nullopt;
  if (failure)
    checked.failure = *failure;
  else
    checked.exercise = std::move(exercise);
  return checked;
}

/// What an author should think about; none of it is wrong.
std::vector<std::string> remarks(const ExerciseDefinition& exercise) {
  std::vector<std::string> lines;
  if (exercise.scene.instruments.empty())
    lines.emplace_back("the scene has no instruments: calot run plays it, calot operate does not");
  for (std::string& line : mesh_remarks(exercise.scene)) lines.push_back(std::move(line));
  if (exercise.score.parts.empty()) return lines;
  if (exercise.step_names.empty() && exercise.api > 1)
    lines.emplace_back(
        "there is no t:step: parts earn by the steps that were done, and here nothing is asked");
  for (const std::string& step : exercise.waited_steps)
    lines.push_back(fmt::format(
        "step \"{}\" asks no condition: who waits has done it (t:wait_until or t:hold, of what is "
        "achieved)",
        step));
  if (exercise.api == 1)
    lines.emplace_back(
        "api = 1: parts of the score earn points whether their steps were done or not. Write api = 2; "
        "where a part judges some steps only, give it steps = { ... }; and instead of "
        "bail_out_completes = true write bail_out = function(run) return true, \"why\" end");
  return lines;
}

OrderedJson checked_json(const Checked& checked) {
  OrderedJson json = {{"file", checked.file}, {"ok", checked.ok()}};
  if (checked.module) json["module"] = true;
  if (checked.exercise) {
    const ExerciseDefinition& exercise = *checked.exercise;
    json["scenario"] = exercise.id;
    json["title"] = exercise.title;
    json["steps"] = exercise.step_names;
    json["metrics"] = metric_names(exercise);
    json["rest"] = checked.rest;
    json["remarks"] = remarks(exercise);
  }
  json["problems"] = problems_json(checked.failure);
  return json;
}

/// What to do about the first file that is not as it should be; only in a scenario are there lines to mend.
std::string next_step(const Checked& checked, const std::string& command) {
  if (checked.failure.kind == FailureKind::usage) return "calot check --help";
  const std::string again = command + shell_word(checked.file);
  return checked.failure.kind == FailureKind::scenario ? "mend the lines named above, then: " + again : again;
}

/// Prints, of a file in which nothing is wrong, its title, what lies elsewhere at rest than it is drawn, and what its
/// author should think about.
void print_sound(const Checked& checked) {
  const std::string what = checked.module ? "a module, for scenarios to require" : checked.exercise->title;
  print(fmt::format("{}  {}: {}", green("ok"), checked.file, what));
  for (const std::string& line : checked.rest) print("    " + line);
  if (!checked.exercise) return;
  for (const std::string& line : remarks(*checked.exercise)) print("    " + line);
}

/// Whether all scenarios load; nothing is said of those that do.
ExitCode dry_check(const std::vector<Named>& files, const CheckCommand& command, const std::string& again) {
  for (const Named& file : files) {
    const Checked checked = check(file, false);
    if (!checked.ok()) return print_failure(checked.failure, next_step(checked, again), command.json);
  }
  return ExitCode::ok;
}

}  // namespace

ExitCode check_command(const CheckCommand& command) {
  const std::vector<Named> files = files_of(command.scenarios);
  if (files.empty()) {
    print_failure(fail(FailureKind::usage, "there is no scenario in " + command.scenarios.front()),
                  "calot new NAME", command.json);
    return ExitCode::nothing_selected;
  }
  const std::atomic<bool>& stop = interrupt_flag();
  ExitCode code = ExitCode::ok;
  const std::string again = command.build ? "calot check --build " : "calot check ";
  if (command.dry_run) return dry_check(files, command, again);
  std::string next;
  std::size_t done = 0;
  OrderedJson json = {{"schema", "calot.check/1"}, {"scenarios", OrderedJson::array()}};
  for (const Named& file : files) {
    if (stop) break;
    const Checked checked = check(file, command.build);
    if (checked.failure.kind == FailureKind::interrupted) break;
    ++done;
    json["scenarios"].push_back(checked_json(checked));
    if (checked.ok()) {
      if (!command.json) print_sound(checked);
      std::fflush(stdout);
      continue;
    }
    std::fflush(stdout);
    std::fprintf(stderr, "%s\n", to_text(checked.failure).c_str());
    if (code == ExitCode::ok) {
      next = next_step(checked, again);
      code = exit_code(checked.failure.kind);
    }
  }
  json["interrupted"] = done < files.size();
  if (command.json) print(json_text(json));
  std::fflush(stdout);
  if (done < files.size()) {
    std::fprintf(stderr, "Interrupted: %zu of %zu scenarios were checked.\nNext: %s%s\n", done, files.size(),
                 again.c_str(), shell_word(files[done].file).c_str());
    return ExitCode::interrupted;
  }
  if (code != ExitCode::ok) std::fprintf(stderr, "Next: %s\n", next.c_str());
  return code;
}

}  // namespace calot
