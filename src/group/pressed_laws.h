#pragma once
// What presses on one body, where a step changes it by more than its tangent says: shapes that touch and pads that grip.

#include <span>

#include "group/contact_search.h"
#include "numerics/sharp_terms.h"

namespace calot {

/// What they add to a body's matrix at x; `convex`: without how distances curve.
std::vector<SharpTangent> pressed_tangents(const Body& body, const ContactLoads& loads,
                                           const std::vector<Touch>& touches, const VecX& x, bool convex);

/// Whether a tangent is of a place that the body has.
bool fits(const SharpTangent& tangent, const Body& body);

class PressedLaws {
 public:
  struct Step {
    const VecX& x;
    const VecX& step;
    const std::vector<Touch>& before;  ///< what touches at x
    const std::vector<Touch>& after;   ///< and at its end
  };
  /// Of `pairs` that may meet, of the grips and of what was touched or gripped when these tangents were taken, those whose
  /// forces at a step's end are off what the tangents say by more than `least`, N. Body and loads must outlive it.
  PressedLaws(const Body& body, const ContactLoads& loads, const std::vector<ContactPair>& pairs,
              const Step& step, double least, std::span<const SharpTangent> tangents);

  bool none() const { return pairs_.empty() && grip_.row.empty() && tangents_.empty(); }
  /// Marks, one a node, those that they hang on.
  void mark_nodes(std::vector<char>& marks) const;
  double value(const VecX& x) const;                       ///< J
  void add_gradient(const VecX& x, VecX& gradient) const;  ///< N
  /// N/m; `convex`: without how distances curve.
  void add_hessian(const VecX& x, bool convex, BlockMatrix& matrix) const;
  void add_tangents(BlockMatrix& matrix) const;  ///< N/m

 private:
  std::vector<Touch> touching(const VecX& x) const;

  const Body& body_;
  const ContactLoads& loads_;
  std::vector<ContactPair> pairs_;
  GripSprings grip_;
  std::vector<SharpTangent> tangents_;
};

}  // namespace calot
