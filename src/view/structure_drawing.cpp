#include "view/structure_drawing.h"

#include <map>
#include <utility>

namespace calot {
namespace {

/// Ends and level of each edge of the leaves, once. An edge that a split neighbour halves is drawn by its halves.
std::map<std::pair<int, int>, std::pair<FacePoint, FacePoint>> edges_of(const SurfaceLevels& levels,
                                                                        const FaceTree& tree) {
  std::map<std::pair<int, int>, std::pair<FacePoint, FacePoint>> out;
  constexpr double u[3] = {0, 1, 0}, v[3] = {0, 0, 1};
  for (const FaceTree::Leaf& leaf : tree.leaves) {
    const Triangle& corners = levels.faces(leaf.level)[leaf.face];
    for (int k = 0; k < 3; ++k) {
      if (leaf.hanging[k]) continue;
      const int l = (k + 1) % 3;
      out.try_emplace(std::minmax(corners[k], corners[l]),
                      levels.on_coarse(leaf.level, {leaf.face, u[k], v[k]}),
                      levels.on_coarse(leaf.level, {leaf.face, u[l], v[l]}));
    }
  }
  return out;
}

}  // namespace

StructureDrawing draw_structure(const ShellBody& body, const VecX& x) {
  constexpr int parts = 8;  // of an edge
  const SurfaceLevels& levels = body.levels();
  std::vector<FacePoint> at;
  StructureDrawing out;
  for (const auto& [ends, places] : edges_of(levels, FaceTree(levels, body.details()))) {
    out.lines.push_back({{}, {}, levels.level_of(std::max(ends.first, ends.second))});
    const auto& [a, b] = places;
    for (int k = 0; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      at.push_back({a.face, a.u + share * (b.u - a.u), a.v + share * (b.v - a.v)});
    }
  }
  for (int node = 0; node < body.coarse_nodes(); ++node) at.push_back(levels.place(node));
  for (int detail : body.details()) at.push_back(levels.place(detail));
  const StencilTable table = body.basis().evaluate(at, 1);
  int row = 0;
  for (StructureDrawing::Line& line : out.lines) {
    for (int k = 0; k <= parts; ++k, ++row) {
      line.points.push_back(blend(table, table.value, row, x));
      line.normals.push_back(
          blend(table, table.du, row, x).cross(blend(table, table.dv, row, x)).normalized());
    }
  }
  for (int node = 0; node < body.coarse_nodes(); ++node)
    out.coarse_nodes.push_back(blend(table, table.value, row++, x));
  for (std::size_t i = 0; i < body.details().size(); ++i)
    out.details.push_back(blend(table, table.value, row++, x));
  return out;
}

}  // namespace calot
