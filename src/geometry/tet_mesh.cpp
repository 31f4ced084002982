#include "geometry/tet_mesh.h"

#include <algorithm>
#include <map>

namespace calot {

bool TetGrid::on_surface(int point) const {
  const std::array<int, 3> at = place(point), n = points_along();
  for (int way = 0; way < 3; ++way)
    if (at[way] == 0 || at[way] == n[way] - 1) return true;
  return false;
}

std::vector<QuadraticTet> TetGrid::tets() const {
  constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  std::vector<QuadraticTet> out;
  std::array<int, 3> cell{};
  for (cell[2] = 0; cell[2] < cells[2]; ++cell[2])
    for (cell[1] = 0; cell[1] < cells[1]; ++cell[1])
      for (cell[0] = 0; cell[0] < cells[0]; ++cell[0]) {
        std::array<int, 3> ways{0, 1, 2};  // from the least corner to the greatest, one way after the other
        do {
          std::array<std::array<int, 3>, 4> corners;
          for (int way = 0; way < 3; ++way) corners[0][way] = 2 * cell[way];
          for (int k = 0; k < 3; ++k) {
            corners[k + 1] = corners[k];
            corners[k + 1][ways[k]] += 2;
          }
          // Even orders of the ways are right-handed.
          const int inversions = (ways[0] > ways[1]) + (ways[0] > ways[2]) + (ways[1] > ways[2]);
          if (inversions % 2 == 1) std::swap(corners[1], corners[2]);
          QuadraticTet tet;
          for (int k = 0; k < 4; ++k) tet[k] = point(corners[k]);
          for (int e = 0; e < 6; ++e) {
            std::array<int, 3> middle;
            for (int way = 0; way < 3; ++way)
              middle[way] = (corners[edges[e][0]][way] + corners[edges[e][1]][way]) / 2;
            tet[4 + e] = point(middle);
          }
          out.push_back(tet);
        } while (std::next_permutation(ways.begin(), ways.end()));
      }
  return out;
}

StencilTable fill_by_surface(const TetGrid& grid,
                             const std::vector<std::vector<std::pair<int, double>>>& of_surface) {
  const std::array<int, 3> n = grid.points_along();
  StencilTable table;
  for (int point = 0; point < grid.points(); ++point) {
    std::map<int, double> row;
    const auto add = [&](int of, double share) {
      for (const auto& [node, weight] : of_surface[of]) row[node] += share * weight;
    };
    if (grid.on_surface(point)) {
      add(point, 1);
    } else {
      std::array<int, 3> foot = grid.place(point);
      const double along = static_cast<double>(foot[2]) / (n[2] - 1);
      for (int end : {0, 1}) {
        foot[2] = end * (n[2] - 1);
        add(grid.point(foot), end == 0 ? 1 - along : along);
      }
    }
    for (const auto& [node, weight] : row) {
      if (weight == 0) continue;
      table.node.push_back(node);
      table.value.push_back(weight);
    }
    table.begin.push_back(static_cast<int>(table.node.size()));
  }
  return table;
}

}  // namespace calot
