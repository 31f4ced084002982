#pragma once
// Jaws that close until what is between them carries their pinch, and follow it then.

#include <functional>
#include <vector>

#include "base/status.h"
#include "field/field.h"
#include "tools/step_report.h"

namespace calot {

/// Moves the tools to `to` by go(poses), which may fail (simulation). Jaws that press harder than their pinch then, or
/// where tissue has stopped them before less hard, are turned where they are until they press with it, within
/// pinch_tolerance: by no more than grip_grid where they had been stopped, else back as far as they came, and never beyond
/// their `targets`. Folds that ask for more than is held slip after that (let_slip()). Where `go` fails it is tried again
/// with jaws that close less; what it adds to `events` stays of the last time alone. Trials are counted in `statistics`,
/// by the tool whose angle is tried. `brought_along`: `go` brings bodies along on the way through a step; they are balanced
/// where jaws seem to press with their pinch, and jaws that have pressed before find it at the step's end.
Result<bool> close_within_pinch(Field& field, const std::vector<InstrumentPose>& to,
                                const std::vector<InstrumentPose>& targets,
                                const std::function<Result<bool>(const std::vector<InstrumentPose>&)>& go,
                                bool brought_along, const std::vector<char>& slipped_before,
                                std::vector<WorldEvent>& events, SolveStatistics& statistics);

}  // namespace calot
