#pragma once
// Which events a step's end shows to have begun.

#include "field/field.h"
#include "tools/step_report.h"

namespace calot {

/// What begins between two reports of the field's states: contact, current, too much force, tools that meet, walls that are
/// stretched too far. A report without instruments is of a time before all of it. The events have no time yet.
std::vector<WorldEvent> observe(const Field& field, const StepReport& before, const StepReport& now);

/// Whether an instrument's jaws are pressed with more than this force, N.
bool presses_too_hard(const InstrumentState& state, double limit);

/// Gives events the time of the report, and those without a place that of their instrument's tip.
void place_events(const Field& field, const StepReport& report, std::vector<WorldEvent>& events);

}  // namespace calot
