#pragma once
// How much a step may take where masses count.
//
// A step of implicit Euler need not be solved to the end: every iterate is free of penetration and has no more energy than
// the step began with, and inertia carries what is left over into the next step. So a step that has spent its budget ends
// with its tools as far as they came, and its bodies balanced there, or as nearly as a further budget allows. It says so
// (SolveStatistics::cut_short, balanced), and the next one goes on from there. The budget is a count, so that the same
// input has the same bits on any machine.
// Static scenes have no inertia to carry anything: there each solve converges or fails.

#include "field/field.h"
#include "tools/step_report.h"

namespace calot {

/// What a step of bodies with so many nodes may take: of the standard field's 340 as StepBudget says, of fewer, whose
/// iterations cost less, more in proportion, at most 40.
StepBudget budget_of(int nodes);

/// Whether the step begins nothing more. Never without masses.
bool is_spent(const Field& field, const SolveStatistics& statistics);
/// Newton iterations until then.
int left_to_begin(const Field& field, const SolveStatistics& statistics);
/// Newton iterations that a solve for a balance may take; without masses as good as endless.
int left_to_balance(const Field& field, const SolveStatistics& statistics);

}  // namespace calot
