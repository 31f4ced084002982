#include <fmt/format.h>

#include <charconv>

#include "app/commands.h"
#include "app/play.h"
#include "app/project.h"
#include "app/summary.h"
#include "app/terminal.h"
#include "base/hash.h"
#include "base/log.h"
#include "session/build_info.h"

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
void note_missing_frames(const Played& played) {
  const double end = played.session.traces.time.back();
  for (const double time : played.frame_times) {
    if (time <= end) continue;
    log_info(fmt::format("There is no picture at {:g} s: the session ended at {:g} s.", time, end));
  }
}

/// What a played session prints, and its exit code.
ExitCode conclude(const Played& played, const SessionCommand& command, const std::string& scenario) {
  const fs::path& output = played.output;
  if (command.json) {
    std::fputs(played.json.c_str(), stdout);
  } else {
    print(summary(played));
    if (!output.empty()) print(fmt::format("Written to {}", output.string()));
  }
  std::fflush(stdout);
  for (const std::string& note : played.session.notes) log_warning(note);
  if (played.session.end == SessionEnd::steps_done && !played.renderer.empty()) note_missing_frames(played);
  const std::string file = shell_word(scenario);
  if (played.session.end == SessionEnd::failed) {
    const std::string next = output.empty()
                                 ? "calot check " + file
                                 : "calot replay " + shell_word((output / "recording.jsonl").string());
    return print_failure(played.session.failure,
                         played.session.failure.kind == FailureKind::scenario ? "calot check " + file : next);
  }
  if (played.session.end == SessionEnd::interrupted) {
    std::fprintf(stderr, "Interrupted at %.2f s; what was done so far is written.\nNext: calot run %s\n",
                 played.session.traces.time.back(), file.c_str());
    return ExitCode::interrupted;
  }
  if (command.fail_below && played.report.score.total < *command.fail_below) {
    std::fprintf(stderr, "The score, %.1f, is below %g.\nNext: calot run %s\n", played.report.score.total,
                 *command.fail_below, file.c_str());
    return ExitCode::mismatch;
  }
  return ExitCode::ok;
}

/// The scenario as the recording names it: from here, from the project, or beside the recording.
fs::path find_scenario(const std::string& named, const fs::path& recording) {
  std::error_code ignored;
  for (const fs::path& folder : {fs::path(), project_folder(), recording.parent_path()}) {
    if (fs::is_regular_file(folder / named, ignored)) return folder / named;
  }
  return named;
}

/// Says where replay and recording part; true when they never do.
bool same_states(const Recording& recording, const SessionResult& session) {
  std::vector<std::uint64_t> expected{recording.header.state_hash};
  for (const RecordedStep& step : recording.steps) expected.push_back(step.state_hash);
  const std::size_t steps = std::min(expected.size(), session.state_hashes.size());
  for (std::size_t i = 0; i < steps; ++i) {
    if (expected[i] == session.state_hashes[i]) continue;
    std::fprintf(stderr, "The replay parts from the recording at step %zu (%.3f s): state %s, recorded %s.\n",
                 i, i == 0 ? 0.0 : recording.steps[i - 1].time, hex(session.state_hashes[i]).c_str(),
                 hex(expected[i]).c_str());
    return false;
  }
  if (expected.size() == session.state_hashes.size()) return true;
  std::fprintf(stderr, "The replay ended after %zu steps, the recording after %zu.\n",
               session.state_hashes.size() - 1, expected.size() - 1);
  return false;
}

void warn_of_differences(const Recording& recording, const ExerciseDefinition& exercise) {
  const RecordingHeader& header = recording.header;
  if (header.source_hash != exercise.source_hash) {
    log_warning(fmt::format("{} has changed since it was recorded", exercise.file));
  }
  if (header.toolchain != toolchain() || header.instruction_set != instruction_set()) {
    log_warning(fmt::format("recorded by a binary of {}, {}; this one is of {}, {}: states may differ",
                            header.toolchain, header.instruction_set, toolchain(), instruction_set()));
  }
}

}  // namespace

ExitCode run_command(const RunCommand& command) {
  PlayRequest request;
  request.scenario = command.scenario;
  request.render = !command.no_render;
  request.at = command.at;
  if (command.seed) request.seed = *command.seed;
  std::optional<Failure> wrong = read_size(command.size, request);
  if (!wrong) wrong = read_params(command.params, request);
  if (wrong) return print_failure(*wrong, "calot run --help", command.json);
  request.write = true;
  request.output = command.output;
  const Result<Played> played = play(request);
  const std::string file = shell_word(command.scenario);
  if (!played) {
    const bool usage = played.failure().kind == FailureKind::usage;
    return print_failure(played.failure(), usage ? "calot run --help" : "calot check " + file, command.json);
  }
  return conclude(played.value(), command, command.scenario);
}

ExitCode replay_command(const ReplayCommand& command) {
  const Result<Recording> recording = read_recording(command.recording);
  if (!recording) return print_failure(recording.failure(), "calot replay --help", command.json);
  PlayRequest request;
  request.scenario = command.scenario.empty() ? find_scenario(recording->header.file, command.recording)
                                              : fs::path(command.scenario);
  if (std::error_code ignored; command.scenario.empty() && !fs::is_regular_file(request.scenario, ignored))
    return print_failure(fail(FailureKind::usage, "there is no file " + recording->header.file,
                              "name the scenario it was made with: --scenario FILE"),
                         "calot replay --help", command.json);
  request.params = recording->header.params;
  request.seed = recording->header.seed;
  request.replay = &recording.value();
  request.render = !command.no_render && !command.output.empty();
  request.at = command.at;
  request.write = !command.output.empty();
  request.output = command.output;
  if (const std::optional<Failure> wrong = read_size(command.size, request)) {
    return print_failure(*wrong, "calot replay --help", command.json);
  }
  const Result<Played> played = play(request);
  if (!played) return print_failure(played.failure(), "calot replay --help", command.json);
  warn_of_differences(recording.value(), played->exercise);
  const ExitCode code = conclude(played.value(), command, request.scenario.string());
  if (code == ExitCode::interrupted) return code;
  if (!same_states(recording.value(), played->session)) {
    std::fprintf(stderr, "Next: calot run %s\n", shell_word(request.scenario.string()).c_str());
    return ExitCode::mismatch;
  }
  if (!command.json) print("Every state is that of the recording.");
  return code;
}

}  // namespace calot
