#include <fmt/format.h>

#include <charconv>

#include "app/commands.h"
#include "app/play.h"
#include "app/replay_checks.h"
#include "app/summary.h"
#include "app/terminal.h"
#include "base/log.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

std::optional<Failure> read_size(const std::string& text, PlayRequest& request) {
  const auto number = [&](std::size_t from, std::size_t to, int& value) {
    const auto [end, error] = std::from_chars(text.data() + from, text.data() + to, value);
    return error == std::errc() && end == text.data() + to && value >= 16 && value <= 4096;
  };
  const std::size_t x = text.find('x');
  if (x != std::string::npos && number(0, x, request.width) && number(x + 1, text.size(), request.height)) {
    return std::nullopt;
  }
  return fail(FailureKind::usage, fmt::format("--size {} is no picture size", text),
              "give WIDTHxHEIGHT in pixels, 16 to 4096 each, such as 960x540");
}

std::optional<Failure> read_params(const std::vector<std::string>& pairs, PlayRequest& request) {
  for (const std::string& pair : pairs) {
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos || equals == 0) {
      return fail(FailureKind::usage, fmt::format("--param {} has no value", pair),
                  "write --param key=value");
    }
    request.params[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  return std::nullopt;
}

/// Times of frames after the session's end are no error, but an author should know.
void note_missing_frames(const Played& played, const std::vector<double>& at) {
  const double end = played.session.traces.time.back();
  for (const GoldenFrame& frame : golden_frames(played.exercise, at)) {
    if (frame.time <= end) continue;
    log_info(fmt::format("There is no picture at {:g} s: the session ended at {:g} s.", frame.time, end));
  }
}

/// What is printed of a session and what comes next where it did not end well.
struct Conclusion {
  std::string again;          ///< the command that plays it again
  std::string after_mending;  ///< the command that looks for the script's other mistakes
  std::string after_error;    ///< the command to run where the simulation could not follow
};

ExitCode conclude_failed(const Failure& failure, const Conclusion& conclusion) {
  std::string next = conclusion.after_error;
  if (failure.kind == FailureKind::scenario)
    next = "mend what is named above, then: " + conclusion.after_mending;
  if (failure.kind == FailureKind::resource) next = "mend what is named above, then: " + conclusion.again;
  return print_failure(failure, next);
}

ExitCode conclude_interrupted(const Played& played, const Conclusion& conclusion) {
  const std::string written = played.output.empty() ? "nothing was to be written"
                                                    : "what was done so far is in " + played.output.string();
  std::fprintf(stderr, "Interrupted at %.2f s; %s.\nNext: %s\n", played.session.traces.time.back(),
               written.c_str(), conclusion.again.c_str());
  return ExitCode::interrupted;
}

/// What a played session prints, and its exit code.
ExitCode conclude(const Played& played, const SessionCommand& command, const Conclusion& conclusion) {
  if (command.json) {
    std::fputs(played.json.c_str(), stdout);
  } else {
    print(summary(played));
    if (!played.output.empty()) print(fmt::format("Written to {}", played.output.string()));
  }
  std::fflush(stdout);
  for (const std::string& note : played.session.notes) log_warning(note);
  if (played.session.end == SessionEnd::steps_done && played.rendered)
    note_missing_frames(played, command.at);
  if (played.session.end == SessionEnd::failed) return conclude_failed(played.session.failure, conclusion);
  if (played.session.end == SessionEnd::interrupted) return conclude_interrupted(played, conclusion);
  if (command.fail_below && !played.report.aborted && played.report.score.total < *command.fail_below) {
    std::fprintf(stderr, "The score, %.1f, is below %g.\nNext: %s\n", played.report.score.total,
                 *command.fail_below, conclusion.again.c_str());
    return ExitCode::mismatch;
  }
  return ExitCode::ok;
}

}  // namespace

ExitCode run_command(const RunCommand& command) {
  PlayRequest request;
  request.scenario = command.scenario;
  request.threads = command.threads;
  request.render = !command.no_render;
  request.at = command.at;
  if (command.seed) request.seed = *command.seed;
  std::optional<Failure> wrong = read_size(command.size, request);
  if (!wrong) wrong = read_params(command.params, request);
  if (wrong) return print_failure(*wrong, "calot run --help", command.json);
  request.write = true;
  request.output = command.output;
  request.overwrite = command.overwrite;
  const Result<Played> played = play(request);
  const std::string file = shell_word(command.scenario);
  if (!played) {
    const FailureKind kind = played.failure().kind;
    const std::string next = kind == FailureKind::usage         ? "calot run --help"
                             : kind == FailureKind::interrupted ? "calot run " + file
                                                                : "calot check --build " + file;
    return print_failure(played.failure(), next, command.json);
  }
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
  request.threads = command.threads;
  request.params = recording->header.params;
  request.seed = recording->header.seed;
  request.replay = &recording.value();
  request.render = !command.no_render && !command.output.empty();
  request.at = command.at;
  request.write = !command.output.empty();
  request.output = command.output;
  const Result<Played> played = play(request);
  if (!played) return print_failure(played.failure(), "calot replay --help", command.json);
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
