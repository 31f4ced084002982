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

/// Takes the product of `under` with itself off the lower triangle of `rest`, a block of columns at a time.
template <class Under, class Rest>
void take_product_off(const Under& under, Rest rest, Workers* workers) {
  constexpr Eigen::Index columns = 2 * cholesky_block;  // narrower ones read the rows more often
  const auto chunks = static_cast<int>((rest.cols() + columns - 1) / columns);
  for_each_chunk(workers, chunks, [&](int chunk) {
    // Chunks are taken from the last on, which is the smallest: the longest columns shall come first.
    const Eigen::Index k = (chunks - 1 - chunk) * columns, size = std::min(columns, rest.cols() - k),
                       below = rest.cols() - k - size;
    const auto here = under.middleRows(k, size);
    rest.block(k, k, size, size).template selfadjointView<Eigen::Lower>().rankUpdate(here, -1);
    if (below > 0)
      rest.block(k + size, k, below, size).noalias() -= under.bottomRows(below) * here.transpose();
  });
}

/// Under a corner of a factor: what is there, times the inverse of its transpose.
template <class Corner, class Under>
void solve_under(const Corner& corner, Under under, Workers* workers) {
  constexpr Eigen::Index rows = 96;  // twice as many as the corner has: less is not worth to be shared
  const auto chunks = static_cast<int>((under.rows() + rows - 1) / rows);
  for_each_chunk(workers, chunks, [&](int chunk) {
    auto part = under.middleRows(chunk * rows, std::min(rows, under.rows() - chunk * rows));
    corner.matrixU().template solveInPlace<Eigen::OnTheRight>(part);
  });
}

}  // namespace

// Block by block. As Eigen::LLT, which copies the matrix and sums up its norm besides: a third of the time for 97 nodes.
bool cholesky_in_place(Eigen::MatrixXd& a, const std::vector<Eigen::Index>& ends, Workers* workers) {
  for (Eigen::Index first = 0; first < a.rows(); first += cholesky_block) {
    const auto [k, size, below] = Panel(a, ends, first);
    const Eigen::LLT<Eigen::MatrixXd> corner(a.block(k, k, size, size));
    if (corner.info() != Eigen::Success) return false;
    a.block(k, k, size, size).triangularView<Eigen::Lower>() = corner.matrixLLT();
    if (below == 0) continue;
    auto under = a.block(k + size, k, below, size);
    solve_under(corner, under, workers);
    take_product_off(under, a.block(k + size, k + size, below, below), workers);
  }
  return true;
}

namespace {

template <class Columns>
void solve_columns(const Eigen::MatrixXd& l, const std::vector<Eigen::Index>& ends, Columns& right) {
  for (Eigen::Index first = 0; first < l.rows(); first += cholesky_block) {
    const auto [k, size, below] = Panel(l, ends, first);
    auto here = right.middleRows(k, size);
    l.block(k, k, size, size).triangularView<Eigen::Lower>().solveInPlace(here);
    if (below > 0) right.middleRows(k + size, below).noalias() -= l.block(k + size, k, below, size) * here;
  }
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

}  // namespace calot
