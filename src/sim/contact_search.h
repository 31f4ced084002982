#pragma once
// Which skin points may meet which shapes.

#include "collision/barrier.h"
#include "collision/shapes.h"
#include "sim/friction_load.h"
#include "sim/self_contact.h"
#include "sim/virtual_structure.h"

namespace calot {

/// The field that acts on an organ during one solve; shapes do not move within it.
struct Surroundings {
  std::vector<Shape> shapes;
  Barrier barrier;
  Links grip;             ///< rows of the skin's stencils
  FrictionLoad friction;  ///< of the same rows
};

/// A skin point near enough to a shape to meet it within a solve.
struct ContactPair {
  int row = 0;          ///< skin point
  int shape = 0;        ///< index into Surroundings::shapes
  double distance = 0;  ///< m, when it was gathered
};

/// How far outside the contact range pairs are gathered, m; no solve may move a node further than this.
inline constexpr double contact_margin = 5e-3;

/// Pairs within range + contact_margin + extra of the shapes, ordered by shape, then face, then point.
std::vector<ContactPair> gather_pairs(const VirtualStructure& body, const VecX& x, const Surroundings& field,
                                      double extra);

/// The same pairs with less work: points a little further away are remembered, and only these are looked at
/// until the skin and the shapes have moved so far that others could have come near. For one organ.
class ContactSearch {
 public:
  std::vector<ContactPair> pairs(const VirtualStructure& body, const VecX& x, const Surroundings& field,
                                 double extra);

  SelfContact own;  ///< the skin's with itself

 private:
  std::vector<ContactPair> near_;  ///< distances as they were then
  std::vector<Shape> shapes_;
  VecX x_;
  double reach_ = -1;  ///< m
};

}  // namespace calot
