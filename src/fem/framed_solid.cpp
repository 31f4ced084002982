#include "fem/framed_solid.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <limits>

namespace calot {
namespace {

Eigen::Matrix3Xd columns_of(const std::vector<int>& nodes, const VecX& x) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t a = 0; a < nodes.size(); ++a)
    out.col(static_cast<Eigen::Index>(a)) = x.segment<3>(Eigen::Index{3} * nodes[a]);
  return out.colwise() - Vec3(out.rowwise().mean());
}

Eigen::Map<const VecX> flat(const Eigen::Matrix3Xd& columns) { return {columns.data(), columns.size()}; }

/// Of m with a determinant above 0.
Mat3 polar_rotation(const Mat3& m) {
  const Eigen::JacobiSVD<Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

/// How w changes with a turn of the frame; `mean`: the mean deformation gradient in the frame.
Mat3 change_of_left(const Mat3& mean) { return 0.5 * (mean - mean.trace() * Mat3::Identity()); }

/// Second derivative of the energy by a turn of the frame but for the stiffness, which adds what is of the second order
/// in the strain.
Mat3 turning_hessian(double turning, const Mat3& mean, const Mat3& forces_by_places) {
  const Mat3 left = change_of_left(mean);
  return turning * left.transpose() * left + 0.5 * (forces_by_places + forces_by_places.transpose()) -
         forces_by_places.trace() * Mat3::Identity();
}

}  // namespace

FramedSolid::FramedSolid(const VecX& rest, std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  for (const Piece& piece : pieces_) rest_.push_back({columns_of(piece.nodes, rest)});
}

FramedSolid::Seen FramedSolid::see(std::size_t index, const VecX& x) const {
  constexpr int most_rounds = 40;
  constexpr double turned = 1e-12;  // rad
  const Piece& piece = pieces_[index];
  const Eigen::Matrix3Xd places = columns_of(piece.nodes, x);
  const Mat3 mean = places * piece.slopes.transpose();
  Seen out;
  out.energy = std::numeric_limits<double>::infinity();
  if (!(mean.determinant() > 0)) return out;
  out.frame = polar_rotation(mean);
  for (int round = 0; round < most_rounds; ++round) {
    out.at = out.frame.transpose() * places;
    const Eigen::Matrix3Xd moved = out.at - rest_[index].at;
    out.forces.resize(3, moved.cols());
    Eigen::Map<VecX>(out.forces.data(), out.forces.size()).noalias() = piece.stiffness * flat(moved);
    out.energy = 0.5 * flat(out.forces).dot(flat(moved));
    out.left.setZero();
    for (Eigen::Index a = 0; a < moved.cols(); ++a)
      out.left += 0.5 * Vec3(piece.slopes.col(a)).cross(Vec3(out.at.col(a)));
    out.energy += 0.5 * piece.turning * out.left.squaredNorm();
    Vec3 torque = Vec3::Zero();
    for (Eigen::Index a = 0; a < moved.cols(); ++a) {
      out.forces.col(a) += 0.5 * piece.turning * out.left.cross(Vec3(piece.slopes.col(a)));
      torque += Vec3(out.at.col(a)).cross(Vec3(out.forces.col(a)));
    }
    const Mat3 bend =
        turning_hessian(piece.turning, out.frame.transpose() * mean, out.forces * out.at.transpose());
    const Vec3 turn = bend.inverse() * torque;
    const double angle = turn.norm();
    if (!std::isfinite(angle)) return out;
    if (angle <= turned) {
      out.admissible = true;
      return out;
    }
    out.frame = out.frame * Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  }
  out.energy = std::numeric_limits<double>::infinity();
  return out;
}

double FramedSolid::value(const VecX& x) const {
  double sum = 0;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const Seen seen = see(p, x);
    if (!seen.admissible) return std::numeric_limits<double>::infinity();
    sum += seen.energy;
  }
  return sum;
}

void FramedSolid::add_gradient(const VecX& x, VecX& gradient) const {
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const Seen seen = see(p, x);
    for (std::size_t a = 0; a < pieces_[p].nodes.size(); ++a)
      gradient.segment<3>(Eigen::Index{3} * pieces_[p].nodes[a]) +=
          seen.frame * seen.forces.col(static_cast<Eigen::Index>(a));
  }
}

void FramedSolid::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const Piece& piece = pieces_[p];
    const Seen seen = see(p, x);
    const Eigen::Index count = seen.at.cols();
    // Turns of the frame, as motions of the nodes in it; what they change forces by.
    Eigen::MatrixXd turns(3 * count, 3), mixed(3 * count, 3);
    for (Eigen::Index a = 0; a < count; ++a) turns.middleRows<3>(3 * a) = cross_matrix(seen.at.col(a));
    mixed.noalias() = piece.stiffness * turns;
    const Mat3 mean = seen.at * piece.slopes.transpose(), left = change_of_left(mean);
    const Mat3 by_turn =
        turns.transpose() * mixed + turning_hessian(piece.turning, mean, seen.forces * seen.at.transpose());
    for (Eigen::Index a = 0; a < count; ++a)
      mixed.middleRows<3>(3 * a) -=
          0.5 * piece.turning * cross_matrix(piece.slopes.col(a)) * left + cross_matrix(seen.forces.col(a));
    const Eigen::MatrixXd followed = mixed * by_turn.inverse();
    const Mat3 back = seen.frame.transpose();
    for (Eigen::Index b = 0; b < count; ++b)
      for (Eigen::Index a = b; a < count; ++a) {
        const Vec3 one = piece.slopes.col(a), other = piece.slopes.col(b);
        const Mat3 block =
            piece.stiffness.block<3, 3>(3 * a, 3 * b) -
            followed.middleRows<3>(3 * a) * mixed.middleRows<3>(3 * b).transpose() +
            0.25 * piece.turning * (one.dot(other) * Mat3::Identity() - other * one.transpose());
        matrix.add(piece.nodes[static_cast<std::size_t>(a)], piece.nodes[static_cast<std::size_t>(b)],
                   seen.frame * block * back);
      }
  }
}

std::vector<std::vector<int>> FramedSolid::cliques() const {
  std::vector<std::vector<int>> out;
  for (const Piece& piece : pieces_) out.push_back(piece.nodes);
  return out;
}

std::vector<Mat3> FramedSolid::frames(const VecX& x) const {
  std::vector<Mat3> out;
  for (std::size_t p = 0; p < pieces_.size(); ++p) out.push_back(see(p, x).frame);
  return out;
}

}  // namespace calot
