#pragma once
// What whole steps since the last factorisation say of how the tangent has changed: Broyden's good method, by his
// steps alone (Kelley, Iterative Methods for Linear and Nonlinear Equations, 1995, section 7.3).

#include "geometry/types.h"

namespace calot {

class SecantSteps {
 public:
  void clear() { steps_.clear(); }
  void add(VecX step, VecX dmultipliers);
  /// Turns the old factor's answer to a residual into that of the tangent the steps have seen.
  void correct(VecX& step, VecX& dmultipliers) const;

 private:
  struct Step {
    VecX x, multipliers;
    double squared;  ///< length of x squared, m^2
  };
  std::vector<Step> steps_;
};

}  // namespace calot
