#pragma once

#include <string>
#include <vector>

#include "app/golden_store.h"

namespace calot {

/// One frame's comparison, as test and report need it.
struct GoldenResult {
  std::string scenario, frame;
  Judgement judgement;
  std::optional<Golden> golden, actual;
};

/// One HTML page that opens offline: expected, actual and difference of every frame as data URIs, failures
/// first.
Result<std::string> golden_html(const std::vector<GoldenResult>& results);

}  // namespace calot
