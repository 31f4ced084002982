#include "fem/solid_reduction.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace calot {
namespace {

using Matrix = Eigen::MatrixXd;

std::array<Vec3, 10> corners_of(const QuadraticTet& tet, const std::vector<Vec3>& points) {
  std::array<Vec3, 10> out;
  for (int a = 0; a < 10; ++a) out[a] = points[tet[a]];
  return out;
}

Result<std::vector<TetMatrices>> all_matrices(const std::vector<QuadraticTet>& tets,
                                              const std::vector<Vec3>& points, const ElasticSolid& solid) {
  std::vector<TetMatrices> out;
  for (const QuadraticTet& tet : tets) {
    const std::optional<TetMatrices> found = tet_matrices(corners_of(tet, points), solid);
    if (!found)
      return fail(FailureKind::scenario, "the solid's shape folds over itself",
                  "make it thicker at its edge, or its bed shallower");
    out.push_back(*found);
  }
  return out;
}

/// Where each point of the mesh goes with the kept nodes, 3 rows a point.
Matrix recovery(const SolidMesh& mesh, const std::vector<TetMatrices>& tets) {
  const auto points = static_cast<Eigen::Index>(mesh.free.size());
  Matrix out = Matrix::Zero(3 * points, 3 * Eigen::Index{mesh.nodes});
  std::vector<Eigen::Index> number(mesh.free.size(), -1);
  Eigen::Index free = 0;
  for (Eigen::Index p = 0; p < points; ++p) {
    if (mesh.free[static_cast<std::size_t>(p)]) {
      number[static_cast<std::size_t>(p)] = free++;
      continue;
    }
    const int row = static_cast<int>(p);
    for (int e = mesh.rows.begin[row]; e < mesh.rows.begin[row + 1]; ++e)
      out.block<3, 3>(3 * p, 3 * Eigen::Index{mesh.rows.node[e]}) = mesh.rows.value[e] * Mat3::Identity();
  }
  if (free == 0) return out;
  Matrix inner = Matrix::Zero(3 * free, 3 * free), right = Matrix::Zero(3 * free, out.cols());
  for (std::size_t t = 0; t < tets.size(); ++t)
    for (int a = 0; a < 10; ++a) {
      const Eigen::Index row = number[mesh.tets[t][a]];
      if (row < 0) continue;
      for (int b = 0; b < 10; ++b) {
        const int other = mesh.tets[t][b];
        const Mat3 block = tets[t].stiffness.block<3, 3>(3 * a, 3 * b);
        if (number[other] >= 0)
          inner.block<3, 3>(3 * row, 3 * number[other]) += block;
        else
          right.middleRows<3>(3 * row).noalias() -= block * out.middleRows<3>(3 * Eigen::Index{other});
      }
    }
  const Eigen::LLT<Eigen::Ref<Matrix>> factor(inner);
  factor.solveInPlace(right);
  for (Eigen::Index p = 0; p < points; ++p)
    if (const Eigen::Index row = number[static_cast<std::size_t>(p)]; row >= 0)
      out.middleRows<3>(3 * p) = right.middleRows<3>(3 * row);
  return out;
}

/// Kept nodes on which the points of some tetrahedra depend.
std::vector<int> nodes_of(const Matrix& columns) {
  std::vector<int> out;
  for (Eigen::Index node = 0; 3 * node < columns.cols(); ++node)
    if (!columns.middleCols<3>(3 * node).isZero(0)) out.push_back(static_cast<int>(node));
  return out;
}

FramedSolid::Piece piece_of(const SolidMesh& mesh, const std::vector<TetMatrices>& tets,
                            const Matrix& recovered, const std::vector<int>& members,
                            const ElasticSolid& solid) {
  std::vector<int> points;
  for (int t : members) points.insert(points.end(), mesh.tets[t].begin(), mesh.tets[t].end());
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const auto place = [&](int point) {
    return std::lower_bound(points.begin(), points.end(), point) - points.begin();
  };
  const auto count = static_cast<Eigen::Index>(points.size());
  Matrix moved(3 * count, recovered.cols()), forces = Matrix::Zero(3 * count, recovered.cols());
  for (Eigen::Index p = 0; p < count; ++p)
    moved.middleRows<3>(3 * p) =
        recovered.middleRows<3>(3 * Eigen::Index{points[static_cast<std::size_t>(p)]});
  double volume = 0;
  Eigen::Matrix3Xd of_points = Eigen::Matrix3Xd::Zero(3, count);
  Matrix own(30, recovered.cols());
  for (int t : members) {
    for (int a = 0; a < 10; ++a) own.middleRows<3>(3 * a) = moved.middleRows<3>(3 * place(mesh.tets[t][a]));
    const Matrix pulled = tets[t].stiffness * own;
    for (int a = 0; a < 10; ++a) {
      const Eigen::Index p = place(mesh.tets[t][a]);
      forces.middleRows<3>(3 * p) += pulled.middleRows<3>(3 * a);
      of_points.col(p) += tets[t].slopes.col(a);
    }
    volume += tets[t].volume;
  }
  Matrix whole(recovered.cols(), recovered.cols());
  whole.noalias() = moved.transpose() * forces;
  Eigen::Matrix3Xd slopes = Eigen::Matrix3Xd::Zero(3, mesh.nodes);
  for (Eigen::Index p = 0; p < count; ++p) {
    const int row = points[static_cast<std::size_t>(p)];
    for (int e = mesh.rows.begin[row]; e < mesh.rows.begin[row + 1]; ++e)
      slopes.col(mesh.rows.node[e]) += mesh.rows.value[e] / volume * of_points.col(p);
  }
  FramedSolid::Piece out;
  out.nodes = nodes_of(moved);
  const auto nodes = static_cast<Eigen::Index>(out.nodes.size());
  out.stiffness.resize(3 * nodes, 3 * nodes);
  out.slopes.resize(3, nodes);
  for (Eigen::Index b = 0; b < nodes; ++b) {
    const Eigen::Index to_b = 3 * Eigen::Index{out.nodes[static_cast<std::size_t>(b)]};
    out.slopes.col(b) = slopes.col(to_b / 3);
    for (Eigen::Index a = 0; a < nodes; ++a) {
      const Eigen::Index to_a = 3 * Eigen::Index{out.nodes[static_cast<std::size_t>(a)]};
      out.stiffness.block<3, 3>(3 * a, 3 * b) =
          0.5 * (whole.block<3, 3>(to_a, to_b) + whole.block<3, 3>(to_b, to_a).transpose());
    }
  }
  out.turning = frame_turning * solid.shear() * volume;
  return out;
}

}  // namespace

Result<std::vector<FramedSolid::Piece>> reduce(const SolidMesh& mesh, const VecX& rest,
                                               const ElasticSolid& solid) {
  const Result<std::vector<TetMatrices>> tets =
      all_matrices(mesh.tets, blend_all(mesh.rows, mesh.rows.value, rest), solid);
  if (!tets) return tets.failure();
  const Matrix recovered = recovery(mesh, tets.value());
  std::vector<std::vector<int>> members;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto piece = static_cast<std::size_t>(mesh.piece_of[t]);
    if (members.size() <= piece) members.resize(piece + 1);
    members[piece].push_back(static_cast<int>(t));
  }
  std::vector<FramedSolid::Piece> out;
  for (const std::vector<int>& of : members)
    out.push_back(piece_of(mesh, tets.value(), recovered, of, solid));
  return out;
}

}  // namespace calot
