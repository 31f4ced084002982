#pragma once
// Constraints beside a matrix that is factorised: the solutions of
//   [ K  -C ] [dx]   [ load    ]
//   [ C'  E ] [dm] = [ -values ]
// from those of K alone and the small Schur complement C' K^-1 C + E, E the diagonal of the constraints' compliances.

#include <optional>

#include "numerics/cholesky.h"

namespace calot {

struct Border {
  Eigen::MatrixXd gradients;   ///< C: 3 a node, a column a constraint; at the last factorisation
  VecX compliances;            ///< E, >= 0, one a constraint; empty: all 0
  Eigen::MatrixXd answers;     ///< K^-1 C
  Eigen::MatrixXd complement;  ///< C' K^-1 C + E

  int constraints() const { return static_cast<int>(gradients.cols()); }
  std::vector<int> kept() const;  ///< those without a compliance
  /// To a factor of K.
  void solve_with(const Cholesky& factor, Workers* workers = nullptr);
  /// A constraint that no step can keep beside the others: its gradient is none, or but for rounding in theirs. One with
  /// a compliance gives way instead.
  std::optional<int> dependent() const;
  /// Turns K^-1 load into dx, for what the constraints and their compliances leave now; returns dm.
  VecX keep(const VecX& values, VecX& step) const;
  /// Adds to a step what takes the constraints' values at its end to 0, to first order; returns dm.
  VecX restore(const VecX& values, VecX& step) const;
};
void visit_members(auto&& visit, MembersOf<Border> auto& border) {
  auto& [gradients, compliances, answers, complement] = border;
  visit(gradients, compliances, answers, complement);
}

}  // namespace calot
