#include "fem/element_layout.h"

#include <algorithm>

namespace calot {

void FaceNodes::finish() {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const int count = static_cast<int>(nodes.size());
  padded = count;
  for (int size : {4, 8, 12, 16, 20, 24, 32, 40, 64, max_face_nodes}) {
    if (count > size) continue;
    padded = size;
    break;
  }
}

std::vector<FaceNodes> gather_faces(const StencilTable& table, const std::vector<int>& face_of_row,
                                    int faces) {
  std::vector<FaceNodes> out(faces);
  for (int r = 0; r < table.rows(); ++r) {
    std::vector<int>& nodes = out[face_of_row[r]].nodes;
    nodes.insert(nodes.end(), table.node.begin() + table.begin[r], table.node.begin() + table.begin[r + 1]);
  }
  for (FaceNodes& face : out) face.finish();
  return out;
}

void dense_weights(const StencilTable& table, const std::vector<double>& weights, int r,
                   const FaceNodes& face, double* out) {
  std::fill(out, out + face.padded, 0.0);
  for (int e = table.begin[r]; e < table.begin[r + 1]; ++e) {
    const auto found = std::lower_bound(face.nodes.begin(), face.nodes.end(), table.node[e]);
    out[found - face.nodes.begin()] = weights[e];
  }
}

void ElementMatrix::reset(int padded) {
  padded_ = padded;
  values_.assign(6 * padded * padded, 0.0);
}

void ElementMatrix::scatter(const FaceNodes& face, BlockMatrix& matrix) const {
  static constexpr int pair_of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  const int n = padded_;
  const int count = static_cast<int>(face.nodes.size());
  int slots[max_face_nodes];
  for (int b = 0; b < count; ++b) {
    const int j = face.nodes[b];
    const int step = matrix.stride(j);
    matrix.slots(std::span(face.nodes).subspan(b), slots + b);
    for (int a = b; a < count; ++a) {
      const int at = slots[a];
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          // Entry (component r of node a, component c of node b); pairs below the diagonal are transposes.
          const double* k = values_.data() + pair_of[r][c] * n * n;
          matrix.values()[at + c * step + r] += r <= c ? k[a * n + b] : k[b * n + a];
        }
      }
    }
  }
}

}  // namespace calot
