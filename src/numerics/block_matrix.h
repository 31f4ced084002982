#pragma once
// The lower triangle of a symmetric matrix of 3x3 blocks, stored as CHOLMOD reads it, with a pattern fixed
// for good: assembly writes values only.

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/state_members.h"

namespace calot {

/// Block column j holds blocks i >= j in increasing i; its three scalar columns follow each other. The
/// diagonal blocks are stored whole (CHOLMOD ignores their upper entries).
class BlockMatrix {
 public:
  /// `cliques`: groups of nodes coupled with each other (an element's nodes). Every diagonal block exists.
  BlockMatrix(int nodes, std::span<const std::vector<int>> cliques);
  BlockMatrix() : BlockMatrix(0, {}) {}
  /// Of bodies whose nodes follow each other in the order of `parts`, with room for theirs and for the couplings of
  /// further cliques.
  BlockMatrix(std::span<const BlockMatrix> parts, std::span<const std::vector<int>> cliques);

  int nodes() const { return static_cast<int>(pattern_->block_start.size()) - 1; }
  int size() const { return 3 * nodes(); }
  void set_zero() { std::fill(values_.begin(), values_.end(), 0.0); }
  void scale(double factor);
  /// Starts from a constant part: `values` as entries() returned them from a matrix of the same pattern.
  void assign(const std::vector<double>& values) { values_ = values; }

  /// Adds values as entries() returned them from a matrix of the same pattern, times a factor.
  void add(const std::vector<double>& values, double factor = 1);

  /// The pattern without values, to be kept: blank() makes a matrix of zeros of it again.
  BlockMatrix pattern_only() const;
  BlockMatrix blank() const;
  bool same_pattern(const BlockMatrix& other) const { return pattern_ == other.pattern_; }

  /// The pattern as it is stored: where each block column begins, and their number, and each block's row.
  const std::vector<int>& block_starts() const { return pattern_->block_start; }
  const std::vector<int>& block_rows() const { return pattern_->block_row; }
  /// A matrix of zeros of such a pattern; none: it is no pattern.
  static std::optional<BlockMatrix> of_pattern(std::vector<int> block_starts, std::vector<int> block_rows);
  /// The pattern as cliques: a pair of nodes for each block.
  std::vector<std::vector<int>> couplings() const;
  /// The same values with room for the couplings of further cliques.
  BlockMatrix widened(std::span<const std::vector<int>> cliques) const;
  /// Starts from a matrix whose pattern this one's holds.
  void assign(const BlockMatrix& part);
  /// Adds a matrix whose first node is this one's `first`, and whose pattern this one's holds there.
  void add_part(const BlockMatrix& part, int first);

  /// Offset of entry (0, 0) of block (i, j), i >= j; -1 when the pattern does not hold it. Entry (r, c) lies
  /// at slot + c * stride(j) + r.
  int slot(int i, int j) const {
    return pattern_->slots.empty() ? search(i, j)
                                   : pattern_->slots[static_cast<std::size_t>(j) * nodes() + i];
  }
  /// slot(nodes[k], nodes[0]) for each of the increasing `nodes`, which the pattern must hold.
  void slots(std::span<const int> nodes, int* out) const;
  int stride(int j) const { return 3 * (pattern_->block_start[j + 1] - pattern_->block_start[j]); }
  double* values() { return values_.data(); }

  /// Adds to block (i, j), i >= j, which the pattern must hold.
  void add(int i, int j, const Mat3& block);
  void add_to_diagonal(double shift);
  void add_to_diagonal(int node, double shift);
  double diagonal(int unknown) const { return values_[column_starts()[unknown] + unknown % 3]; }
  /// Nodes that are not `free` (one a node) are held: not coupled any more, on their diagonals the matrix' mean.
  void hold_all_but(const std::vector<char>& free);
  double diagonal_mean() const;
  bool all_finite() const;
  /// y = A x.
  VecX multiply(const VecX& x) const;

  /// Compressed columns for CHOLMOD: size() + 1 starts, row of each value (increasing in a column).
  const std::vector<int>& column_starts() const { return pattern_->column_starts; }
  const std::vector<int>& rows() const { return pattern_->rows; }
  const std::vector<double>& entries() const { return values_; }

 private:
  /// Shared by the copies of a matrix.
  struct Pattern {
    std::vector<int> block_start;  ///< nodes + 1, into block_row
    std::vector<int> block_row;
    std::vector<int> column_starts, rows;
    std::vector<int> slots;  ///< of every pair (i, j) at j * nodes + i, for few nodes
    /// What follows from the blocks.
    void complete();
  };
  explicit BlockMatrix(std::shared_ptr<const Pattern> pattern) : pattern_(std::move(pattern)) {}
  int search(int i, int j) const;
  /// A clique of two for each block, nodes counted from `first`.
  void add_cliques(int first, std::vector<std::vector<int>>& cliques) const;

  std::shared_ptr<const Pattern> pattern_;
  std::vector<double> values_;
};
/// The pattern alone.
void visit_members(auto&& visit, const BlockMatrix& matrix) {
  visit(matrix.block_starts(), matrix.block_rows());
}
void visit_members(MemberReader& read, BlockMatrix& matrix);

}  // namespace calot
