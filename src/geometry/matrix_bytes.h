#pragma once
// Matrices among the numbers that base/bytes.h writes and reads again.

#include "base/bytes.h"
#include "geometry/types.h"

namespace calot {

/// With the numbers of its rows and columns.
inline void add_matrix(const Eigen::MatrixXd& matrix, ByteWriter& out) {
  out.add(matrix.rows());
  out.add(matrix.cols());
  out.add(std::span<const double>(matrix.data(), static_cast<std::size_t>(matrix.size())));
}

/// What add_matrix() wrote; empty where its numbers do not fill it, and then the bytes are refused.
inline Eigen::MatrixXd matrix_of(ByteReader& in) {
  const auto rows = in.number<Eigen::Index>(), columns = in.number<Eigen::Index>();
  const std::vector<double> entries = in.numbers<double>();
  const auto size = static_cast<Eigen::Index>(entries.size());
  const bool filled = columns == 0 ? size == 0 : size % columns == 0 && rows == size / columns;
  if (rows < 0 || columns < 0 || !filled) {
    in.refuse();
    return {};
  }
  return Eigen::Map<const Eigen::MatrixXd>(entries.data(), rows, columns);
}

}  // namespace calot
