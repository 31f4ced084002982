#include "numerics/cholesky.h"

#include <suitesparse/cholmod.h>

#include <Eigen/Cholesky>
#include <cstring>
#include <limits>

namespace calot {

struct Cholesky::Impl {
  bool dense = false;
  Eigen::MatrixXd full;
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

  FactorStatus factorise_dense(const BlockMatrix& matrix);
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

Cholesky::Cholesky(const BlockMatrix& pattern, bool dense) : impl_(std::make_unique<Impl>()) {
  impl_->dense = dense;
  if (dense) {
    // Eigen cuts its products by the caches it finds; fixed sizes make the order of sums the same everywhere.
    Eigen::setCpuCacheSizes(32 * 1024, 512 * 1024, 8 * 1024 * 1024);
    impl_->full = Eigen::MatrixXd::Zero(pattern.size(), pattern.size());
    return;
  }
  cholmod_sparse sparse = Impl::view(pattern);
  impl_->factor = cholmod_analyze(&sparse, &impl_->common);
}
Cholesky::Cholesky(Cholesky&&) noexcept = default;
Cholesky& Cholesky::operator=(Cholesky&&) noexcept = default;
Cholesky::~Cholesky() = default;

FactorStatus Cholesky::factorise(const BlockMatrix& matrix) {
  // Neither library minds a NaN (CHOLMOD 3.0.14 takes one on the diagonal for a success), so look before.
  if (!matrix.all_finite()) return FactorStatus::not_finite;
  return impl_->dense ? impl_->factorise_dense(matrix) : impl_->factorise_sparse(matrix);
}

FactorStatus Cholesky::Impl::factorise_dense(const BlockMatrix& matrix) {
  // Entries outside the pattern stay zero from the start.
  for (int column = 0; column < matrix.size(); ++column)
    for (int e = matrix.column_starts()[column]; e < matrix.column_starts()[column + 1]; ++e)
      full(matrix.rows()[e], column) = matrix.entries()[e];
  llt.compute(full);  // reads the lower triangle
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
  if (impl_->dense) return impl_->llt.solve(right);
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
  if (!impl_->dense) return cholmod_rcond(impl_->factor, &impl_->common);
  const auto diagonal = impl_->llt.matrixLLT().diagonal();
  const double ratio = diagonal.minCoeff() / diagonal.maxCoeff();
  return ratio * ratio;
}

double Cholesky::factor_flops() const {
  const double n = static_cast<double>(impl_->full.rows());
  return impl_->dense ? n * n * n / 3.0 : impl_->common.fl;
}

long Cholesky::factor_nonzeros() const {
  const long n = impl_->full.rows();
  return impl_->dense ? n * (n + 1) / 2 : static_cast<long>(impl_->common.lnz);
}

}  // namespace calot
