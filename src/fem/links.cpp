#include "fem/links.h"

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
                        const Eigen::Matrix<double, 12, 12>& hessian, BlockMatrix& matrix) {
  std::array<StencilPoint, 4> points;
  for (int k = 0; k < 4; ++k)
    if (rows[k] >= 0) points[k] = {&table, rows[k], 0};
  return add_points_hessian(points, hessian, matrix);
}

bool add_points_hessian(const std::array<StencilPoint, 4>& points,
                        const Eigen::Matrix<double, 12, 12>& hessian, BlockMatrix& matrix) {
  struct Node {
    int node;
    Eigen::Vector4d weight = Eigen::Vector4d::Zero();
  };
  std::vector<Node> nodes;
  for (int k = 0; k < 4; ++k) {
    if (points[k].table == nullptr) continue;
    const StencilTable& table = *points[k].table;
    for (int e = table.begin[points[k].row]; e < table.begin[points[k].row + 1]; ++e) {
      const int node = points[k].first_node + table.node[e];
      const auto at = std::lower_bound(nodes.begin(), nodes.end(), node,
                                       [](const Node& n, int other) { return n.node < other; });
      const auto place = at != nodes.end() && at->node == node ? at : nodes.insert(at, {node});
      place->weight[k] = table.value[e];
    }
  }
  bool complete = true;
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    Eigen::Matrix<double, 12, 3> column = Eigen::Matrix<double, 12, 3>::Zero();
    for (int k = 0; k < 4; ++k)
      if (nodes[j].weight[k] != 0) column += nodes[j].weight[k] * hessian.middleCols<3>(3 * k);
    for (std::size_t i = j; i < nodes.size(); ++i) {
      Mat3 block = Mat3::Zero();
      for (int k = 0; k < 4; ++k)
        if (nodes[i].weight[k] != 0) block += nodes[i].weight[k] * column.middleRows<3>(3 * k);
      if (matrix.slot(nodes[i].node, nodes[j].node) < 0)
        complete = false;
      else
        matrix.add(nodes[i].node, nodes[j].node, block);
    }
  }
  return complete;
}

}  // namespace calot
