#pragma once
// Where the node of one strand is in balance between its ends, while those stay: three unknowns. Newton's method on all
// bodies so need not find it: what is left to it is smooth where a thread grows taut or slips over an instrument
// (nonlinear elimination; Lanzkron, Rose and Wilkes 1996).

#include "joins/strand_touch.h"

namespace calot {

/// What acts on a strand's node beside the strand: a force that changes by its stiffness as the node moves.
struct NodeLoad {
  Vec3 gradient = Vec3::Zero();  ///< N, of the load's energy, where the node is now
  double stiffness = 0;          ///< N/m
};

struct StrandBetween {
  const Strand& strand;
  const StrandPast& past;
  const StrandThread* thread;  ///< null: it meets nothing
  const StrandTouch& touch;
};

/// The node's place, m, at the end of the way down from where it is, past nothing that the strand touches: forces on it then
/// cancel but for 1e-9 of the strand's strength, unless rounding or the touched forbid. It stays where 1e-7 is left.
Vec3 balanced_node(const StrandBetween& strand, const NodeLoad& load, const StrandVector& places);

}  // namespace calot
