#include "numerics/sharp_terms.h"

namespace calot {

Eigen::MatrixXd SharpHessian::over(std::span<const int> nodes) const {
  const auto size = 3 * static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  for (const Part& part : parts) {
    const BlockMatrix& matrix = part.matrix;
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      const int column = nodes[j] - part.first_node;
      if (column < 0 || column >= matrix.nodes()) continue;
      for (std::size_t i = j; i < nodes.size(); ++i) {
        const int row = nodes[i] - part.first_node;
        const int slot = row < matrix.nodes() ? matrix.slot(row, column) : -1;
        if (slot < 0) continue;
        const Eigen::Map<const Mat3, 0, Eigen::OuterStride<>> block(
            matrix.entries().data() + slot, Eigen::OuterStride<>(matrix.stride(column)));
        out.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j)) = block;
      }
    }
  }
  out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
  return out;
}

}  // namespace calot
