#include "numerics/cholesky.h"

#include <suitesparse/cholmod.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "numerics/condense.h"

namespace calot {

struct Cholesky::Impl {
  FactorKind kind = FactorKind::dense;
  Eigen::MatrixXd full;
  std::optional<Condensation> condensation;
  Eigen::LLT<Eigen::MatrixXd> llt;
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
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }

  long dense_rows() const { return condensation ? condensation->condensed().rows() : full.rows(); }
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
    : impl_(std::make_unique<Impl>()) {
  impl_->kind = kind;
  // Eigen cuts its products by the caches it finds; fixed sizes make the order of sums the same everywhere.
  Eigen::setCpuCacheSizes(32 * 1024, 512 * 1024, 8 * 1024 * 1024);
  if (kind == FactorKind::condensed) {
    impl_->condensation.emplace(pattern, coarse);
  } else if (kind == FactorKind::dense) {
    impl_->full = Eigen::MatrixXd::Zero(pattern.size(), pattern.size());
  } else {
    cholmod_sparse sparse = Impl::view(pattern);
    impl_->factor = cholmod_analyze(&sparse, &impl_->common);
  }
}
Cholesky::Cholesky(Cholesky&&) noexcept = default;
Cholesky& Cholesky::operator=(Cholesky&&) noexcept = default;
Cholesky::~Cholesky() = default;

FactorStatus Cholesky::factorise(const BlockMatrix& matrix) {
  // Neither library minds a NaN (CHOLMOD 3.0.14 takes one on the diagonal for a success), so look before.
  if (!matrix.all_finite()) return FactorStatus::not_finite;
  if (impl_->kind == FactorKind::sparse) return impl_->factorise_sparse(matrix);
  return impl_->kind == FactorKind::dense ? impl_->factorise_dense(matrix)
                                          : impl_->factorise_condensed(matrix);
}

FactorStatus Cholesky::Impl::factorise_dense(const BlockMatrix& matrix) {
  // Entries outside the pattern stay zero from the start.
  for (int column = 0; column < matrix.size(); ++column)
    for (int e = matrix.column_starts()[column]; e < matrix.column_starts()[column + 1]; ++e)
      full(matrix.rows()[e], column) = matrix.entries()[e];
  llt.compute(full);  // reads the lower triangle
  return llt.info() == Eigen::Success ? FactorStatus::ok : FactorStatus::not_positive_definite;
}

FactorStatus Cholesky::Impl::factorise_condensed(const BlockMatrix& matrix) {
  const FactorStatus status = condensation->eliminate(matrix);
  if (status != FactorStatus::ok) return status;
  llt.compute(condensation->condensed());
  return llt.info() == Eigen::Success ? FactorStatus::ok : FactorStatus::not_positive_definite;
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
  if (impl_->kind == FactorKind::dense) return impl_->llt.solve(right);
  if (impl_->kind == FactorKind::condensed)
    return impl_->condensation->expand(right, impl_->llt.solve(impl_->condensation->reduce(right)));
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
  const auto diagonal = impl_->llt.matrixLLT().diagonal();
  double smallest = diagonal.minCoeff(), largest = diagonal.maxCoeff();
  if (impl_->kind == FactorKind::condensed && impl_->condensation->groups() > 0) {
    smallest = std::min(smallest, impl_->condensation->smallest_pivot());
    largest = std::max(largest, impl_->condensation->largest_pivot());
  }
  return smallest / largest * (smallest / largest);
}

double Cholesky::factor_flops() const {
  if (impl_->kind == FactorKind::sparse) return impl_->common.fl;
  const double n = static_cast<double>(impl_->dense_rows());
  const double inner = impl_->kind == FactorKind::condensed ? impl_->condensation->flops() : 0;
  return n * n * n / 3.0 + inner;
}

long Cholesky::factor_nonzeros() const {
  if (impl_->kind == FactorKind::sparse) return static_cast<long>(impl_->common.lnz);
  const long n = impl_->dense_rows();
  return n * (n + 1) / 2 + (impl_->kind == FactorKind::condensed ? impl_->condensation->nonzeros() : 0);
}

}  // namespace calot
