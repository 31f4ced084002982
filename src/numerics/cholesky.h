#pragma once
// LL^T of a block matrix: dense (Eigen) for small bodies, whose matrices are half full, and sparse (CHOLMOD,
// simplicial, symbolic factor reused) for larger ones; in the dense one the nodes of structural extensions are
// condensed onto the others first. None calls BLAS, so the bits do not depend on the machine.

#include <memory>
#include <span>
#include <vector>

#include "numerics/block_matrix.h"

namespace calot {

enum class FactorStatus { ok, not_finite, not_positive_definite, out_of_memory };

/// Up to this many nodes dense is the faster: 0.11 against 0.47 ms at 61 nodes, 1.4 against 5.0 at 180, 3.2
/// against 12.7 at 238, even at 946 (see tests/bench).
inline constexpr int dense_nodes = 600;

enum class FactorKind { dense, sparse, condensed };

/// The first `count` of `nodes` nodes are kept.
std::vector<char> first_kept(int nodes, int count);

class Cholesky {
 public:
  /// Analyses the pattern (sparse: fill-reducing order AMD); values are not read. `kept`, of each node: where it is 0
  /// the node may be condensed onto those that stay. An empty `kept` keeps all.
  explicit Cholesky(const BlockMatrix& pattern, std::span<const char> kept = {});
  Cholesky(const BlockMatrix& pattern, std::span<const char> kept, FactorKind kind);
  /// The first `coarse` nodes are kept.
  Cholesky(const BlockMatrix& pattern, int coarse) : Cholesky(pattern, first_kept(pattern.nodes(), coarse)) {}
  Cholesky(const BlockMatrix& pattern, int coarse, FactorKind kind)
      : Cholesky(pattern, first_kept(pattern.nodes(), coarse), kind) {}
  /// A copy shares the factor until either factorises anew.
  Cholesky(const Cholesky&) = default;
  Cholesky& operator=(const Cholesky&) = default;
  bool shares_factor_with(const Cholesky& other) const { return impl_ == other.impl_; }

  /// Factorises a matrix of the analysed pattern; values are checked to be finite before, the status after.
  FactorStatus factorise(const BlockMatrix& matrix);
  /// Solves with the last factor, which must be ok.
  VecX solve(const VecX& right) const;
  /// Cheap estimate of the reciprocal condition number: (smallest / largest diagonal of L)^2.
  double reciprocal_condition() const;
  double factor_flops() const;  ///< of one factorisation
  long factor_nonzeros() const;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace calot
