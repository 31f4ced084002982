#pragma once
// Cholesky factors whose fill stays near the diagonal: nodes are numbered so that coupled ones follow each other, and
// nothing beyond the last coupled row of a block of columns is touched (the envelope method: George and Liu, Computer
// Solution of Large Sparse Positive Definite Systems, 1981, chapter 4).

#include <limits>
#include <span>
#include <vector>

#include "numerics/block_matrix.h"
#include "numerics/dense_cholesky.h"

namespace calot {

/// Order of the nodes that keeps coupled ones close (reverse Cuthill-McKee): the node in each place. `neighbours`: of
/// each node, in any order.
std::vector<int> close_order(const std::vector<std::vector<int>>& neighbours);

/// The lower triangle of a symmetric matrix in such an order, dense within its envelope.
class EnvelopeFactor {
 public:
  EnvelopeFactor() = default;
  /// `neighbours` of each node of three unknowns: what is coupled.
  explicit EnvelopeFactor(const std::vector<std::vector<int>>& neighbours);

  /// Room for another factor of the same couplings.
  EnvelopeFactor blank() const;

  Eigen::Index size() const { return l_.rows(); }
  /// A matrix of these nodes is loaded by clear() and then set() for its blocks of coupled nodes (i, j), either half:
  /// entry (r, c) at block[c * stride + r], of a diagonal one the lower half is read.
  void clear(Workers* workers = nullptr);
  void set(int i, int j, const double* block, int stride);
  /// Takes the lower triangle of `product`, 3 x 3 blocks of all pairs of `nodes`, by columns, off what is loaded. Of
  /// `shares` each writes to columns of its own: all of them have to be called, and may be at once; k is a share's number.
  void subtract(std::span<const int> nodes, const double* product, int k = 0, int shares = 1);
  /// False when the matrix that was loaded is not positive definite.
  bool factorise(Workers* workers = nullptr);
  /// With the last factor, which must have succeeded.
  VecX solve(const VecX& right) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  /// L^-1 right, in the order of the factor's places: its columns' products with each other are those of right' K^-1 right.
  Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& right, Workers* workers = nullptr) const;
  /// Of no nodes: infinity, 0.
  double smallest_pivot() const {
    return size() > 0 ? l_.diagonal().minCoeff() : std::numeric_limits<double>::infinity();
  }
  double largest_pivot() const { return size() > 0 ? l_.diagonal().maxCoeff() : 0; }
  double flops() const;   ///< of one factorisation
  long nonzeros() const;  ///< within the envelope

 private:
  template <class Columns>
  Columns solve_columns(const Columns& right) const;
  Eigen::Index end_of(Eigen::Index column) const {
    return ends_[static_cast<std::size_t>(column / cholesky_block)];
  }

  Eigen::MatrixXd l_;
  std::vector<int> unknown_, place_;  ///< in each place of the order; of each unknown
  std::vector<Eigen::Index> ends_;    ///< of each block of columns: one past its last row, never falling
};

}  // namespace calot
