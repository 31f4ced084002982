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

}  // namespace calot
