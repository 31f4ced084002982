#pragma once
// A mass matrix as it is multiplied: where masses act alike along x, y and z one number stands for each 3 x 3 block.

#include <vector>

#include "numerics/block_matrix.h"

namespace calot {

class NodalMass {
 public:
  /// The matrix must outlive it.
  explicit NodalMass(const BlockMatrix& mass);
  /// M x, of 3 coordinates a node.
  VecX multiply(const VecX& x) const;

 private:
  std::vector<int> begin_;  ///< of each node's column, nodes + 1
  std::vector<int> row_;    ///< >= the column, increasing: the diagonal first
  std::vector<double> mass_;
  /// Where some block is not a number times the identity: a condensed solid's; else null.
  const BlockMatrix* whole_ = nullptr;
};

}  // namespace calot
