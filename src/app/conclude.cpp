#include "app/conclude.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/log.h"
#include "play/summary.h"
#include "process/terminal.h"

namespace calot {
namespace {

/// Times of frames after the session's end, and moments that did not come, are no error, but an author should know.
void note_missing_frames(const Played& played, const std::vector<double>& at) {
  const double end = played.session.traces.time.back();
  for (const GoldenMoment& moment : played.exercise.golden.moments) {
    if (std::find(played.pictures.begin(), played.pictures.end(), moment.name) != played.pictures.end())
      continue;
    log_info(fmt::format("There is no picture {}: the session ended at {:g} s, before its moment.",
                         moment.name, end));
  }
  for (const GoldenFrame& frame : golden_frames(played.exercise, at)) {
    if (frame.time <= end) continue;
    log_info(fmt::format("There is no picture at {:g} s: the session ended at {:g} s.", frame.time, end));
  }
}

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

}  // namespace

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
  const bool has_total = played.report.has_total();
  if (command.fail_below && (!has_total || played.report.score.total < *command.fail_below)) {
    const std::string why =
        has_total
            ? fmt::format("The score, {:.1f}, is below {:g}.", played.report.score.total, *command.fail_below)
            : fmt::format("There is no score to be {:g} or more.", *command.fail_below);
    std::fprintf(stderr, "%s\nNext: %s\n", why.c_str(), conclusion.again.c_str());
    return ExitCode::mismatch;
  }
  return ExitCode::ok;
}

}  // namespace calot
