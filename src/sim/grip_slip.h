#pragma once
// How a grip gives way: opened by the jaws, or pulled through them.

#include "sim/field.h"

namespace calot {

/// Newton iterations that a release or a slip may take: one that needs more is blocked, and says so within
/// seconds.
inline constexpr int hold_iterations = 1500;

/// Opens a grip: its springs weaken step by step, so that the fold unfolds along equilibria, then vanish. On
/// failure (simulation) the grip holds as before.
Result<bool> release(Field& field, int instrument, SolveStatistics& statistics);

/// Pull of the held tissue along the pads on the tool, N, patient's frame: of the held points and of what
/// presses on the jaws, as a squeezed fold that pushes on the jaws' edges and is held back by their pads pulls
/// on nothing. What presses across the pads is carried by them.
Vec3 pad_pull(const Field& field, int instrument);

/// What both pads together must hold by friction, N, for a fold between them to bear a pull along them. They press it
/// out of the jaws as a wedge of half the jaws' angle, a: by 2 pinch sin a, which friction, that acts along the pads,
/// holds with its cos a.
Vec3 asked_of_friction(const Tool& tool, const Vec3& pull);

/// The most of that, N: each pad holds friction times the pinch (Coulomb). A pull along the jaws is held up to
/// 2 pinch (friction cos a - sin a).
double holding_limit(const Tool& tool);
/// The same of what the tool holds now: clips between its pads may give way before these do.
double holding_limit(const Field& field, int instrument);

/// Lets the held fold slide along the pads, in the direction of the pull, until they can hold it; skin that
/// slides off the pads is let go step by step, as in a release; clips that give way first are drawn along (clips.h).
/// Does nothing where friction is asked for no more than holding_limit. The pull that started it is returned, N, 0 when
/// nothing slipped; afterwards it is asked for at most 100.1% of the limit, and near it unless part of the fold has left
/// the pads. On failure (simulation) the grip holds as before.
Result<double> slip(Field& field, int instrument, SolveStatistics& statistics);

}  // namespace calot
