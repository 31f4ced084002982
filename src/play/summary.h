#pragma once
// The session's report as a person reads it.

#include <string>

#include "play/play.h"

namespace calot {

/// Steps, events, metrics and the score with its parts.
std::string summary(const Played& played);

}  // namespace calot
