#include "fem/solid_reduction.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "numerics/modes.h"

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

/// The points (rows) as blends of the kept nodes.
Matrix blends_of(const SolidMesh& mesh) {
  Matrix out = Matrix::Zero(static_cast<Eigen::Index>(mesh.averaged.size()), mesh.nodes);
  for (int p = 0; p < mesh.rows.rows(); ++p)
    for (int e = mesh.rows.begin[p]; e < mesh.rows.begin[p + 1]; ++e)
      out(p, mesh.rows.node[e]) = mesh.rows.value[e];
  return out;
}

/// The kept nodes as averages of the points (one column a point) by least squares.
Matrix averages(const SolidMesh& mesh) {
  Matrix blends = blends_of(mesh);
  for (std::size_t p = 0; p < mesh.averaged.size(); ++p)
    if (!mesh.averaged[p]) blends.row(static_cast<Eigen::Index>(p)).setZero();
  return Matrix(blends.transpose() * blends).llt().solve(blends.transpose());
}

Matrix by_components(const Matrix& scalar) {
  Matrix out = Matrix::Zero(3 * scalar.rows(), 3 * scalar.cols());
  for (Eigen::Index c = 0; c < scalar.cols(); ++c)
    for (Eigen::Index r = 0; r < scalar.rows(); ++r)
      out.block<3, 3>(3 * r, 3 * c).diagonal().setConstant(scalar(r, c));
  return out;
}

/// Rigid motions of the points to first order.
Matrix rigid_motions(const std::vector<Vec3>& points) {
  Matrix out(3 * static_cast<Eigen::Index>(points.size()), 6);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    out.block<3, 3>(3 * static_cast<Eigen::Index>(p), 0).setIdentity();
    out.block<3, 3>(3 * static_cast<Eigen::Index>(p), 3) = -cross_matrix(points[p] - middle);
  }
  return out;
}

/// What moves of the points, by forces on them, where the nodes that they are averaged to stay.
class HeldPoints {
 public:
  HeldPoints(const SolidMesh& mesh, const std::vector<TetMatrices>& tets, const std::vector<Vec3>& points)
      : average_(by_components(averages(mesh))) {
    const auto size = 3 * static_cast<Eigen::Index>(points.size());
    Matrix whole = Matrix::Zero(size, size);
    for (std::size_t t = 0; t < tets.size(); ++t)
      for (int a = 0; a < 10; ++a)
        for (int b = 0; b < 10; ++b)
          whole.block<3, 3>(3 * mesh.tets[t][a], 3 * mesh.tets[t][b]) +=
              tets[t].stiffness.block<3, 3>(3 * a, 3 * b);
    // Springs on what the nodes have of rigid motions: as these stay, they do nothing.
    const Matrix of_nodes = average_ * rigid_motions(points);
    Matrix felt = average_.transpose() * of_nodes;
    Matrix(of_nodes.transpose() * of_nodes).llt().matrixU().solveInPlace<Eigen::OnTheRight>(felt);
    whole += whole.diagonal().mean() / felt.squaredNorm() * 6 * felt * felt.transpose();
    factor_.compute(whole);
    by_nodes_ = factor_.solve(average_.transpose());
    Matrix soft = average_ * by_nodes_;
    held_.compute(0.5 * (soft + soft.transpose()));
  }
  Matrix answer(const Matrix& forces) const {
    Matrix out = factor_.solve(forces);
    out -= by_nodes_ * held_.solve(average_ * out);
    return out;
  }

 private:
  Matrix average_, by_nodes_;
  Eigen::LLT<Matrix> factor_, held_;
};

/// What a piece is before the points find their balance.
struct Blended {
  FramedSolid::Piece piece;
  Matrix forces;     ///< of its nodes' motions on the points, N/m
  Matrix stiffness;  ///< of its nodes
};

Blended blended(const SolidMesh& mesh, const std::vector<TetMatrices>& tets, const std::vector<int>& members,
                const ElasticSolid& solid) {
  std::vector<int> nodes;
  for (int t : members)
    for (int point : mesh.tets[t])
      nodes.insert(nodes.end(), mesh.rows.node.begin() + mesh.rows.begin[point],
                   mesh.rows.node.begin() + mesh.rows.begin[point + 1]);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto count = static_cast<Eigen::Index>(nodes.size());
  Blended out;
  out.forces = Matrix::Zero(3 * static_cast<Eigen::Index>(mesh.averaged.size()), 3 * count);
  out.stiffness = Matrix::Zero(3 * count, 3 * count);
  out.piece.slopes = Eigen::Matrix3Xd::Zero(3, count);
  double volume = 0;
  Eigen::Matrix<double, 10, Eigen::Dynamic> blends(10, count);
  for (int t : members) {
    blends.setZero();
    for (int a = 0; a < 10; ++a)
      for (int e = mesh.rows.begin[mesh.tets[t][a]]; e < mesh.rows.begin[mesh.tets[t][a] + 1]; ++e)
        blends(a, std::lower_bound(nodes.begin(), nodes.end(), mesh.rows.node[e]) - nodes.begin()) =
            mesh.rows.value[e];
    const Matrix moved = by_components(blends), forces = tets[t].stiffness * moved;
    out.stiffness.noalias() += moved.transpose() * forces;
    for (int a = 0; a < 10; ++a) out.forces.middleRows<3>(3 * mesh.tets[t][a]) += forces.middleRows<3>(3 * a);
    out.piece.slopes += tets[t].slopes * blends;
    volume += tets[t].volume;
  }
  out.piece.slopes /= volume;
  out.piece.nodes = std::move(nodes);
  out.piece.turning = frame_turning * solid.shear() * volume;
  return out;
}

/// M motions, of a density of 1.
Matrix carried(const SolidMesh& mesh, const std::vector<Vec3>& points, const Matrix& motions) {
  Matrix out = Matrix::Zero(motions.rows(), motions.cols());
  for (const QuadraticTet& tet : mesh.tets) {
    const Eigen::Matrix<double, 10, 10> products = tet_products(corners_of(tet, points));
    for (int a = 0; a < 10; ++a)
      for (int b = 0; b < 10; ++b)
        out.middleRows<3>(3 * tet[a]) += products(a, b) * motions.middleRows<3>(3 * tet[b]);
  }
  return out;
}

/// What the inside does beside nodes that are held, where the whole is accelerated as a rigid body: of these motions the
/// vibrations.
std::optional<Failure> find_modes(const SolidMesh& mesh, const std::vector<Vec3>& points,
                                  const HeldPoints& held, const Matrix& recovered, ReducedSolid& out) {
  const Matrix loads = carried(mesh, points, rigid_motions(points));
  Matrix shapes = held.answer(loads);
  const Matrix stiffness = shapes.transpose() * loads,
               inertia = shapes.transpose() * carried(mesh, points, shapes);
  const std::optional<Modes> found =
      modes(0.5 * (stiffness + stiffness.transpose()), 0.5 * (inertia + inertia.transpose()));
  if (!found)
    return fail(FailureKind::scenario, "the solid has no inside that moves", "cut it in more tetrahedra");
  shapes = (shapes * found->vectors).eval();
  for (int k = 0; k < inner_modes; ++k) {
    const double largest = shapes.col(k).cwiseAbs().maxCoeff();
    shapes.col(k) /= largest;
    out.mode_inertia[k] = 1 / (largest * largest);
    out.mode_stiffness[k] = found->values[k] * out.mode_inertia[k];
  }
  out.mode_coupling = recovered.transpose() * carried(mesh, points, shapes);
  return std::nullopt;
}

}  // namespace

Result<ReducedSolid> reduce(const SolidMesh& mesh, const VecX& rest, const ElasticSolid& solid) {
  const std::vector<Vec3> points = blend_all(mesh.rows, mesh.rows.value, rest);
  const Result<std::vector<TetMatrices>> tets = all_matrices(mesh.tets, points, solid);
  if (!tets) return tets.failure();
  std::vector<std::vector<int>> members;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto piece = static_cast<std::size_t>(mesh.piece_of[t]);
    if (members.size() <= piece) members.resize(piece + 1);
    members[piece].push_back(static_cast<int>(t));
  }
  const HeldPoints held(mesh, tets.value(), points);
  ReducedSolid out;
  std::vector<Blended> all;
  Matrix recovered = by_components(blends_of(mesh));
  for (const std::vector<int>& of : members) {
    all.push_back(blended(mesh, tets.value(), of, solid));
    out.parts.pieces.push_back(all.back().piece);
    const Matrix answer = held.answer(all.back().forces);
    const int here = static_cast<int>(all.size()) - 1;
    for (int before = 0; before <= here; ++before) {
      Matrix block = -all[static_cast<std::size_t>(before)].forces.transpose() * answer;
      if (before == here) {
        block += all.back().stiffness;
        block = (0.5 * (block + block.transpose())).eval();
      }
      out.parts.stiffness.push_back({before, here, std::move(block)});
    }
    for (std::size_t a = 0; a < all.back().piece.nodes.size(); ++a)
      recovered.middleCols<3>(3 * Eigen::Index{all.back().piece.nodes[a]}) -=
          answer.middleCols<3>(3 * static_cast<Eigen::Index>(a));
  }
  const Matrix mass = recovered.transpose() * carried(mesh, points, recovered);
  out.mass = 0.5 * (mass + mass.transpose());
  if (std::optional<Failure> failure = find_modes(mesh, points, held, recovered, out)) return *failure;
  return out;
}

}  // namespace calot
