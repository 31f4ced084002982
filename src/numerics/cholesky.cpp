#include "numerics/cholesky.h"

#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "numerics/condense.h"
#include "numerics/envelope.h"
#include "numerics/node_rows.h"

namespace calot {
namespace {

constexpr double sparse_slowness = 10;  ///< time of an operation against a dense one's

}  // namespace

std::vector<char> first_kept(int nodes, int count) {
  std::vector<char> out(static_cast<std::size_t>(nodes), 0);
  std::fill_n(out.begin(), std::min(nodes, count), 1);
  return out;
}

struct Cholesky::Impl {
  FactorKind kind = FactorKind::dense;
  std::vector<char> given_kept;
  std::vector<double> factorised;
  std::optional<Condensation> condensation;  ///< of nothing where the whole is dense; none where it is sparse
  EnvelopeFactor kept;                       ///< of what the matrix is condensed to
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
    given_kept = like.given_kept;
    if (like.condensation) condensation = like.condensation->blank();
    kept = like.kept.blank();
    if (like.factor != nullptr) factor = cholmod_copy_factor(like.factor, &common);
    common.fl = like.common.fl;
    common.lnz = like.common.lnz;
  }
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }

  FactorStatus factorise_dense(const BlockMatrix& matrix, Workers* workers);
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

Cholesky::Cholesky(const BlockMatrix& pattern, std::span<const char> kept) {
  const auto condensed = std::count(kept.begin(), kept.end(), 0);
  const bool has_room = pattern.nodes() - condensed <= dense_nodes;
  if (has_room) *this = Cholesky(pattern, kept, FactorKind::condensed);
  if (has_room && factor_flops() < dense_flops) return;
  const Cholesky sparse(pattern, kept, FactorKind::sparse);
  const bool is_made = sparse.impl_->factor != nullptr;
  if (!has_room || (is_made && sparse_slowness * sparse.factor_flops() < factor_flops())) *this = sparse;
}

Cholesky::Cholesky(const BlockMatrix& pattern, std::span<const char> kept, FactorKind kind)
    : impl_(std::make_shared<Impl>()) {
  impl_->given_kept.assign(kept.begin(), kept.end());
  if (kind == FactorKind::sparse) {
    impl_->kind = kind;
    cholmod_sparse sparse = Impl::view(pattern);
    impl_->factor = cholmod_analyze(&sparse, &impl_->common);
    return;
  }
  const std::vector<char> all(static_cast<std::size_t>(pattern.nodes()), 1);
  if (kept.empty() || kind == FactorKind::dense) kept = all;
  const bool keeps_all = std::find(kept.begin(), kept.end(), 0) == kept.end();
  impl_->kind = keeps_all ? FactorKind::dense : FactorKind::condensed;
  impl_->condensation.emplace(pattern, kept);
  impl_->kept = EnvelopeFactor(impl_->condensation->kept_couplings());
}

FactorKind Cholesky::kind() const { return impl_->kind; }
const std::vector<char>& Cholesky::kept() const { return impl_->given_kept; }
const std::vector<double>& Cholesky::factorised() const { return impl_->factorised; }

FactorStatus Cholesky::factorise(const BlockMatrix& matrix, Workers* workers) {
  // Neither library minds a NaN (CHOLMOD 3.0.14 takes one on the diagonal for a success), so look before.
  if (!matrix.all_finite()) return FactorStatus::not_finite;
  if (impl_.use_count() > 1) impl_ = std::make_shared<Impl>(*impl_);
  impl_->factorised = matrix.entries();
  if (impl_->kind == FactorKind::sparse) return impl_->factorise_sparse(matrix);
  return impl_->factorise_dense(matrix, workers);
}

FactorStatus Cholesky::Impl::factorise_dense(const BlockMatrix& matrix, Workers* workers) {
  const FactorStatus status = condensation->eliminate(matrix, kept, workers);
  if (status != FactorStatus::ok) return status;
  return kept.factorise(workers) ? FactorStatus::ok : FactorStatus::not_positive_definite;
}

FactorStatus Cholesky::Impl::factorise_sparse(const BlockMatrix& matrix) {
  if (factor == nullptr) return FactorStatus::out_of_memory;
  cholmod_sparse sparse = view(matrix);
  cholmod_factorize(&sparse, factor, &common);
  if (common.status == CHOLMOD_NOT_POSDEF || factor->minor < factor->n)
    return FactorStatus::not_positive_definite;
  return common.status == CHOLMOD_OK ? FactorStatus::ok : FactorStatus::out_of_memory;
}

VecX Cholesky::solve(const VecX& right) const { return solve_columns(right); }
Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& right, Workers* workers) const {
  if (!impl_->condensation) return solve_columns(right);  // CHOLMOD's workspaces serve one thread
  // Chunks of less columns read the factor more often, of more could not be shared. Eigen's kernels take four at a time.
  constexpr Eigen::Index least = 4, most = 16;
  const Eigen::Index half = (right.cols() + 1) / 2, together = std::clamp((half + 3) / 4 * 4, least, most);
  const auto chunks = static_cast<int>((right.cols() + together - 1) / together);
  Eigen::MatrixXd out(right.rows(), right.cols());
  for_each_chunk(workers, chunks, [&](int chunk) {
    const Eigen::Index first = chunk * together, count = std::min(together, right.cols() - first);
    out.middleCols(first, count) = solve_columns<Eigen::MatrixXd>(right.middleCols(first, count));
  });
  return out;
}

Eigen::MatrixXd Cholesky::compliance(std::span<const int> nodes, Workers* workers) const {
  const auto columns = 3 * static_cast<Eigen::Index>(nodes.size());
  if (impl_->condensation) {
    // K^-1 = L'^-1 L^-1: half of a solve.
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(columns, columns);
    const Eigen::MatrixXd passed = impl_->condensation->reduce_units(nodes, out);
    const Eigen::MatrixXd half = impl_->kept.solve_lower(passed, workers);
    out.selfadjointView<Eigen::Lower>().rankUpdate(half.transpose());
    return out.selfadjointView<Eigen::Lower>();
  }
  Eigen::MatrixXd units = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(impl_->factor->n), columns);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    units.block<3, 3>(3 * Eigen::Index{nodes[i]}, 3 * static_cast<Eigen::Index>(i)).setIdentity();
  const Eigen::MatrixXd out = picked(solve_columns(units), nodes);
  return 0.5 * (out + out.transpose());
}

template <class Columns>
Columns Cholesky::solve_columns(const Columns& right) const {
  if (impl_->condensation)
    return impl_->condensation->expand(right, impl_->kept.solve(impl_->condensation->reduce(right)));
  cholmod_dense b{};
  b.nrow = b.d = static_cast<std::size_t>(right.rows());
  b.ncol = static_cast<std::size_t>(right.cols());
  b.nzmax = b.nrow * b.ncol;
  b.x = const_cast<double*>(right.data());
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, impl_->factor, &b, nullptr, &impl_->solution, nullptr, &impl_->work_y,
                 &impl_->work_e, &impl_->common);
  Columns x = Columns::Constant(right.rows(), right.cols(),
                                std::numeric_limits<double>::quiet_NaN());  // out of memory: not finite
  if (impl_->solution == nullptr || impl_->common.status < CHOLMOD_OK) return x;
  std::memcpy(x.data(), impl_->solution->x, sizeof(double) * static_cast<std::size_t>(x.size()));
  return x;
}

double Cholesky::reciprocal_condition() const {
  if (!impl_->condensation) return cholmod_rcond(impl_->factor, &impl_->common);
  const double smallest = std::min(impl_->kept.smallest_pivot(), impl_->condensation->smallest_pivot()),
               largest = std::max(impl_->kept.largest_pivot(), impl_->condensation->largest_pivot());
  return smallest / largest * (smallest / largest);
}

double Cholesky::factor_flops() const {
  if (!impl_->condensation) return impl_->common.fl;
  return impl_->kept.flops() + impl_->condensation->flops();
}

long Cholesky::factor_nonzeros() const {
  if (!impl_->condensation) return static_cast<long>(impl_->common.lnz);
  return impl_->kept.nonzeros() + impl_->condensation->nonzeros();
}

}  // namespace calot
