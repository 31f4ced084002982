#pragma once
// Distance of two edges that both move: what two skins need beside points against triangles.

#include <array>

#include "geometry/types.h"

namespace calot {

/// The ends of one edge, then those of the other, m; or their motions.
using EdgePair = std::array<Vec3, 4>;

/// Between what the shortest way from edge to edge runs.
enum class EdgesMeet {
  between_ends,  ///< inside of both, across both: only a pair of edges sees this
  at_one_end,  ///< from an end to the inside of the other edge, as the pair of that point and a triangle of that edge
  at_two_ends  ///< from end to end, as the pair of a point and a triangle at the other
};

/// The nearest places of two edges. Parallel edges (to 1e-6 of an angle), and those without a length, are nearest at
/// an end: of equally near ends the first.
struct NearestOfEdges {
  EdgesMeet meet = EdgesMeet::between_ends;
  double distance = 0;            ///< m, not negative
  Vec3 normal = Vec3::Zero();     ///< unit, from the other edge to the first; zero where they touch
  std::array<double, 4> weight{}; /**< of the first edge's ends, summing to 1, and minus those of the other's:
                                       weight[k] * normal is the distance's gradient by the four ends */
};
NearestOfEdges nearest_of_edges(const EdgePair& ends);
/// From the other's nearest place to the first's, m, at a tenth of the cost; of edges parallel to rounding from places
/// nearly as near.
Vec3 between_edges(const EdgePair& ends);

/// The largest share (0 to 1, to 1e-9 of the motion) of the straight motions of the ends such that for every share s up
/// to it distance(s) >= keep * distance(0), 0 < keep < 1, however the edges meet on the way. Touching at the start,
/// or a value that is not finite, gives 0. It is not needlessly small: see safe_share_of(), of whose steps there are
/// up to 4096: edges that turn on each other at a small distance need many.
double safe_share(const EdgePair& ends, const EdgePair& motions, double keep);

}  // namespace calot
