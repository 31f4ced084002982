#pragma once
// What of an organ's state goes with a piece of it when it is divided.

#include "body/body_cut.h"
#include "organs/organ.h"

namespace calot {

/// Where an organ is held flat; nowhere: it is no tube.
std::vector<TubePinch> pinches_of(const Organ& organ);

/// One of the pieces of an organ, the start's (0) or the end's (1), where and as it moves: with the skin that is held,
/// rubs or is burnt on it, and the clips and openings there. What is just at the cut is the start's; where what it
/// carries can leave it at the cut, it has an opening there.
Organ piece_of(const Organ& whole, const BodyCut& cut, int side);
/// Calls a piece so from now on.
void name_piece(Organ& piece, const std::string& name);

}  // namespace calot
