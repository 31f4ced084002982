#pragma once
// How much a step may take where masses count.
//
// A step of implicit Euler need not be solved to the end: every iterate is free of penetration and has no more energy than
// the step began with, and inertia carries what is left over into the next step. So a step that has spent its budget ends
// where it is: with its tools as far as they came. It says so (SolveStatistics::cut_short), and the next one goes on from
// there. The budget is a count, so that the same input has the same bits on any machine.
// Static scenes have no inertia to carry anything: there each solve converges or fails.

#include "field/field.h"
#include "tools/step_report.h"

namespace calot {

/// Whether the step begins nothing more. Never without masses.
bool is_spent(const Field& field, const SolveStatistics& statistics);
/// Newton iterations that a solve may take; without masses as good as endless.
int left_to_balance(const Field& field, const SolveStatistics& statistics);

}  // namespace calot
