#pragma once
// What leaves organs by openings: bile by the end of a duct that was cut or a hole in a wall, blood by an artery's end.
//
// An opening lets out Q = Cd A sqrt(2 p / rho) at the pressure p on its inside; A is the smallest area on the way there:
// of the lumen, of what clips leave open of it, and of what jaws do that pinch it. What drives it:
// - a hollow organ, of which its wall and the liquid's weight do. Its volume falls by what leaves, so that its pressure
//   does too and it slackens: by the wall's compliance C, as the last factor knows it, sqrt(p) falls along a straight
//   line. Of one opening the error of a step is what C changes in it.
// - the patient, by a pressure behind a resistance: p = R Q + rho / 2 (Q / (Cd A))^2; blood's beats with the heart. A
//   duct's folds (the valves of Heister) resist what an organ drives through it in the same way.
// - nothing: what a tube holds runs out of it.
// Steps are cut into milliseconds: a pulse is known to 1e-5 so, and two openings of one organ share its pressure.

#include "field/field.h"

namespace calot {

/// Lets out what leaves in `duration` s up to field.time: liquids' kept volumes fall, field.spill.lost grows, and drops
/// begin to hang on openings; what needles are in is drawn out beside (aspirate.h). Returns the events bile_leak, bleeding
/// and leak_stopped.
std::vector<WorldEvent> leak(Field& field, double duration);

}  // namespace calot
