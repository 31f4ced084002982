#pragma once

#include <atomic>

namespace calot {

/// From the first call on the first SIGINT or SIGTERM sets the returned flag, so that a session can end in order, and
/// says so on stderr; the second ends the process at once.
const std::atomic<bool>& interrupt_flag();

}  // namespace calot
