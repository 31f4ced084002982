#include "numerics/block_matrix.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace calot {

BlockMatrix::BlockMatrix(int nodes, std::span<const std::vector<int>> cliques) {
  std::vector<std::vector<int>> cliques_of(nodes);
  for (std::size_t k = 0; k < cliques.size(); ++k)
    for (int j : cliques[k]) cliques_of[j].push_back(static_cast<int>(k));
  std::vector<int> seen_by(nodes, -1), column;
  block_start_.push_back(0);
  column_starts_.push_back(0);
  for (int j = 0; j < nodes; ++j) {
    column.assign(1, j);
    for (int k : cliques_of[j])
      for (int i : cliques[k])
        if (i > j && std::exchange(seen_by[i], j) != j) column.push_back(i);
    std::sort(column.begin(), column.end());
    block_row_.insert(block_row_.end(), column.begin(), column.end());
    block_start_.push_back(static_cast<int>(block_row_.size()));
    for (int c = 0; c < 3; ++c) {
      for (int i : column)
        for (int r = 0; r < 3; ++r) rows_.push_back(3 * i + r);
      column_starts_.push_back(static_cast<int>(rows_.size()));
    }
  }
  values_.assign(rows_.size(), 0.0);
}

int BlockMatrix::slot(int i, int j) const {
  const auto first = block_row_.begin() + block_start_[j];
  const auto last = block_row_.begin() + block_start_[j + 1];
  const auto found = std::lower_bound(first, last, i);
  if (found == last || *found != i) return -1;
  return column_starts_[3 * j] + 3 * static_cast<int>(found - first);
}

void BlockMatrix::slots(std::span<const int> nodes, int* out) const {
  const int j = nodes.front();
  int block = block_start_[j];
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    while (block_row_[block] != nodes[k])
      if (++block == block_start_[j + 1]) std::abort();  // as in add()
    out[k] = column_starts_[3 * j] + 3 * (block - block_start_[j]);
  }
}

void BlockMatrix::add(int i, int j, const Mat3& block) {
  const int at = slot(i, j);
  if (at < 0) std::abort();  // the pattern is built from the same stencils: a miss is a defect of ours
  const int step = stride(j);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) values_[at + c * step + r] += block(r, c);
}

void BlockMatrix::add_to_diagonal(double shift) {
  for (int j = 0; j < nodes(); ++j)
    for (int c = 0; c < 3; ++c) values_[column_starts_[3 * j + c] + c] += shift;
}

void BlockMatrix::hold_all_but(int first, int last) {
  const double mean = diagonal_mean();
  const auto is_free = [&](int unknown) { return unknown >= 3 * first && unknown < 3 * last; };
  for (int column = 0; column < size(); ++column) {
    for (int e = column_starts_[column]; e < column_starts_[column + 1]; ++e) {
      if (is_free(column) && is_free(rows_[e])) continue;
      values_[e] = rows_[e] == column ? mean : 0.0;
    }
  }
}

double BlockMatrix::diagonal_mean() const {
  double sum = 0;
  for (int j = 0; j < nodes(); ++j)
    for (int c = 0; c < 3; ++c) sum += std::abs(values_[column_starts_[3 * j + c] + c]);
  return sum / size();
}

bool BlockMatrix::all_finite() const {
  return std::all_of(values_.begin(), values_.end(), [](double v) { return std::isfinite(v); });
}

VecX BlockMatrix::multiply(const VecX& x) const {
  VecX y = VecX::Zero(size());
  for (int column = 0; column < size(); ++column) {
    for (int e = column_starts_[column]; e < column_starts_[column + 1]; ++e) {
      const int row = rows_[e];
      if (row < column) continue;  // upper entries of a diagonal block
      y[row] += values_[e] * x[column];
      if (row > column) y[column] += values_[e] * x[row];
    }
  }
  return y;
}

}  // namespace calot
