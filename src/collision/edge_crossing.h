#pragma once
// The contact potential of two edges that cross: what points against triangles leave out.

#include "collision/barrier.h"
#include "collision/edge_distance.h"

namespace calot {

/// Energy of a unit area of skin (J/m^2) of a pair of edges,
///   e = fade(c / parallel_below) window(s) window(t) barrier(distance),
/// where s and t, 0 to 1, are where on its edge each nearest place lies and c = |u x v|^2 of the edges' vectors.
///
/// Only edges that meet between their ends (EdgesMeet) count: window(s) = (4 s (1 - s))^2 is 1 in the middle and goes to
/// 0 at the ends with its slope. From there on the pair is one of a point and a triangle, which the sum over parts
/// counts (collision/surface_parts.h): so nothing counts twice and nothing jumps.
///
/// Where edges become parallel the nearest places leap from end to end: fade(y) = y^2 (3 - 2 y) below 1, then 1, takes
/// the energy to 0 there, as the mollifier of Li et al. 2020 (Incremental Potential Contact, section 5.2, doi
/// 10.1145/3386569.3392425) does. Theirs, y (2 - y), is for the distance alone: s and t move by distance / (length *
/// sine)^2 as the normal tilts, and only a double zero holds slopes of their windows down. So e is C1, its slope 0
/// between parallels, and its Hessian bounded, where the edges do not touch.
///
/// What fades is never alone: where s or t nears an end, or the edges each other's direction, an end comes as near as
///   sqrt(distance^2 + (share of the edge up to its end * length * sine of the angle)^2)
/// to the other edge, and the barrier of that point against a triangle holds.
struct EdgeCrossing {
  Barrier barrier;            ///< without a soft share: edges have no inside to pass through
  double parallel_below = 0;  ///< m^4, > 0; see parallel_bound()

  /// For edges of these lengths at rest and a barrier's range, m: (range * the longer)^2. Below it an end lies within
  /// half a range beside the other edge, and what the windows push along the skin is less than the barrier presses; with
  /// the paper's 1e-3 (length * other length)^2 edges of 2 mm would push several times that.
  static double parallel_bound(double length, double other_length, double range);

  using Slope = Eigen::Matrix<double, 12, 1>;
  using Bend = Eigen::Matrix<double, 12, 12>;
  /// Energy and its derivatives by the four ends, in the order of EdgePair: J/m^2, J/m^3, J/m^4. All zero for edges
  /// that do not meet between their ends or not within the range. Of edges that touch the energy is infinite and the
  /// derivatives are zero: a state no accepted step may reach.
  double energy(const EdgePair& ends) const;
  struct Sample {
    double energy = 0;
    Slope gradient = Slope::Zero();
    Bend hessian = Bend::Zero();  ///< symmetric, indefinite
  };
  Sample sample(const EdgePair& ends) const;
};

}  // namespace calot
