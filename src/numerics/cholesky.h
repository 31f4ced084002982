#pragma once
// LL^T of a block matrix: dense within an envelope (Eigen), where nodes that may be are condensed onto the others first,
// or sparse (CHOLMOD, simplicial, symbolic factor reused). None calls BLAS, so the bits do not depend on the machine.

#include <memory>
#include <span>
#include <vector>

#include "base/workers.h"
#include "numerics/block_matrix.h"

namespace calot {

enum class FactorStatus { ok, not_finite, not_positive_definite, out_of_memory };

/// What serves a matrix is chosen by counts alone. Dense sums run in the processor's wide registers, ten times as many
/// a second as CHOLMOD's simplicial ones, and condensation keeps the count low: the envelope serves up to dense_nodes
/// kept nodes, unless it takes more than dense_flops and ten times what the sparse factor takes. Factorisation, ms
/// (tests/bench/factor_bench.cpp: shells, rods of 11 nodes between them, strands of one node from face to face):
///
///   nodes      rods strands | whole envelope | sparse | condensed
///   180           0       0 |           0.37 |    3.1 |         -
///   180           2       0 |           0.49 |    3.9 |      0.70  (rods tie far parts: their inside is better kept)
///   180           0     300 |            5.9 |    4.1 |      0.60
///   180 + 40      2     100 |            2.1 |    9.5 |       1.1
///   180 + 40      2     600 |             45 |     12 |       1.7
///   180 + 100     4     300 |             14 |     14 |       2.4
///   238 + 238     6     300 |             18 |     49 |       5.7
///   300 + 200     6     600 |             47 |     47 |       6.9
///   946           0       0 |            9.2 |     90 |         -
inline constexpr double dense_flops = 3e8;
/// Beyond, the envelope's memory (162 MB where it is full) is what counts.
inline constexpr int dense_nodes = 1500;

/// Dense: the envelope of everything.
enum class FactorKind { dense, sparse, condensed };

/// The first `count` of `nodes` nodes are kept.
std::vector<char> first_kept(int nodes, int count);

class Cholesky {
 public:
  /// Analyses the pattern (sparse: fill-reducing order AMD); values are not read. `kept`, of each node: where it is 0
  /// the node may be condensed onto those that stay, which pays for pieces that meet few of them, close together. An
  /// empty `kept` keeps all.
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
  FactorStatus factorise(const BlockMatrix& matrix, Workers* workers = nullptr);
  /// Solves with the last factor, which must be ok.
  VecX solve(const VecX& right) const;
  /// Many columns in a fraction of the time that they take one by one.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right, Workers* workers = nullptr) const;
  /// What each of `nodes`, increasing, answers to loads on them alone: these rows and columns of the matrix' inverse,
  /// 3 a node.
  Eigen::MatrixXd compliance(std::span<const int> nodes, Workers* workers = nullptr) const;
  /// Cheap estimate of the reciprocal condition number: (smallest / largest diagonal of L)^2.
  double reciprocal_condition() const;
  FactorKind kind() const;
  /// `kept` as it was made with.
  const std::vector<char>& kept() const;
  /// Entries of the matrix that was factorised last: another Cholesky of the same pattern and `kept` makes the same factor
  /// of them, to the last bit.
  const std::vector<double>& factorised() const;
  double factor_flops() const;  ///< of one factorisation
  long factor_nonzeros() const;

 private:
  struct Impl;
  template <class Columns>
  Columns solve_columns(const Columns& right) const;
  std::shared_ptr<Impl> impl_;
};

}  // namespace calot
