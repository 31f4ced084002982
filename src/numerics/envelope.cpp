#include "numerics/envelope.h"

#include <algorithm>

#include "numerics/dense_cholesky.h"

namespace calot {
namespace {

using Graph = std::vector<std::vector<int>>;

/// Nodes of one component by their distance from `first`; nearer to nodes of few neighbours first.
std::vector<int> breadth_first(const Graph& graph, int first, std::vector<int>& seen, int mark) {
  std::vector<int> order{first};
  seen[first] = mark;
  for (std::size_t k = 0; k < order.size(); ++k) {
    std::vector<int> next;
    for (int node : graph[order[k]])
      if (seen[node] != mark) {
        seen[node] = mark;
        next.push_back(node);
      }
    std::sort(next.begin(), next.end(), [&](int a, int b) {
      return graph[a].size() != graph[b].size() ? graph[a].size() < graph[b].size() : a < b;
    });
    order.insert(order.end(), next.begin(), next.end());
  }
  return order;
}

}  // namespace

std::vector<int> close_order(const Graph& neighbours) {
  constexpr int looks = 4;  // from one end to the other and back: then it hardly gets longer
  const int nodes = static_cast<int>(neighbours.size());
  std::vector<int> seen(neighbours.size(), -1), out;
  std::vector<char> placed(neighbours.size(), 0);
  int mark = 0;
  for (int node = 0; node < nodes; ++node) {
    if (placed[node]) continue;
    std::vector<int> order = breadth_first(neighbours, node, seen, mark++);
    for (int look = 0; look < looks; ++look) order = breadth_first(neighbours, order.back(), seen, mark++);
    for (int each : order) placed[each] = 1;
    out.insert(out.end(), order.begin(), order.end());
  }
  std::reverse(out.begin(), out.end());
  return out;
}

EnvelopeFactor::EnvelopeFactor(const Graph& neighbours) {
  const std::vector<int> order = close_order(neighbours);
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    place[order[k]] = static_cast<int>(k);
    for (int c = 0; c < 3; ++c) unknown_.push_back(3 * order[k] + c);
  }
  place_.resize(unknown_.size());
  for (std::size_t k = 0; k < unknown_.size(); ++k) place_[unknown_[k]] = static_cast<int>(k);
  const auto size = static_cast<Eigen::Index>(unknown_.size());
  l_.resize(size, size);  // what lies outside the envelope is never touched and takes no memory
  Eigen::Index end = 0;
  for (Eigen::Index first = 0; first < size; first += cholesky_block) {
    for (Eigen::Index column = first; column < std::min(first + cholesky_block, size); ++column) {
      end = std::max(end, column + 1);
      for (int node : neighbours[order[static_cast<std::size_t>(column / 3)]])
        end = std::max(end, Eigen::Index{3} * (place[node] + 1));
    }
    ends_.push_back(end);
  }
}

EnvelopeFactor EnvelopeFactor::blank() const {
  EnvelopeFactor out;
  out.l_.resize(l_.rows(), l_.cols());
  out.unknown_ = unknown_;
  out.place_ = place_;
  out.ends_ = ends_;
  return out;
}

void EnvelopeFactor::clear(Workers* workers) {
  constexpr int chunks = 8;
  for_each_chunk(workers, chunks, [&](int k) {
    const Chunk columns = chunk_of(static_cast<int>(size()), chunks, k);
    for (Eigen::Index column = columns.begin; column < columns.end; ++column)
      l_.col(column).segment(column, end_of(column) - column).setZero();
  });
}

void EnvelopeFactor::set(int i, int j, const double* block, int stride) {
  const Eigen::Index row = place_[3 * i], column = place_[3 * j];
  const Eigen::Map<const Mat3, 0, Eigen::OuterStride<>> values(block, Eigen::OuterStride<>(stride));
  if (row >= column)
    l_.block<3, 3>(row, column) = values;
  else
    l_.block<3, 3>(column, row) = values.transpose();
}

void EnvelopeFactor::subtract(std::span<const int> nodes, const double* product, int k, int shares) {
  const auto stride = 3 * static_cast<Eigen::Index>(nodes.size());
  for (std::size_t b = 0; b < nodes.size(); ++b)
    for (std::size_t a = b; a < nodes.size(); ++a) {
      const int first = std::min(place_[3 * nodes[a]], place_[3 * nodes[b]]);
      if (first / 3 % shares != k) continue;
      const Eigen::Map<const Mat3, 0, Eigen::OuterStride<>> values(
          product + 3 * static_cast<Eigen::Index>(a) + 3 * static_cast<Eigen::Index>(b) * stride,
          Eigen::OuterStride<>(stride));
      const Eigen::Index row = place_[3 * nodes[a]], column = place_[3 * nodes[b]];
      if (row >= column)
        l_.block<3, 3>(row, column) -= values;
      else
        l_.block<3, 3>(column, row) -= values.transpose();
    }
}

bool EnvelopeFactor::factorise(Workers* workers) { return cholesky_in_place(l_, ends_, workers); }

template <class Columns>
Columns EnvelopeFactor::solve_columns(const Columns& right) const {
  return cholesky_solve(l_, Columns(right(unknown_, Eigen::all)), ends_)(place_, Eigen::all);
}

VecX EnvelopeFactor::solve(const VecX& right) const { return solve_columns(right); }
Eigen::MatrixXd EnvelopeFactor::solve(const Eigen::MatrixXd& right) const { return solve_columns(right); }

Eigen::MatrixXd EnvelopeFactor::solve_lower(const Eigen::MatrixXd& right, Workers* workers) const {
  // Eigen's kernels take four columns at a time; who has more of them together reads the factor less often.
  constexpr Eigen::Index together = 24;
  Eigen::MatrixXd out(right.rows(), right.cols());
  const auto chunks = static_cast<int>((right.cols() + together - 1) / together);
  for_each_chunk(workers, chunks, [&](int chunk) {
    const Eigen::Index first = chunk * together, count = std::min(together, right.cols() - first);
    out.middleCols(first, count) =
        cholesky_solve_lower(l_, right(unknown_, Eigen::seqN(first, count)), ends_);
  });
  return out;
}

double EnvelopeFactor::flops() const {
  double sum = 0;
  for (Eigen::Index column = 0; column < size(); ++column) {
    const double below = static_cast<double>(end_of(column) - column);
    sum += below * below;
  }
  return sum;
}

long EnvelopeFactor::nonzeros() const {
  long sum = 0;
  for (Eigen::Index column = 0; column < size(); ++column) sum += end_of(column) - column;
  return sum;
}

}  // namespace calot
