#pragma once
// What a step report says of all that is in the field.

#include "field/field.h"
#include "tools/step_report.h"

namespace calot {

/// Writes the states of all that is in the field, its events and time left as they are.
void report_states(const Field& field, StepReport& report);
/// Of what current changes alone: its tissues, and what is raw of its organs. Of these there must be states already.
void report_burnt(const Field& field, StepReport& report);

}  // namespace calot
