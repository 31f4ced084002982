#include "numerics/cholesky.h"

#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "numerics/condense.h"
#include "numerics/envelope.h"

namespace calot {
namespace {

/// Which of the first `count` nodes each is coupled with: by the pattern, and in `groups`.
std::vector<std::vector<int>> couplings(const BlockMatrix& pattern, int count,
                                        const std::vector<std::vector<int>>& groups) {
  std::vector<std::vector<int>> out(static_cast<std::size_t>(count));
  const auto couple = [&](int a, int b) {
    out[a].push_back(b);
    out[b].push_back(a);
  };
  for (int column = 0; column < count; ++column)
    for (int e = pattern.column_starts()[3 * column]; e < pattern.column_starts()[3 * column + 1]; e += 3)
      if (const int row = pattern.rows()[e] / 3; row > column && row < count) couple(row, column);
  for (const std::vector<int>& group : groups)
    for (int a : group)
      for (int b : group)
        if (b < a) couple(a, b);
  for (std::vector<int>& of_node : out) {
    std::sort(of_node.begin(), of_node.end());
    of_node.erase(std::unique(of_node.begin(), of_node.end()), of_node.end());
  }
  return out;
}

}  // namespace

struct Cholesky::Impl {
  FactorKind kind = FactorKind::dense;
  std::optional<Condensation> condensation;
  EnvelopeFactor kept;  ///< of the whole matrix, or of what it is condensed to; empty where that is sparse
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  // Workspaces that cholmod_solve2 keeps between calls.
  cholmod_dense* solution = nullptr;
  cholmod_dense* work_y = nullptr;
  cholmod_dense* work_e = nullptr;

  Impl() {
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_ll = 1;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_AMD;
    common.print = 0;
    common.quick_return_if_not_posdef = 1;
  }
  /// Room for another factor of the same pattern.
  explicit Impl(const Impl& like) : Impl() {
    kind = like.kind;
    condensation = like.condensation;
    kept = like.kept.blank();
    if (like.factor != nullptr) factor = cholmod_copy_factor(like.factor, &common);
  }
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }

  FactorStatus factorise_dense(const BlockMatrix& matrix);
  FactorStatus factorise_condensed(const BlockMatrix& matrix);
  FactorStatus factorise_sparse(const BlockMatrix& matrix);

  // CHOLMOD reads through non-const pointers and does not write through them here.
  static cholmod_sparse view(const BlockMatrix& matrix) {
    cholmod_sparse sparse{};
    sparse.nrow = sparse.ncol = static_cast<std::size_t>(matrix.size());
    sparse.nzmax = matrix.entries().size();
    sparse.p = const_cast<int*>(matrix.column_starts().data());
    sparse.i = const_cast<int*>(matrix.rows().data());
    sparse.x = const_cast<double*>(matrix.entries().data());
    sparse.stype = -1;  // lower triangle
    sparse.itype = CHOLMOD_INT;
    sparse.xtype = CHOLMOD_REAL;
    sparse.dtype = CHOLMOD_DOUBLE;
    sparse.sorted = 1;
    sparse.packed = 1;
    return sparse;
  }
};

Cholesky::Cholesky(const BlockMatrix& pattern, int coarse, FactorKind kind)
    : impl_(std::make_shared<Impl>()) {
  impl_->kind = kind;
  if (kind == FactorKind::condensed) {
    impl_->condensation.emplace(pattern, coarse);
    impl_->kept = EnvelopeFactor(couplings(pattern, coarse, impl_->condensation->outer_nodes()));
  } else if (kind == FactorKind::dense) {
    impl_->kept = EnvelopeFactor(couplings(pattern, pattern.nodes(), {}));
  } else {
    cholmod_sparse sparse = Impl::view(pattern);
    impl_->factor = cholmod_analyze(&sparse, &impl_->common);
  }
}

FactorStatus Cholesky::factorise(const BlockMatrix& matrix) {
  // Neither library minds a NaN (CHOLMOD 3.0.14 takes one on the diagonal for a success), so look before.
  if (!matrix.all_finite()) return FactorStatus::not_finite;
  if (impl_.use_count() > 1) impl_ = std::make_shared<Impl>(*impl_);
  if (impl_->kind == FactorKind::sparse) return impl_->factorise_sparse(matrix);
  return impl_->kind == FactorKind::dense ? impl_->factorise_dense(matrix)
                                          : impl_->factorise_condensed(matrix);
}

FactorStatus Cholesky::Impl::factorise_dense(const BlockMatrix& matrix) {
  kept.load(matrix);
  return kept.factorise() ? FactorStatus::ok : FactorStatus::not_positive_definite;
}

FactorStatus Cholesky::Impl::factorise_condensed(const BlockMatrix& matrix) {
  const FactorStatus status = condensation->eliminate(matrix);
  if (status != FactorStatus::ok) return status;
  kept.load(condensation->condensed());
  return kept.factorise() ? FactorStatus::ok : FactorStatus::not_positive_definite;
}

FactorStatus Cholesky::Impl::factorise_sparse(const BlockMatrix& matrix) {
  if (factor == nullptr) return FactorStatus::out_of_memory;
  cholmod_sparse sparse = view(matrix);
  cholmod_factorize(&sparse, factor, &common);
  if (common.status == CHOLMOD_NOT_POSDEF || factor->minor < factor->n)
    return FactorStatus::not_positive_definite;
  return common.status == CHOLMOD_OK ? FactorStatus::ok : FactorStatus::out_of_memory;
}

VecX Cholesky::solve(const VecX& right) const {
  if (impl_->kind == FactorKind::dense) return impl_->kept.solve(right);
  if (impl_->kind == FactorKind::condensed)
    return impl_->condensation->expand(right, impl_->kept.solve(impl_->condensation->reduce(right)));
  cholmod_dense b{};
  b.nrow = b.nzmax = b.d = static_cast<std::size_t>(right.size());
  b.ncol = 1;
  b.x = const_cast<double*>(right.data());
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, impl_->factor, &b, nullptr, &impl_->solution, nullptr, &impl_->work_y,
                 &impl_->work_e, &impl_->common);
  VecX x =
      VecX::Constant(right.size(), std::numeric_limits<double>::quiet_NaN());  // out of memory: not finite
  if (impl_->solution == nullptr || impl_->common.status < CHOLMOD_OK) return x;
  std::memcpy(x.data(), impl_->solution->x, sizeof(double) * static_cast<std::size_t>(x.size()));
  return x;
}

double Cholesky::reciprocal_condition() const {
  if (impl_->kind == FactorKind::sparse) return cholmod_rcond(impl_->factor, &impl_->common);
  double smallest = impl_->kept.smallest_pivot(), largest = impl_->kept.largest_pivot();
  if (impl_->kind == FactorKind::condensed && impl_->condensation->groups() > 0) {
    smallest = std::min(smallest, impl_->condensation->smallest_pivot());
    largest = std::max(largest, impl_->condensation->largest_pivot());
  }
  return smallest / largest * (smallest / largest);
}

double Cholesky::factor_flops() const {
  if (impl_->kind == FactorKind::sparse) return impl_->common.fl;
  const double inner = impl_->kind == FactorKind::condensed ? impl_->condensation->flops() : 0;
  return impl_->kept.flops() + inner;
}

long Cholesky::factor_nonzeros() const {
  if (impl_->kind == FactorKind::sparse) return static_cast<long>(impl_->common.lnz);
  return impl_->kept.nonzeros() +
         (impl_->kind == FactorKind::condensed ? impl_->condensation->nonzeros() : 0);
}

}  // namespace calot
