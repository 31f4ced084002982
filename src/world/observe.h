#pragma once
// What a step is reported to have done: where instruments, organs and tissues are, and what began.

#include "field/field.h"
#include "tools/step_report.h"

namespace calot {

/// Writes the states of all that is in the field, its events and time left as they are.
void report_states(const Field& field, StepReport& report);

/// After a step of `duration` s in which tools were asked for these actions (none: for nothing), at report.time: current
/// flows, states are reported beside those of the step before, and what begins is an event, after those that the step
/// raised already (without times).
void observe(Field& field, const std::vector<InstrumentAction>& actions, double duration,
             std::vector<WorldEvent> events, StepReport& report);

}  // namespace calot
