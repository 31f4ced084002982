#pragma once
// Friction of an organ's contact points during one solve.

#include <vector>

#include "collision/friction.h"
#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

struct RubbingPoint {
  int row = 0;    ///< contact point
  int shape = 0;  ///< index into Surroundings::shapes
  StickSlip hold;
};

/// Ordered by shape, then row; each pair occurs once.
struct FrictionLoad {
  std::vector<RubbingPoint> points;

  /// Null when the pair does not rub.
  const RubbingPoint* find(int shape, int row) const;
  double value(const StencilTable& table, const VecX& x) const;  ///< J
  void add_gradient(const StencilTable& table, const VecX& x, VecX& gradient) const;
  void add_hessian(const StencilTable& table, const VecX& x, BlockMatrix& matrix) const;
};

}  // namespace calot
