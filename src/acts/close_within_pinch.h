#pragma once
// Jaws that close until what is between them carries their pinch, and follow it then.

#include <functional>
#include <vector>

#include "base/status.h"
#include "field/field.h"
#include "tools/step_report.h"

namespace calot {

/// Moves the tools to `to` by go(poses), which may fail (simulation), but for jaws that would press harder than their
/// pinch or, where tissue has stopped them before, less hard: those end where they press with it, within
/// pinch_tolerance, but turn no further than grip_grid on the way, and close no further than to their `targets`. `go` is
/// tried as often as that takes, always from here; what it adds to `events` stays of the last time alone. Trials are counted
/// in `statistics`, by the tool whose angle is tried.
Result<bool> close_within_pinch(Field& field, const std::vector<InstrumentPose>& to,
                                const std::vector<InstrumentPose>& targets,
                                const std::function<Result<bool>(const std::vector<InstrumentPose>&)>& go,
                                std::vector<WorldEvent>& events, SolveStatistics& statistics);

}  // namespace calot
