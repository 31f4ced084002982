#include "sim/contact_points.h"

#include <map>
#include <utility>

namespace calot {
namespace {

/// Adds a row that blends skin points a and b by halves; nodes increase within a row.
void append_middle(const StencilTable& skin, int a, int b, StencilTable& out) {
  int i = skin.begin[a], j = skin.begin[b];
  const int i_end = skin.begin[a + 1], j_end = skin.begin[b + 1];
  while (i < i_end || j < j_end) {
    const int node = j == j_end || (i < i_end && skin.node[i] <= skin.node[j]) ? skin.node[i] : skin.node[j];
    double weight = 0;
    if (i < i_end && skin.node[i] == node) weight += 0.5 * skin.value[i++];
    if (j < j_end && skin.node[j] == node) weight += 0.5 * skin.value[j++];
    out.node.push_back(node);
    out.value.push_back(weight);
  }
  out.begin.push_back(static_cast<int>(out.node.size()));
}

void append_point(const ContactPoints& points, const StencilTable& skin, int row, StencilTable& out) {
  const int middle = row - skin.rows();
  if (middle >= 0) {
    append_middle(skin, points.middles[middle][0], points.middles[middle][1], out);
    return;
  }
  out.node.insert(out.node.end(), skin.node.begin() + skin.begin[row],
                  skin.node.begin() + skin.begin[row + 1]);
  out.value.insert(out.value.end(), skin.value.begin() + skin.begin[row],
                   skin.value.begin() + skin.begin[row + 1]);
  out.begin.push_back(static_cast<int>(out.node.size()));
}

}  // namespace

ContactPoints contact_points(const Tessellation& skin, int faces, const std::vector<Vec3>& rest) {
  ContactPoints out;
  const int drawn = static_cast<int>(rest.size());
  for (const FacePoint& at : skin.at) out.face.push_back(at.face);
  out.areas.assign(rest.size(), 0.0);
  const std::size_t per_face = skin.triangles.size() / static_cast<std::size_t>(faces);
  std::map<std::pair<int, int>, int> middles;
  for (std::size_t k = 0; k < skin.triangles.size(); ++k) {
    const Triangle& t = skin.triangles[k];
    const double quarter = 0.125 * (rest[t[1]] - rest[t[0]]).cross(rest[t[2]] - rest[t[0]]).norm();
    for (int c = 0; c < 3; ++c) {
      const int a = std::min(t[c], t[(c + 1) % 3]), b = std::max(t[c], t[(c + 1) % 3]);
      const auto [found, is_new] = middles.try_emplace({a, b}, static_cast<int>(out.middles.size()));
      if (is_new) {
        out.middles.push_back({a, b});
        out.face.push_back(static_cast<int>(k / per_face));
        out.areas.push_back(0);
      }
      // Of the four equal triangles that the middles split it into three meet at a middle, one at a corner.
      out.areas[t[c]] += quarter / 3;
      out.areas[drawn + found->second] += quarter;
    }
  }
  return out;
}

StencilTable contact_stencils(const ContactPoints& points, const StencilTable& skin) {
  StencilTable out;
  const std::size_t entries = skin.node.size() * points.face.size() / static_cast<std::size_t>(skin.rows());
  out.node.reserve(entries);
  out.value.reserve(entries);
  for (int row = 0; row < static_cast<int>(points.face.size()); ++row) append_point(points, skin, row, out);
  return out;
}

StencilTable contact_stencils(const ContactPoints& points, const StencilTable& skin,
                              const StencilTable& before, const std::function<bool(int face)>& reached) {
  StencilTable out;
  reserve_as(before, 0.25, out);
  int copied = 0;  // rows; those that nothing reaches are copied many at a time
  for (int row = 0; row < before.rows(); ++row) {
    if (!reached(points.face[row])) continue;
    append_rows(before, copied, row, out);
    append_point(points, skin, row, out);
    copied = row + 1;
  }
  append_rows(before, copied, before.rows(), out);
  return out;
}

}  // namespace calot
