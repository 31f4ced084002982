#pragma once
// Where the strands of a tissue run, to be drawn.

#include <vector>

#include "sim/tissue.h"

namespace calot {

struct StrandLine {
  Vec3 from, by, to;  ///< m: its ends, and its own node
  Vec3 at(double share) const {
    return share < 0.5 ? Vec3(from + 2 * share * (by - from)) : Vec3(by + (2 * share - 1) * (to - by));
  }
};

/// `nodes`: of its strands, three numbers each; `skins`: of the field's organs, in their order.
std::vector<StrandLine> strand_lines(const Tissue& tissue, const VecX& nodes,
                                     const std::vector<std::vector<Vec3>>& skins);

}  // namespace calot
