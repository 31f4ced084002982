#include "fem/links.h"

#include <algorithm>
#include <limits>

namespace calot {

double Links::value(const StencilTable& table, const VecX& x) const {
  double sum = 0;
  for (std::size_t i = 0; i < row.size(); ++i)
    sum += 0.5 * stiffness[i] * (blend(table, table.value, row[i], x) - target[i]).squaredNorm();
  return sum;
}

void Links::add_gradient(const StencilTable& table, const VecX& x, VecX& gradient) const {
  for (std::size_t i = 0; i < row.size(); ++i)
    spread(table, row[i], stiffness[i] * (blend(table, table.value, row[i], x) - target[i]), gradient);
}

void Links::add_hessian(const StencilTable& table, BlockMatrix& matrix) const {
  for (std::size_t i = 0; i < row.size(); ++i)
    add_point_hessian(table, row[i], stiffness[i] * Mat3::Identity(), matrix);
}

void add_point_hessian(const StencilTable& table, int r, const Mat3& h, BlockMatrix& matrix) {
  for (int b = table.begin[r]; b < table.begin[r + 1]; ++b)
    for (int a = b; a < table.begin[r + 1]; ++a)
      matrix.add(table.node[a], table.node[b], table.value[a] * table.value[b] * h);
}

bool add_points_hessian(const StencilTable& table, const std::array<int, 4>& rows,
                        const Eigen::Matrix<double, 12, 12>& hessian, BlockMatrix& matrix,
                        const ColumnShare& share) {
  return add_points_hessian(points_of(table, rows), hessian, matrix, share);
}

std::array<StencilPoint, 4> points_of(const StencilTable& table, const std::array<int, 4>& rows) {
  std::array<StencilPoint, 4> points;
  for (std::size_t k = 0; k < 4; ++k)
    if (rows[k] >= 0) points[k] = {&table, rows[k], 0};
  return points;
}

namespace {

/// A node and its weights at four points: how it moves them.
struct WeighedNode {
  int node;
  std::array<double, 4> weight;
};

/// Of all points, in increasing order: of each list one after another, as each increases.
std::vector<WeighedNode> nodes_of(const std::array<StencilPoint, 4>& points) {
  std::array<int, 4> at{}, end{};
  for (std::size_t k = 0; k < 4; ++k)
    if (points[k].table != nullptr)
      at[k] = points[k].table->begin[points[k].row], end[k] = points[k].table->begin[points[k].row + 1];
  std::vector<WeighedNode> out;
  for (;;) {
    int next = std::numeric_limits<int>::max();
    for (std::size_t k = 0; k < 4; ++k)
      if (at[k] < end[k]) next = std::min(next, points[k].first_node + points[k].table->node[at[k]]);
    if (next == std::numeric_limits<int>::max()) return out;
    WeighedNode& added = out.emplace_back(WeighedNode{next, {}});
    for (std::size_t k = 0; k < 4; ++k)
      if (at[k] < end[k] && points[k].first_node + points[k].table->node[at[k]] == next)
        added.weight[k] = points[k].table->value[at[k]++];
  }
}

}  // namespace

bool add_points_hessian(const std::array<StencilPoint, 4>& points,
                        const Eigen::Matrix<double, 12, 12>& hessian, BlockMatrix& matrix,
                        const ColumnShare& share) {
  const std::vector<WeighedNode> nodes = nodes_of(points);
  bool complete = true;
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    if (!share.has(nodes[j].node)) continue;
    Mat3 column[4];  // of the points' blocks by this node
    for (int k = 0; k < 4; ++k) {
      column[k].setZero();
      if (points[k].table == nullptr) continue;
      for (int l = 0; l < 4; ++l)
        if (nodes[j].weight[l] != 0) column[k] += nodes[j].weight[l] * hessian.block<3, 3>(3 * k, 3 * l);
    }
    const int step = matrix.stride(nodes[j].node);
    for (std::size_t i = j; i < nodes.size(); ++i) {
      const int slot = matrix.slot(nodes[i].node, nodes[j].node);
      if (slot < 0) {
        complete = false;
        continue;
      }
      Mat3 block = Mat3::Zero();
      for (int k = 0; k < 4; ++k)
        if (nodes[i].weight[k] != 0) block += nodes[i].weight[k] * column[k];
      Eigen::Map<Mat3, 0, Eigen::OuterStride<>>(matrix.values() + slot, Eigen::OuterStride<>(step)) += block;
    }
  }
  return complete;
}

bool add_all(std::span<const PointsStiffness> all, Workers* workers, BlockMatrix& matrix) {
  return add_in_columns(workers, all.size(), [&](std::size_t k, const ColumnShare& share) {
    return add_points_hessian(all[k].points, all[k].matrix, matrix, share);
  });
}

}  // namespace calot
