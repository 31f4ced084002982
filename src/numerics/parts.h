#pragma once
// The bodies that are solved together, each with its own nodes and its own scales: what is stiff or large must not hide
// what is soft or small.

#include "geometry/types.h"

namespace calot {

/// first .. last - 1.
struct NodeRange {
  int first = 0, last = 0;
  int size() const { return last - first; }
};

struct Part {
  NodeRange places;  ///< nodes whose coordinates are places
  NodeRange
      displacements;  ///< those of structural extensions, whose coordinates are added to them; may be empty
  double length = 1;     ///< m, the body's size: the scale of an increment
  bool weighed = false;  ///< masses count and resist all its motions: it is held by nothing and yet no mechanism

  int nodes() const { return places.size() + displacements.size(); }
  /// Calls use(node) for each.
  template <class Use>
  void for_nodes(const Use& use) const {
    for (const NodeRange& range : {places, displacements})
      for (int node = range.first; node < range.last; ++node) use(node);
  }
};

/// Length of the largest of the 3-vectors, one a node, that v is made of. NaN where one is.
double largest_node(const Eigen::Ref<const VecX>& v);
/// Of those of a part.
double largest_node(const Part& part, const VecX& v);
double largest_coordinate(const Part& part, const VecX& v);

/// Scale of a body's residual, N, from its largest internal nodal force: a body at rest carries none yet, then the
/// loads on it (the rest of the gradient) are the scale.
double force_scale(double largest_internal, const Eigen::Ref<const VecX>& gradient);

/// The largest of some values, >= 0, and which it is. The first that is not a number stays.
struct Worst {
  double value = 0;
  int index = 0;
  void take(double next, int of);
};

}  // namespace calot
