#include "skin/shared_rows.h"

#include <algorithm>

#include "base/index_of.h"

namespace calot {

SharedRows::SharedRows(const DetailedSurface& before, const DetailedSurface& now) : basis_(now.basis) {
  const int faces = static_cast<int>(now.tree.first.size()) - 1;
  for (int face = 0; face < faces; ++face) {
    const auto leaves = [face](const FaceTree& tree) {
      return std::span(tree.leaves).subspan(tree.first[face], tree.first[face + 1] - tree.first[face]);
    };
    const auto a = leaves(before.tree), b = leaves(now.tree);
    same_.push_back(before.basis.details_on(face) == now.basis.details_on(face) &&
                    std::equal(a.begin(), a.end(), b.begin(), b.end()));
  }
  const int coarse = now.basis.coarse_nodes();
  for (int column = 0; column < coarse; ++column) column_.push_back(column);
  for (int detail : before.basis.details()) {
    const int stays = index_of(detail, now.basis.details());
    column_.push_back(stays >= 0 ? coarse + stays : -1);
  }
}

void SharedRows::append(const StencilTable& from, int first, int last, StencilTable& to) const {
  const std::size_t begin = to.node.size();
  append_rows(from, first, last, to);
  for (std::size_t e = begin; e < to.node.size(); ++e) to.node[e] = column_[to.node[e]];
}

StencilTable SharedRows::rows(std::span<const FacePoint> points, int order, const StencilTable& table,
                              std::span<const int> known) const {
  std::vector<FacePoint> fresh_points;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (known[k] < 0) fresh_points.push_back(points[k]);
  const StencilTable fresh = basis_.evaluate(fresh_points, order);
  StencilTable out;
  reserve_as(table, 0.5, out);
  int used = 0;  // of the fresh ones
  for (std::size_t k = 0; k < points.size();) {
    // Rows that follow each other are copied at once.
    std::size_t end = k + 1;
    if (known[k] < 0) {
      while (end < points.size() && known[end] < 0) ++end;
      const int count = static_cast<int>(end - k);
      append_rows(fresh, used, used + count, out);
      used += count;
    } else {
      while (end < points.size() && known[end] == known[end - 1] + 1) ++end;
      append(table, known[k], known[k] + static_cast<int>(end - k), out);
    }
    k = end;
  }
  return out;
}

}  // namespace calot
