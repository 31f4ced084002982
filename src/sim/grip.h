#pragma once
// How jaws take hold of skin and let it go. Friction is not modelled yet: a closing pad holds what it
// touches.

#include "sim/advance.h"

namespace calot {

/// Skin points that touch a pad of a closing tool are held by it from here on.
void take_hold(Field& field, int instrument);

/// Multiplies the stiffness of everything the tool holds by `share`.
void loosen(Field& field, int instrument, double share);

/// Lets everything go that the tool holds, without seeking the equilibrium that follows.
void let_go(Field& field, int instrument);

/// True when both jaws hold skin and the pads are as near as the folded wall allows.
bool fold_fills_jaws(const Field& field, int instrument);

/// Springs of an organ's held points for the tools at `poses`.
Links grip_links(const Organ& organ, const std::vector<Tool>& tools,
                 const std::vector<InstrumentPose>& poses);

}  // namespace calot
