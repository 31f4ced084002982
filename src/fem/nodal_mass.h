#pragma once
// A mass matrix as it is multiplied: masses act alike along x, y and z, so one number stands for each 3 x 3 block.

#include <vector>

#include "numerics/block_matrix.h"

namespace calot {

class NodalMass {
 public:
  /// Each block of `mass` is a number times the identity, kg.
  explicit NodalMass(const BlockMatrix& mass);
  /// M x, of 3 coordinates a node.
  VecX multiply(const VecX& x) const;

 private:
  std::vector<int> begin_;  ///< of each node's column, nodes + 1
  std::vector<int> row_;    ///< >= the column, increasing: the diagonal first
  std::vector<double> mass_;
};

}  // namespace calot
