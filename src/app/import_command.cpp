#include <fmt/format.h>

#include "app/commands.h"
#include "lua/read_registration.h"
#include "play/play.h"
#include "process/project.h"
#include "process/terminal.h"
#include "session/json.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

struct Imported {
  fs::path file;  ///< that was written
  ImportedRecording value;
};

/// The recording's path in the output folder: the file's name without its extensions.
fs::path recording_path(const fs::path& folder, const fs::path& file) {
  const std::string name = file.filename().string();
  return folder / (name.substr(0, name.find('.')) + ".jsonl");
}

Result<Imported> import_file(const std::string& file, const ImportCommand& command,
                             const Registration& registration, const ExerciseDefinition& exercise) {
  Imported imported{recording_path(command.output, file), {}};
  std::error_code error;
  if (fs::exists(imported.file, error))
    return fail(FailureKind::usage, fmt::format("{} is there already", imported.file.string()),
                "remove it, or choose another folder with -o DIR");
  const Result<ForeignMotion> motion = read_foreign_motion(file, registration);
  if (!motion) return motion.failure();
  Result<ImportedRecording> recording = to_recording(motion.value(), registration, exercise);
  if (!recording) return recording.failure();
  imported.value = std::move(recording).value();
  if (command.dry_run) return imported;
  if (std::optional<Failure> unwritten = write_recording(imported.file.string(), imported.value.recording))
    return *unwritten;
  return imported;
}

OrderedJson imported_json(const std::string& file, const Result<Imported>& result) {
  if (!result) return {{"file", file}, {"recording", nullptr}, {"failure", problems_json(result.failure())}};
  const Recording& recording = result->value.recording;
  return {{"file", file},
          {"recording", result->file.string()},
          {"duration_s", recording.steps.back().time},
          {"steps", recording.steps.size()},
          {"notes", result->value.notes}};
}

void print_imported(const std::string& file, const Imported& imported) {
  print(fmt::format("{}  {} of {:.2f} s, from {}", green("ok"), imported.file.string(),
                    imported.value.recording.steps.back().time, file));
  for (const std::string& note : imported.value.notes) print("    " + note);
}

}  // namespace

ExitCode import_command(const ImportCommand& command) {
  const Result<Registration> registration =
      read_registration(command.registration, project_part("scripts/lua"));
  if (!registration) return print_failure(registration.failure(), "calot import --help", command.json);
  const Result<ExerciseDefinition> exercise = load_definition(command.exercise);
  if (!exercise)
    return print_failure(exercise.failure(), "calot check " + shell_word(command.exercise), command.json);
  std::vector<Problem> problems = problems_with(registration.value(), exercise.value());
  if (!problems.empty())
    return print_failure({FailureKind::scenario, std::move(problems)},
                         "calot list " + shell_word(command.exercise), command.json);
  const Result<fs::path> folder = command.dry_run ? fs::path(command.output) : make_folder(command.output);
  if (!folder) return print_failure(folder.failure(), "calot import --help", command.json);
  OrderedJson json = {
      {"schema", "calot.import/1"}, {"scenario", exercise->id}, {"files", OrderedJson::array()}};
  ExitCode code = ExitCode::ok;
  for (const std::string& file : command.files) {
    const Result<Imported> imported = import_file(file, command, registration.value(), exercise.value());
    json["files"].push_back(imported_json(file, imported));
    if (imported) {
      if (!command.json && !command.dry_run) print_imported(file, imported.value());
      continue;
    }
    std::fflush(stdout);
    std::fprintf(stderr, "%s\n", to_text(imported.failure()).c_str());
    if (code == ExitCode::ok) code = exit_code(imported.failure().kind);
  }
  if (command.dry_run && code == ExitCode::ok) return code;
  if (command.json) print(json_text(json));
  std::fflush(stdout);
  if (code == ExitCode::ok && !command.json)
    print(fmt::format("Next: calot score {} {}", shell_word(command.exercise), shell_word(command.output)));
  if (code != ExitCode::ok) std::fprintf(stderr, "Next: mend what is named above, then import it again\n");
  return code;
}

}  // namespace calot
