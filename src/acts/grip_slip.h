#pragma once
// How a grip gives way: opened by the jaws, drawn off their pads, pulled through them or turned between them.

#include "field/field.h"

namespace calot {

/// Newton iterations that a release, a slip or what leaves its pads may take, each: one that needs more is blocked, and says so within
/// seconds.
inline constexpr int hold_iterations = 1500;

/// Opens a grip: its springs weaken step by step, so that the fold unfolds along equilibria, then vanish; where masses count
/// they vanish at once. On failure (simulation) the grip holds as before.
Result<bool> release(Field& field, ToolIndex instrument, SolveStatistics& statistics);

/// What the held tissue does to a tool along its pads: the held points, and what presses on the jaws, as a squeezed fold
/// that pushes on the jaws' edges and is held back by their pads pulls on nothing. What presses across the pads is carried
/// by them.
struct PadLoad {
  Vec3 pull = Vec3::Zero();  ///< N, patient's frame
  double couple = 0;         ///< N m, about the shaft, right-handed about its direction
};
PadLoad pad_load(const Field& field, ToolIndex instrument);

/// The largest couple about the shaft that the pads hold of what is between them, N m: each presses with its pinch on the
/// half of its width at least, evenly, a quarter of the width from its middle. More turns what they hold between them,
/// until the couple is down to turning_share of that: where pressure falls in a straight line from one edge to nothing at
/// the other, as a bearing surface's does whose load leaves its middle third (pinch x width / 6 a pad).
double couple_limit(const Tool& tool);
inline constexpr double turning_share = 2.0 / 3;

/// What both pads together must hold by friction, N, for a fold between them to bear a pull along them. They press it
/// out of the jaws as a wedge of half the jaws' angle, a: by 2 pinch sin a, which friction, that acts along the pads,
/// holds with its cos a.
Vec3 asked_of_friction(const Tool& tool, const Vec3& pull);

/// The most of that, N: each pad holds friction times the pinch (Coulomb). A pull along the jaws is held up to
/// 2 pinch (friction cos a - sin a).
double holding_limit(const Tool& tool);
/// The same of what the tool holds now: clips between its pads may give way before these do.
double holding_limit(const Field& field, ToolIndex instrument);

/// What is asked of a tool's pads.
struct Asked {
  double share = 0;    ///< of what they hold; above 1 it is not held
  bool turns = false;  ///< by a couple about the shaft; else by a pull
};
/// By the pull or the couple, whichever comes nearer to what is held of it.
Asked asked_of_pads(const Field& field, ToolIndex instrument);

/// Notes where more is asked of what any tool holds than holds, as nothing slips any more in this step: its forces are not to
/// be judged.
void note_unasked(const Field& field, SolveStatistics& statistics);

/// What has been drawn off its pad by more than the teeth reach is let go, as in a release; where masses count it is only
/// told to leave, as the next step begins (let_left_go()). Fails (simulation) where it finds no rest; the grip holds as
/// before then.
Result<bool> leave_pads(Field& field, ToolIndex instrument, SolveStatistics& statistics);
/// Lets go what was told to leave. Nothing is solved for that: the step moves what was held.
void let_left_go(Field& field);

/// What a fold did between its pads.
struct Slipped {
  bool slid = false;    ///< it did anything
  bool turned = false;  ///< it turned, at first
  double pull = 0;      ///< N, that it was pulled by along the pads when it began
};

/// Lets the held fold slide along the pads, in the direction of the pull, or turn about the shaft, until they can hold
/// it; skin that slides off the pads is let go, as in a release; clips that give way first are drawn along
/// (clips.h). Does nothing where no more is asked for than holding_limit and couple_limit. Afterwards friction is asked for
/// at most 100.1% of its limit, and near it unless part of the fold has left the pads. On failure (simulation) the grip
/// holds as before. Where masses count and the step's budget is spent before, the rest is left to the next step; and what
/// turns stops where the whole couple_limit holds it, as each step asks anew.
Result<Slipped> slip(Field& field, ToolIndex instrument, SolveStatistics& statistics);

}  // namespace calot
