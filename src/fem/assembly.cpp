#include "fem/assembly.h"

#include <algorithm>

namespace calot {

std::size_t Assembly::make_room(std::span<const FaceNodes> elements) {
  constexpr std::size_t cache = 1 << 20;  // bytes
  std::size_t count = 0, bytes = 0;
  while (count < elements.size() && bytes < cache) {
    if (count == matrices_.size()) matrices_.emplace_back();
    bytes += matrices_[count].reserve(elements[count].padded);
    ++count;
  }
  return count;
}

void Assembly::scatter(std::span<const FaceNodes> elements, BlockMatrix& matrix) {
  constexpr int chunks = 8;
  // Columns with as many entries to each chunk.
  const std::vector<int>& starts = matrix.column_starts();
  const auto first_column = [&](int chunk) {
    const auto entries = static_cast<int>(std::int64_t{starts.back()} * chunk / chunks);
    return static_cast<int>((std::lower_bound(starts.begin(), starts.end(), entries) - starts.begin() + 2) /
                            3);
  };
  workers_.for_each(chunks, [&](int k) {
    const int first = first_column(k), last = first_column(k + 1);
    for (std::size_t i = 0; i < elements.size(); ++i) matrices_[i].scatter(elements[i], matrix, first, last);
  });
}

}  // namespace calot
