#include "numerics/block_matrix.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "geometry/finite.h"

namespace calot {

namespace {

/// Up to this many nodes (1.4 MB) a table says at once where a block is.
constexpr int table_nodes = 600;

}  // namespace

BlockMatrix::BlockMatrix(int nodes, std::span<const std::vector<int>> cliques) {
  std::vector<std::vector<int>> cliques_of(nodes);
  for (std::size_t k = 0; k < cliques.size(); ++k)
    for (int j : cliques[k]) cliques_of[j].push_back(static_cast<int>(k));
  std::vector<int> seen_by(nodes, -1), column;
  auto made = std::make_shared<Pattern>();
  made->block_start.push_back(0);
  for (int j = 0; j < nodes; ++j) {
    column.assign(1, j);
    for (int k : cliques_of[j])
      for (int i : cliques[k])
        if (i > j && std::exchange(seen_by[i], j) != j) column.push_back(i);
    std::sort(column.begin(), column.end());
    made->block_row.insert(made->block_row.end(), column.begin(), column.end());
    made->block_start.push_back(static_cast<int>(made->block_row.size()));
  }
  made->complete();
  values_.assign(made->rows.size(), 0.0);
  pattern_ = made;
}

void BlockMatrix::Pattern::complete() {
  const int nodes = static_cast<int>(block_start.size()) - 1;
  column_starts.push_back(0);
  for (int j = 0; j < nodes; ++j)
    for (int c = 0; c < 3; ++c) {
      for (int b = block_start[j]; b < block_start[j + 1]; ++b)
        for (int r = 0; r < 3; ++r) rows.push_back(3 * block_row[b] + r);
      column_starts.push_back(static_cast<int>(rows.size()));
    }
  if (nodes > table_nodes) return;
  slots.assign(static_cast<std::size_t>(nodes) * nodes, -1);
  for (int j = 0; j < nodes; ++j)
    for (int b = block_start[j]; b < block_start[j + 1]; ++b)
      slots[static_cast<std::size_t>(j) * nodes + block_row[b]] =
          column_starts[3 * j] + 3 * (b - block_start[j]);
}

std::optional<BlockMatrix> BlockMatrix::of_pattern(std::vector<int> block_starts,
                                                   std::vector<int> block_rows) {
  const int nodes = static_cast<int>(block_starts.size()) - 1, blocks = static_cast<int>(block_rows.size());
  if (nodes < 0 || block_starts.front() != 0 || block_starts.back() != blocks) return std::nullopt;
  for (int j = 0; j < nodes; ++j) {
    const int first = block_starts[j], end = block_starts[j + 1];
    if (first < 0 || first >= end || end > blocks || block_rows[first] != j || block_rows[end - 1] >= nodes)
      return std::nullopt;
    for (int b = first + 1; b < end; ++b)
      if (block_rows[b - 1] >= block_rows[b]) return std::nullopt;
  }
  Pattern made{std::move(block_starts), std::move(block_rows), {}, {}, {}};
  made.complete();
  return BlockMatrix(std::make_shared<const Pattern>(std::move(made))).blank();
}

void visit_members(MemberReader& read, BlockMatrix& matrix) {
  std::vector<int> starts, rows;
  read(starts, rows);
  if (std::optional<BlockMatrix> made = BlockMatrix::of_pattern(std::move(starts), std::move(rows)))
    matrix = std::move(*made);
  else
    read.refuse();
}

int BlockMatrix::search(int i, int j) const {
  const auto first = pattern_->block_row.begin() + pattern_->block_start[j];
  const auto last = pattern_->block_row.begin() + pattern_->block_start[j + 1];
  const auto found = std::lower_bound(first, last, i);
  if (found == last || *found != i) return -1;
  return pattern_->column_starts[3 * j] + 3 * static_cast<int>(found - first);
}

void BlockMatrix::slots(std::span<const int> nodes, int* out) const {
  const Pattern& pattern = *pattern_;
  const int j = nodes.front();
  if (!pattern.slots.empty()) {
    const int* column = pattern.slots.data() + static_cast<std::size_t>(j) * this->nodes();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if ((out[k] = column[nodes[k]]) < 0) std::abort();  // as in add()
    return;
  }
  int block = pattern.block_start[j];
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    while (pattern.block_row[block] != nodes[k])
      if (++block == pattern.block_start[j + 1]) std::abort();
    out[k] = pattern.column_starts[3 * j] + 3 * (block - pattern.block_start[j]);
  }
}

BlockMatrix BlockMatrix::pattern_only() const { return BlockMatrix(pattern_); }

BlockMatrix BlockMatrix::blank() const {
  BlockMatrix out(pattern_);
  out.values_.assign(pattern_->rows.size(), 0.0);
  return out;
}

void BlockMatrix::add_cliques(int first, std::vector<std::vector<int>>& cliques) const {
  for (int j = 0; j < nodes(); ++j)
    for (int k = pattern_->block_start[j]; k < pattern_->block_start[j + 1]; ++k)
      cliques.push_back({first + j, first + pattern_->block_row[k]});
}

std::vector<std::vector<int>> BlockMatrix::couplings() const {
  std::vector<std::vector<int>> out;
  add_cliques(0, out);
  return out;
}

BlockMatrix BlockMatrix::widened(std::span<const std::vector<int>> cliques) const {
  std::vector<std::vector<int>> all(cliques.begin(), cliques.end());
  add_cliques(0, all);
  BlockMatrix out(nodes(), all);
  out.assign(*this);
  return out;
}

BlockMatrix::BlockMatrix(std::span<const BlockMatrix> parts, std::span<const std::vector<int>> cliques) {
  std::vector<std::vector<int>> all(cliques.begin(), cliques.end());
  int nodes = 0;
  for (const BlockMatrix& part : parts) {
    part.add_cliques(nodes, all);
    nodes += part.nodes();
  }
  *this = BlockMatrix(nodes, all);
}

void BlockMatrix::assign(const BlockMatrix& part) {
  if (values_.size() == part.values_.size()) return assign(part.values_);
  set_zero();
  add_part(part, 0);
}

void BlockMatrix::add_part(const BlockMatrix& part, int first) {
  for (int j = 0; j < part.nodes(); ++j) {
    const int step = stride(first + j);
    int block = pattern_->block_start[first + j];
    for (int k = part.pattern_->block_start[j]; k < part.pattern_->block_start[j + 1]; ++k) {
      const int row = first + part.pattern_->block_row[k];
      while (pattern_->block_row[block] != row)
        if (++block == pattern_->block_start[first + j + 1]) std::abort();  // as in add()
      const int from = part.pattern_->column_starts[3 * j] + 3 * (k - part.pattern_->block_start[j]);
      const int to =
          pattern_->column_starts[3 * (first + j)] + 3 * (block - pattern_->block_start[first + j]);
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) values_[to + c * step + r] += part.values_[from + c * part.stride(j) + r];
    }
  }
}

void BlockMatrix::add(int i, int j, const Mat3& block) {
  const int at = slot(i, j);
  if (at < 0) std::abort();  // the pattern is built from the same stencils: a miss is a defect of ours
  const int step = stride(j);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) values_[at + c * step + r] += block(r, c);
}

void BlockMatrix::add(const std::vector<double>& values, double factor) {
  for (std::size_t k = 0; k < values_.size(); ++k) values_[k] += factor * values[k];
}

void BlockMatrix::scale(double factor) {
  for (double& value : values_) value *= factor;
}

void BlockMatrix::add_to_diagonal(double shift) {
  for (int j = 0; j < nodes(); ++j) add_to_diagonal(j, shift);
}

void BlockMatrix::add_to_diagonal(int node, double shift) {
  for (int c = 0; c < 3; ++c) values_[column_starts()[3 * node + c] + c] += shift;
}

void BlockMatrix::hold_all_but(const std::vector<char>& free) {
  const double mean = diagonal_mean();
  const auto is_free = [&](int unknown) { return free[unknown / 3] != 0; };
  for (int column = 0; column < size(); ++column) {
    for (int e = column_starts()[column]; e < column_starts()[column + 1]; ++e) {
      if (is_free(column) && is_free(rows()[e])) continue;
      values_[e] = rows()[e] == column ? mean : 0.0;
    }
  }
}

double BlockMatrix::diagonal_mean() const {
  double sum = 0;
  for (int k = 0; k < size(); ++k) sum += std::abs(diagonal(k));
  return sum / size();
}

bool BlockMatrix::all_finite() const { return calot::all_finite(values_); }

VecX BlockMatrix::multiply(const VecX& x) const {
  using Columns = Eigen::Map<const Mat3, 0, Eigen::OuterStride<>>;
  VecX y = VecX::Zero(size());
  for (int j = 0; j < nodes(); ++j) {
    const int step = stride(j);
    const double* block = values_.data() + column_starts()[3 * j];
    const Vec3 here = x.segment<3>(3 * j);
    const Mat3 diagonal = Columns(block, Eigen::OuterStride<>(step)).selfadjointView<Eigen::Lower>();
    Vec3 sum = y.segment<3>(3 * j) + diagonal * here;
    for (int b = pattern_->block_start[j] + 1; b < pattern_->block_start[j + 1]; ++b) {
      const Columns values(block += 3, Eigen::OuterStride<>(step));
      const int i = pattern_->block_row[b];
      y.segment<3>(3 * i) += values * here;
      sum += values.transpose() * x.segment<3>(3 * i);
    }
    y.segment<3>(3 * j) = sum;
  }
  return y;
}

}  // namespace calot
