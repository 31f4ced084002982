#pragma once
// How far skins and strands may go with the tools that move among them before one meets the other.

#include "field/field.h"

namespace calot {

/// Largest share [0 to 1] of the joint motion of an organ's skin (by dx, m, 3 a node) and tools (from poses to poses,
/// one a tool) that keeps them apart: each of the pairs at contact_keep times their present distance, at least.
double share_kept_apart(const Field& field, const Organ& organ, const ContactLoads& now,
                        const std::vector<ContactPair>& pairs, const VecX& dx,
                        const std::vector<InstrumentPose>& from, const std::vector<InstrumentPose>& to);

/// The same of a tissue's strands. `x` and `dx`: of all nodes of the group, m; `share`: what of the motion is looked
/// at, at most the result.
double share_kept_apart(const Field& field, const Tissue& tissue, const VecX& x, const VecX& dx,
                        const std::vector<InstrumentPose>& from, const std::vector<InstrumentPose>& to,
                        double share);

}  // namespace calot
