#pragma once
// Plays scenarios and holds each golden frame against what is drawn, one at a time.

#include <filesystem>
#include <string>
#include <vector>

#include "goldens/select.h"
#include "goldens/session_judge.h"

namespace calot {

/// Names of the frames that are stored in a scenario's folder of goldens, sorted.
std::vector<std::string> stored_frames(const std::filesystem::path& folder);

/// Fails as load_definition does, or (usage) where a selected frame is neither declared by its scenario nor stored.
std::optional<Failure> check_selected(const std::vector<SelectedGolden>& selected,
                                      const std::filesystem::path& goldens);

/// Draws frames in the size that a scenario's goldens have.
void use_stored_size(const std::filesystem::path& folder, PlayRequest& request);

struct ComparedScenario {
  std::optional<Failure> failure;  ///< the scenario could not be played
  bool interrupted = false;        ///< frames after that were not compared
};

/// Plays the scenario and compares the frames that it declares, those stored, and of them those selected.
ComparedScenario compare_scenario(const SelectedGolden& selected, const std::filesystem::path& goldens,
                                  int threads, const GoldenSink& sink);

/// Goldens below a folder whose scenario does not exist, as failed comparisons.
std::vector<GoldenResult> goldens_without_scenario(const std::filesystem::path& goldens);

}  // namespace calot
