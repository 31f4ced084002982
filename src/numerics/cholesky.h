#pragma once
// LL^T of a block matrix: dense (Eigen) for small bodies, whose matrices are half full, and sparse (CHOLMOD,
// simplicial, symbolic factor reused) for larger ones; in the dense one the nodes of structural extensions are
// condensed onto the others first. None calls BLAS, so the bits do not depend on the machine.

#include <limits>
#include <memory>

#include "numerics/block_matrix.h"

namespace calot {

enum class FactorStatus { ok, not_finite, not_positive_definite, out_of_memory };

/// Up to this many nodes dense is the faster: 0.11 against 0.47 ms at 61 nodes, 1.4 against 5.0 at 180, 3.2
/// against 12.7 at 238, even at 946 (see tests/bench).
inline constexpr int dense_nodes = 600;

enum class FactorKind { dense, sparse, condensed };

class Cholesky {
 public:
  /// Analyses the pattern (sparse: fill-reducing order AMD); values are not read. With `coarse` nodes before
  /// those of extensions the latter are condensed, where the factor is dense.
  explicit Cholesky(const BlockMatrix& pattern, int coarse = std::numeric_limits<int>::max())
      : Cholesky(pattern, coarse,
                 pattern.nodes() > dense_nodes ? FactorKind::sparse
                 : coarse < pattern.nodes()    ? FactorKind::condensed
                                               : FactorKind::dense) {}
  Cholesky(const BlockMatrix& pattern, int coarse, FactorKind kind);
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
