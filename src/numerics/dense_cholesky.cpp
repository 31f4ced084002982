#include "numerics/dense_cholesky.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace calot {
namespace {

/// Eigen cuts its products by the caches it finds; fixed sizes make the order of sums the same everywhere. Set before
/// main, so that no product comes before it.
[[maybe_unused]] const bool caches_are_fixed = [] {
  Eigen::setCpuCacheSizes(32 * 1024, 512 * 1024, 8 * 1024 * 1024);
  return true;
}();

/// Columns k .. k + size - 1, and the `below` rows under their corner that count.
struct Panel {
  Eigen::Index k, size, below;

  Panel(const Eigen::MatrixXd& l, const std::vector<Eigen::Index>& ends, Eigen::Index first)
      : k(first), size(std::min(cholesky_block, l.rows() - first)) {
    const Eigen::Index end = ends.empty() ? l.rows() : ends[static_cast<std::size_t>(first / cholesky_block)];
    below = std::max<Eigen::Index>(0, end - k - size);
  }
};

/// The factor of a panel's corner, and what is under it times the inverse of its transpose. False when the corner is not
/// positive definite.
bool finish(Eigen::MatrixXd& a, const Panel& panel) {
  const auto [k, size, below] = panel;
  auto corner = a.block(k, k, size, size);
  const Eigen::LLT<Eigen::MatrixXd> factor(corner);
  if (factor.info() != Eigen::Success) return false;
  corner.triangularView<Eigen::Lower>() = factor.matrixLLT();
  if (below == 0) return true;
  auto under = a.block(k + size, k, below, size);
  factor.matrixU().solveInPlace<Eigen::OnTheRight>(under);
  return true;
}

/// Takes the product of a finished panel with itself off `size` later columns from `first` on.
void take_product_off(Eigen::MatrixXd& a, const Panel& panel, Eigen::Index first, Eigen::Index size) {
  const auto left = a.middleCols(panel.k, panel.size);
  const auto here = left.middleRows(first, size);
  const Eigen::Index next = first + size, below = panel.k + panel.size + panel.below - next;
  a.block(first, first, size, size).selfadjointView<Eigen::Lower>().rankUpdate(here, -1);
  if (below > 0)
    a.block(next, first, below, size).noalias() -= left.middleRows(next, below) * here.transpose();
}

}  // namespace

// Panel by panel. As Eigen::LLT, which copies the matrix and sums up its norm besides: a third of the time for 97 nodes.
bool cholesky_in_place(Eigen::MatrixXd& a, const std::vector<Eigen::Index>& ends, Workers* workers) {
  if (a.rows() == 0) return true;
  bool definite = finish(a, Panel(a, ends, 0));
  for (Eigen::Index first = 0; definite && first + cholesky_block < a.rows(); first += cholesky_block) {
    const Panel panel(a, ends, first);
    const Eigen::Index next = panel.k + panel.size, end = next + panel.below;
    // The chunk that takes the product off the next panel finishes that panel as well, while others take it off those
    // after. It takes longest, so it is the last chunk: workers begin with that.
    const auto chunks = std::max(1, static_cast<int>((panel.below + cholesky_block - 1) / cholesky_block));
    for_each_chunk(workers, chunks, [&](int chunk) {
      const Eigen::Index column = next + (chunks - 1 - chunk) * cholesky_block;
      if (column < end) take_product_off(a, panel, column, std::min(cholesky_block, end - column));
      if (column == next) definite = finish(a, Panel(a, ends, next));
    });
  }
  return definite;
}

namespace {

template <class Columns>
void solve_lower(const Eigen::MatrixXd& l, const std::vector<Eigen::Index>& ends, Eigen::Index from,
                 Columns& right) {
  for (Eigen::Index first = from; first < l.rows(); first += cholesky_block) {
    const auto [k, size, below] = Panel(l, ends, first);
    auto here = right.middleRows(k, size);
    l.block(k, k, size, size).template triangularView<Eigen::Lower>().solveInPlace(here);
    if (below > 0) right.middleRows(k + size, below).noalias() -= l.block(k + size, k, below, size) * here;
  }
}

template <class Columns>
void solve_columns(const Eigen::MatrixXd& l, const std::vector<Eigen::Index>& ends, Columns& right) {
  solve_lower(l, ends, 0, right);
  for (Eigen::Index first = (l.rows() - 1) / cholesky_block * cholesky_block; first >= 0;
       first -= cholesky_block) {
    const auto [k, size, below] = Panel(l, ends, first);
    auto here = right.middleRows(k, size);
    if (below > 0)
      here.noalias() -= l.block(k + size, k, below, size).transpose() * right.middleRows(k + size, below);
    l.block(k, k, size, size).triangularView<Eigen::Lower>().transpose().solveInPlace(here);
  }
}

}  // namespace

VecX cholesky_solve(const Eigen::MatrixXd& l, VecX right, const std::vector<Eigen::Index>& ends) {
  solve_columns(l, ends, right);
  return right;
}

Eigen::MatrixXd cholesky_solve(const Eigen::MatrixXd& l, Eigen::MatrixXd right,
                               const std::vector<Eigen::Index>& ends) {
  solve_columns(l, ends, right);
  return right;
}

Eigen::MatrixXd cholesky_solve_lower(const Eigen::MatrixXd& l, Eigen::MatrixXd right,
                                     const std::vector<Eigen::Index>& ends) {
  Eigen::Index from = 0;
  while (from < right.rows() && right.row(from).isZero(0)) ++from;
  solve_lower(l, ends, from / cholesky_block * cholesky_block, right);
  return right;
}

}  // namespace calot
