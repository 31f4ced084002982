#include <fmt/format.h>

#include "app/commands.h"
#include "app/conclude.h"
#include "play/play.h"
#include "play/replay_checks.h"
#include "process/terminal.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

}  // namespace

ExitCode run_command(const RunCommand& command) {
  PlayRequest request;
  request.scenario = command.scenario;
  request.threads = command.threads.value_or(usual_threads());
  request.render = !command.no_render;
  request.profile = command.profile;
  request.at = command.at;
  if (command.seed) request.seed = *command.seed;
  std::optional<Failure> wrong = read_size(command.size, request);
  if (!wrong) wrong = read_params(command.params, request);
  if (wrong) return print_failure(*wrong, "calot run --help", command.json);
  request.write = true;
  request.output = command.output;
  request.overwrite = command.overwrite;
  request.dry_run = command.dry_run;
  const Result<Played> played = play(request);
  const std::string file = shell_word(command.scenario);
  if (!played) {
    const FailureKind kind = played.failure().kind;
    const std::string next = kind == FailureKind::usage         ? "calot run --help"
                             : kind == FailureKind::interrupted ? "calot run " + file
                                                                : "calot check --build " + file;
    return print_failure(played.failure(), next, command.json);
  }
  if (command.dry_run) return ExitCode::ok;
  return conclude(played.value(), command,
                  {"calot run " + file, "calot check --build " + file,
                   "calot replay " + shell_word((played->output / "recording.jsonl").string())});
}

ExitCode replay_command(const ReplayCommand& command) {
  const Result<Recording> recording = read_recording(command.recording);
  if (!recording) return print_failure(recording.failure(), "calot replay --help", command.json);
  PlayRequest request;
  std::optional<Failure> wrong = read_size(command.size, request);
  if (!wrong) wrong = check_replay_output(command.output, command.recording);
  const Result<fs::path> scenario = find_scenario(recording->header, command.recording, command.scenario);
  if (!wrong && !scenario) wrong = scenario.failure();
  if (wrong) return print_failure(*wrong, "calot replay --help", command.json);
  request.scenario = scenario.value();
  request.threads = command.threads.value_or(usual_threads());
  request.params = recording->header.params;
  request.seed = recording->header.seed;
  request.replay = &recording.value();
  request.render = !command.no_render && !command.output.empty();
  request.profile = command.profile;
  request.at = command.at;
  request.write = !command.output.empty();
  request.output = command.output;
  request.dry_run = command.dry_run;
  const Result<Played> played = play(request);
  if (!played) return print_failure(played.failure(), "calot replay --help", command.json);
  if (command.dry_run) return ExitCode::ok;
  warn_of_differences(recording.value(), played->exercise, !command.scenario.empty());
  const std::string file = shell_word(request.scenario.string());
  const std::string again = "calot replay " + shell_word(command.recording);
  const ExitCode code =
      conclude(played.value(), command, {again, "calot check --build " + file, "calot run " + file});
  if (code == ExitCode::interrupted) return code;
  const StateComparison compared = compare_states(recording.value(), played->session);
  if (!compared.message.empty()) std::fprintf(stderr, "%s\n", compared.message.c_str());
  if (!compared.differs && cut_note(recording.value()) == std::nullopt) {
    if (!command.json && compared.message.empty() && recording->header.state_hash)
      print("Every state is that of the recording.");
    return code;
  }
  std::fprintf(stderr, "Next: calot run %s\n", file.c_str());
  return code == ExitCode::ok ? ExitCode::mismatch : code;
}

}  // namespace calot
