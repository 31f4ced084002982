#pragma once
// Solids of tetrahedra: bent boxes with all points of their surface kept, and the same not condensed at all.

#include <algorithm>
#include <functional>

#include "fem/solid_reduction.h"

namespace calot::test {

/// Not condensed: each tetrahedron turns on its own. The points are its nodes.
struct WholeSolid {
  std::vector<FramedSolid> tets;

  WholeSolid(const std::vector<QuadraticTet>& of, const std::vector<Vec3>& points, const ElasticSolid& solid) {
    for (const QuadraticTet& tet : of) {
      std::array<Vec3, 10> at;
      for (int a = 0; a < 10; ++a) at[a] = points[tet[a]];
      const TetMatrices matrices = tet_matrices(at, solid).value();
      std::array<int, 10> order{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
      std::sort(order.begin(), order.end(), [&](int a, int b) { return tet[a] < tet[b]; });
      FramedSolid::Piece piece;
      Eigen::MatrixXd stiffness(30, 30);
      piece.slopes.resize(3, 10);
      for (int a = 0; a < 10; ++a) {
        piece.nodes.push_back(tet[order[a]]);
        piece.slopes.col(a) = matrices.slopes.col(order[a]) / matrices.volume;
        for (int b = 0; b < 10; ++b)
          stiffness.block<3, 3>(3 * a, 3 * b) = matrices.stiffness.block<3, 3>(3 * order[a], 3 * order[b]);
      }
      piece.turning = frame_turning * solid.shear() * matrices.volume;
      tets.emplace_back(to_coordinates(points), FramedSolid::Parts{{piece}, {{0, 0, stiffness}}});
    }
  }
  double value(const VecX& x) const {
    double sum = 0;
    for (const FramedSolid& tet : tets) sum += tet.value(x);
    return sum;
  }
  void add_gradient(const VecX& x, VecX& gradient) const {
    for (const FramedSolid& tet : tets) tet.add_gradient(x, gradient);
  }
  void add_hessian(const VecX& x, BlockMatrix& matrix) const {
    for (const FramedSolid& tet : tets) tet.add_hessian(x, matrix);
  }
  std::vector<std::vector<int>> cliques() const {
    std::vector<std::vector<int>> out;
    for (const FramedSolid& tet : tets) out.push_back(tet.parts().pieces[0].nodes);
    return out;
  }
};

/// The linear stiffness of all tetrahedra over their points, N/m.
inline Eigen::MatrixXd whole_stiffness(const std::vector<QuadraticTet>& tets, const std::vector<Vec3>& points,
                                       const ElasticSolid& solid) {
  const auto size = 3 * static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  for (const QuadraticTet& tet : tets) {
    std::array<Vec3, 10> at;
    for (int a = 0; a < 10; ++a) at[a] = points[tet[a]];
    const TetMatrices matrices = tet_matrices(at, solid).value();
    for (int a = 0; a < 10; ++a)
      for (int b = 0; b < 10; ++b)
        out.block<3, 3>(3 * tet[a], 3 * tet[b]) += matrices.stiffness.block<3, 3>(3 * a, 3 * b);
  }
  return out;
}

struct BentBox {
  TetGrid grid;
  std::vector<Vec3> points;  ///< of the grid, m
  std::vector<int> kept;     ///< grid points, the nodes in their order
  SolidMesh mesh;
  VecX rest;  ///< of the nodes
};

/// `place` takes [0, 1]^3; `pieces` strips along the second way.
inline BentBox bent_box(const std::array<int, 3>& cells, int pieces,
                        const std::function<Vec3(const Vec3&)>& place) {
  BentBox out;
  out.grid.cells = cells;
  std::vector<std::vector<std::pair<int, double>>> of_surface(out.grid.points());
  std::vector<Vec3> at;
  for (int p = 0; p < out.grid.points(); ++p) {
    if (!out.grid.on_surface(p)) continue;
    of_surface[p] = {{static_cast<int>(out.kept.size()), 1.0}};
    out.kept.push_back(p);
    const std::array<int, 3> k = out.grid.place(p);
    at.push_back(place({k[0] / (2.0 * cells[0]), k[1] / (2.0 * cells[1]), k[2] / (2.0 * cells[2])}));
  }
  out.rest = to_coordinates(at);
  out.mesh.tets = out.grid.tets();
  out.mesh.rows = fill_by_surface(out.grid, of_surface);
  out.mesh.nodes = static_cast<int>(out.kept.size());
  out.points = blend_all(out.mesh.rows, out.mesh.rows.value, out.rest);
  for (int p = 0; p < out.grid.points(); ++p) out.mesh.averaged.push_back(out.grid.on_surface(p));
  for (int t = 0; t < static_cast<int>(out.mesh.tets.size()); ++t)
    out.mesh.piece_of.push_back(out.grid.cell_of(t)[1] * pieces / cells[1]);
  return out;
}

/// A lobe's section: thick at its back, thin at its edge, bent a little.
inline Vec3 wedge(const Vec3& s) {
  const double thick = 30e-3 - 20e-3 * s.y();
  return {60e-3 * (s.x() - 0.5), 70e-3 * s.y() * (1 - 0.1 * s.x()),
          thick * (s.z() - 0.3) + 8e-3 * s.y() * s.y()};
}

}  // namespace calot::test
