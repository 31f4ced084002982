#pragma once
// How a grip gives way: opened by the jaws, or pulled through them.

#include "sim/field.h"

namespace calot {

/// Opens a grip: its springs weaken step by step, so that the fold unfolds along equilibria, then vanish. On
/// failure (simulation) the grip holds as before.
Result<bool> release(Field& field, int instrument, SolveStatistics& statistics);

/// Pull of the held skin along the pads on the tool, N, patient's frame; what presses on a pad is carried by
/// it.
Vec3 pad_pull(const Field& field, int instrument);

/// Largest pull that two pads hold, N: each holds friction times the pinch (Coulomb).
double holding_limit(const Tool& tool);

/// Lets the held fold slide along the pads, in the direction of the pull, until they can hold it; skin that
/// slides off the pads is let go. Does nothing below holding_limit. The pull that started it is returned, N,
/// 0 when nothing slipped; afterwards the pull is at most 100.1% of the limit, and near it unless part of
/// the fold has left the pads. On failure (simulation) the grip holds as before.
Result<double> slip(Field& field, int instrument, SolveStatistics& statistics);

}  // namespace calot
