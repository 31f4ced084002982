#pragma once
// Rows of some nodes, three each, of columns that have them of all nodes.

#include <span>

#include "geometry/types.h"

namespace calot {

template <class Columns>
void pick(const Columns& from, std::span<const int> nodes, Columns& out) {
  out.resize(3 * static_cast<Eigen::Index>(nodes.size()), from.cols());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    out.template middleRows<3>(3 * static_cast<Eigen::Index>(i)) =
        from.template middleRows<3>(3 * Eigen::Index{nodes[i]});
}
template <class Columns>
Columns picked(const Columns& from, std::span<const int> nodes) {
  Columns out;
  pick(from, nodes, out);
  return out;
}
/// Writes them back.
template <class Columns>
void put(const Columns& from, std::span<const int> nodes, Columns& out) {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    out.template middleRows<3>(3 * Eigen::Index{nodes[i]}) =
        from.template middleRows<3>(3 * static_cast<Eigen::Index>(i));
}

}  // namespace calot
