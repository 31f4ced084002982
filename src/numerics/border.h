#pragma once
// Constraints beside a matrix that is factorised: the solutions of
//   [ K  -C ] [dx]   [ load    ]
//   [ C'  0 ] [dm] = [ -values ]
// from those of K alone and the small Schur complement C' K^-1 C.

#include <optional>

#include "numerics/cholesky.h"

namespace calot {

struct Border {
  Eigen::MatrixXd gradients;   ///< C: 3 a node, a column a constraint; at the last factorisation
  Eigen::MatrixXd answers;     ///< K^-1 C
  Eigen::MatrixXd complement;  ///< C' K^-1 C

  int constraints() const { return static_cast<int>(gradients.cols()); }
  /// To a factor of K.
  void solve_with(const Cholesky& factor);
  /// A constraint that no step can keep beside the others: its gradient is none, or but for rounding in theirs.
  std::optional<int> dependent() const;
  /// Turns K^-1 load into dx, for the constraints' values now; returns dm.
  VecX keep(const VecX& values, VecX& step) const;
};

}  // namespace calot
