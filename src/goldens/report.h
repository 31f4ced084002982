#pragma once

#include <string>
#include <vector>

#include "goldens/judge.h"

namespace calot {

/// One frame's comparison, as test and report need it.
struct GoldenResult {
  std::string scenario, frame;
  Judgement judgement = {};
  std::optional<Golden> golden = {}, actual = {};
};

/// One HTML page that opens offline: expected, actual and difference of every frame as data URIs, failures
/// first. Frames are turned to text as they come, so that their pictures need not be kept.
class GoldenPage {
 public:
  /// Fails (usage) where a picture cannot be written for a moment.
  std::optional<Failure> add(const GoldenResult& result);
  std::string html() const;

 private:
  std::string failed_sections_, passed_sections_;
  std::size_t failed_ = 0, all_ = 0;
};

}  // namespace calot
