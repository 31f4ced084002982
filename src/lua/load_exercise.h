#pragma once
// From a scenario's file to an exercise that can be played. Nothing of Lua shows here.

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "base/status.h"
#include "script/limits.h"
#include "session/exercise.h"

namespace calot {

struct LoadOptions {
  std::map<std::string, std::string>
      params;              ///< values as the user wrote them; unknown or unfit: usage failure
  std::uint64_t seed = 1;  ///< of math.random
  ScriptLimits limits;
  std::filesystem::path modules;  ///< folder of the project's Lua modules (scripts/lua); may be empty
  std::filesystem::path
      assets;  ///< where mesh files are sought after the scenario's own folder; may be empty
};

/// Reads, checks and prepares the scenario. Failures: usage (no such file, unknown parameter), scenario (all
/// author errors that can be found, each with file, line and what to do), resource (a limit was reached).
Result<std::unique_ptr<ExerciseScript>> load_exercise(const std::filesystem::path& path,
                                                      const LoadOptions& options = {});

/// Whether a file runs and returns something that is no exercise: others may `require` it.
bool is_module(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace calot
