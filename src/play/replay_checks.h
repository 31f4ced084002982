#pragma once
// What a replay needs besides playing: the recording's scenario, a safe place to write, and the judgement of states.

#include <filesystem>
#include <string>

#include "session/recording.h"
#include "session/runner.h"

namespace calot {

/// `chosen` where it is not empty. Else the file that the header names: from here, from the project, or beside the
/// recording; else the project's scenario of that id. Fails (usage) saying where it was sought.
Result<std::filesystem::path> find_scenario(const RecordingHeader& header,
                                            const std::filesystem::path& recording,
                                            const std::string& chosen);

/// Fails (usage, with that hint) where the recording is not of this exercise's field: its id, instruments and rate.
std::optional<Failure> check_replay(const Recording& recording, const ExerciseDefinition& exercise,
                                    const std::string& hint);

/// A replay must not be written over the recording it plays.
std::optional<Failure> check_replay_output(const std::filesystem::path& output,
                                           const std::filesystem::path& recording);

/// Warns where what is played is not what was recorded; `chosen`: the user named the scenario.
void warn_of_differences(const Recording& recording, const ExerciseDefinition& exercise, bool chosen);

struct StateComparison {
  bool differs = false;  ///< though equal bits could be expected
  std::string message;   ///< where they part, and why that may be; empty where they never do
};
StateComparison compare_states(const Recording& recording, const SessionResult& session);

}  // namespace calot
