#include "fem/element_layout.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "fem/lanes.h"

namespace calot {

void FaceNodes::add_row(const StencilTable& table, int r) {
  const auto first = table.node.begin() + table.begin[r], last = table.node.begin() + table.begin[r + 1];
  if (!std::includes(nodes.begin(), nodes.end(), first, last)) {
    std::vector<int> all;
    all.reserve(nodes.size() + static_cast<std::size_t>(last - first));
    std::set_union(nodes.begin(), nodes.end(), first, last, std::back_inserter(all));
    nodes = std::move(all);
  }
  padded = (count() + lane_count - 1) / lane_count * lane_count;
}

std::vector<FaceNodes> gather_faces(const StencilTable& table, const std::vector<int>& face_of_row,
                                    int faces) {
  std::vector<FaceNodes> out(faces);
  for (int r = 0; r < table.rows(); ++r) out[face_of_row[r]].add_row(table, r);
  return out;
}

void dense_weights(const StencilTable& table, const std::vector<double>& weights, int r,
                   const FaceNodes& face, double* out) {
  std::fill(out, out + face.padded, 0.0);
  std::size_t place = 0;  // both lists increase
  for (int e = table.begin[r]; e < table.begin[r + 1]; ++e) {
    while (face.nodes[place] != table.node[e]) ++place;
    out[place] = weights[e];
  }
}

void ElementMatrix::reset(int padded) {
  padded_ = padded;
  values_.assign(6 * static_cast<std::size_t>(padded) * padded, 0.0);
}

std::size_t ElementMatrix::reserve(int padded) {
  const std::size_t entries = 6 * static_cast<std::size_t>(padded) * padded;
  values_.reserve(entries);
  return sizeof(double) * entries;
}

namespace {

/// Rows b .. b + 3 and `Wide` lanes from column a of K += W' Q: as many sums as the processor has registers for.
template <int Wide>
void add_tile(int rows, int padded, const double* weights, const double* products, int b, int a, double* k) {
  Lanes sum[lane_count][Wide] = {};
  for (int r = 0; r < rows; ++r) {
    const double* w = weights + r * padded + b;
    const double* q = products + r * padded + a;
    Lanes column[Wide];
    for (int j = 0; j < Wide; ++j) column[j] = load_lanes(q + lane_count * j);
    for (int i = 0; i < lane_count; ++i)
      for (int j = 0; j < Wide; ++j) sum[i][j] = fused(all_lanes(w[i]), column[j], sum[i][j]);
  }
  for (int i = 0; i < lane_count; ++i) {
    for (int j = 0; j < Wide; ++j) {
      double* at = k + (b + i) * padded + a + lane_count * j;
      store_lanes(load_lanes(at) + sum[i][j], at);
    }
  }
}

}  // namespace

void ElementMatrix::add(int pair, int rows, const double* weights, const double* products) {
  constexpr int wide = 2;
  const bool half = component_pairs[pair][0] == component_pairs[pair][1];
  double* k = values_.data() + static_cast<std::size_t>(pair) * padded_ * padded_;
  for (int b = 0; b < padded_; b += lane_count) {
    int a = half ? b : 0;
    for (; a + wide * lane_count <= padded_; a += wide * lane_count)
      add_tile<wide>(rows, padded_, weights, products, b, a, k);
    if (a < padded_) add_tile<1>(rows, padded_, weights, products, b, a, k);
  }
}

void ElementMatrix::scatter(const FaceNodes& face, BlockMatrix& matrix, int first, int last) const {
  const int n = padded_;
  const int count = face.count();
  const double* pairs[6];
  for (int p = 0; p < 6; ++p) pairs[p] = values_.data() + static_cast<std::size_t>(p) * n * n;
  int slots[max_face_nodes];
  const auto begin = std::lower_bound(face.nodes.begin(), face.nodes.end(), first) - face.nodes.begin();
  for (int b = static_cast<int>(begin); b < count && face.nodes[b] < last; ++b) {
    const int j = face.nodes[b];
    const int step = matrix.stride(j);
    matrix.slots(std::span(face.nodes).subspan(b), slots + b);
    for (int a = b; a < count; ++a) {
      // Column c holds entries (component r of node a, component c of node b); pairs r > c are the transposes of
      // those that are kept.
      const int here = b * n + a, turned = a * n + b;
      double* column = matrix.values() + slots[a];
      column[0] += pairs[0][here];
      column[1] += pairs[1][here];
      column[2] += pairs[2][here];
      column += step;
      column[0] += pairs[1][turned];
      column[1] += pairs[3][here];
      column[2] += pairs[4][here];
      column += step;
      column[0] += pairs[2][turned];
      column[1] += pairs[4][turned];
      column[2] += pairs[5][here];
    }
  }
}

}  // namespace calot
