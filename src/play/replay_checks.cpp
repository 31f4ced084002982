#include "play/replay_checks.h"

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log.h"
#include "base/suggest.h"
#include "play/play.h"
#include "process/project.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

/// The project's scenarios of an id; those with the recorded text where there are any.
std::vector<fs::path> scenarios_of(const RecordingHeader& header) {
  std::vector<fs::path> all, same_text;
  for (const fs::path& file : project_scenarios()) {
    const Result<ExerciseDefinition> exercise = load_definition(file);
    if (!exercise || exercise->id != header.scenario) continue;
    all.push_back(file);
    if (header.source_hash == exercise->source_hash) same_text.push_back(file);
  }
  return same_text.empty() ? all : same_text;
}

/// Where the two part, counted in steps from the rest state; none where they never do as far as both go.
std::optional<std::size_t> first_difference(const Recording& recording, const SessionResult& session) {
  const auto& played = session.state_hashes;
  if (!played.empty() && recording.header.state_hash != played[0]) return 0;
  for (std::size_t i = 1; i < played.size() && i <= recording.steps.size(); ++i)
    if (recording.steps[i - 1].state_hash != played[i]) return i;
  return std::nullopt;
}

}  // namespace

Result<fs::path> find_scenario(const RecordingHeader& header, const fs::path& recording,
                               const std::string& chosen) {
  if (!chosen.empty()) return fs::path(chosen);
  std::error_code ignored;
  for (const fs::path& folder : {fs::path(), project_folder(), recording.parent_path()})
    if (!header.file.empty() && fs::is_regular_file(folder / header.file, ignored))
      return folder / header.file;
  const std::vector<fs::path> found = scenarios_of(header);
  if (found.size() == 1) {
    log_info(fmt::format("Playing {}, the scenario whose id is {}.", found[0].string(), header.scenario));
    return found[0];
  }
  const std::string file = header.file.empty() ? "" : fmt::format("there is no file {}, and ", header.file);
  const std::string where = (project_folder() / "scenarios").string();
  return fail(FailureKind::usage,
              found.empty()
                  ? fmt::format("{}no scenario in {} has the id {}", file, where, header.scenario)
                  : fmt::format("{}several scenarios in {} have the id {}", file, where, header.scenario),
              "name the scenario it was made with: --scenario FILE");
}

std::optional<Failure> check_replay(const Recording& recording, const ExerciseDefinition& exercise,
                                    const std::string& hint) {
  std::vector<std::string> names;
  for (const InstrumentDefinition& instrument : exercise.scene.instruments) names.push_back(instrument.name);
  const RecordingHeader& header = recording.header;
  if (header.scenario == exercise.id && header.instruments == names &&
      header.rate == exercise.scene.solver.rate) {
    return std::nullopt;
  }
  return fail(
      FailureKind::usage,
      fmt::format("the recording is of {} ({} at {} Hz), the scenario is {} ({} at {} Hz)", header.scenario,
                  shortened(fmt::format("{}", fmt::join(header.instruments, ", ")), 200), header.rate,
                  exercise.id, fmt::join(names, ", "), exercise.scene.solver.rate),
      hint);
}

std::optional<Failure> check_replay_output(const fs::path& output, const fs::path& recording) {
  std::error_code ignored;
  if (output.empty() || !fs::equivalent(output / "recording.jsonl", recording, ignored)) return std::nullopt;
  return fail(FailureKind::usage, fmt::format("{} is the recording that is to be played", recording.string()),
              "choose another folder with -o DIR");
}

void warn_of_differences(const Recording& recording, const ExerciseDefinition& exercise, bool chosen) {
  const RecordingHeader& header = recording.header;
  if (!header.source_hash || *header.source_hash == exercise.source_hash) return;
  const std::string recorded = header.file.empty() ? header.scenario : header.file;
  log_warning(chosen ? fmt::format("played with {}, not with the text that was recorded ({})", exercise.file,
                                   recorded)
                     : fmt::format("{} has changed since it was recorded", exercise.file));
}

StateComparison compare_states(const Recording& recording, const SessionResult& session) {
  StateComparison result;
  if (!recording.header.state_hash) return result;
  const Make here = this_make();
  const Make& there = recording.header.make;
  if (const std::optional<std::size_t> step = first_difference(recording, session)) {
    result.differs = same_bits(there, here);
    const std::string recorded =
        hex(*step == 0 ? *recording.header.state_hash : *recording.steps[*step - 1].state_hash);
    result.message = fmt::format(
        "The replay parts from the recording at step {} ({:.3f} s): state {}, recorded {}.", *step,
        *step == 0 ? 0.0 : recording.steps[*step - 1].time, hex(session.state_hashes[*step]), recorded);
    if (!result.differs)
      result.message += fmt::format(
          "\nIt was recorded with {}; this is {}: other bits are expected, and nothing else can be said of "
          "the states.",
          to_text(there), to_text(here));
  } else if (session.state_hashes.size() != recording.steps.size() + 1) {
    result.differs = true;
    result.message = fmt::format("The replay ended after {} steps, the recording after {}.",
                                 session.state_hashes.size() - 1, recording.steps.size());
  }
  return result;
}

}  // namespace calot
