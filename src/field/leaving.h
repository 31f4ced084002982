#pragma once
// What opening jaws let go where masses count. A crumpled fold that is set free at once unfolds within a hundredth of a
// second, further than one step of the solver can follow. Pads that open rub on it: each point that they let go is
// dragged, the more the faster it moves against the mean of all of the organ that the tool let go, and less and less, until
// it is out of the jaws. As a whole the fold moves freely, but that its mean is that of the last step.

#include "field/field.h"

namespace calot {

/// Drag of a point as it is let go, N s/m: it takes 4 mm of way in a 25th of a second from 40 N. Uncalibrated.
inline constexpr double leaving_drag = 400;
/// Time in which the drag falls by e, s, and after which there is none, s: a thousandth is left then. Uncalibrated.
inline constexpr double leaving_decay = 0.06, leaving_time = 0.42;

/// Lets go all that a tool holds. What is not a wall with teeth in it (is_bitten) is free at once.
void let_leave(Field& field, ToolIndex instrument);

/// The drag in the part of a motion that the organ is in: a spring a point, to where the mean velocity with which the part
/// began takes it. None without a motion.
GripSprings leaving_springs(const Organ& organ);

/// Frees what the tool let go, as it takes hold anew.
void end_leaving(Field& field, ToolIndex instrument);
/// Time has passed, s: frees the points whose time is over.
void pass_leaving(Field& field, double duration);

}  // namespace calot
