#pragma once
// When the picture of something that happens is due.

#include <optional>

#include "session/exercise.h"

namespace calot {

/// The time of a moment's picture, s, by what has happened so far; none: what it waits for has not happened.
std::optional<double> due_time(const GoldenMoment& moment, const Progress& progress);

}  // namespace calot
