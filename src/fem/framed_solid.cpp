#include "fem/framed_solid.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>

namespace calot {
namespace {

Eigen::Map<const VecX> flat(const Eigen::Matrix3Xd& columns) { return {columns.data(), columns.size()}; }
Eigen::Map<VecX> flat(Eigen::Matrix3Xd& columns) { return {columns.data(), columns.size()}; }

/// Of m with a determinant above 0.
Mat3 polar_rotation(const Mat3& m) {
  const Eigen::JacobiSVD<Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

/// Of a skew matrix, twice.
Vec3 axis_of(const Mat3& m) { return {m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)}; }

/// How w changes with a turn of the frame; `mean`: the mean deformation gradient in the frame.
Mat3 change_of_left(const Mat3& mean) { return 0.5 * (mean - mean.trace() * Mat3::Identity()); }

/// Second derivative of the energy by a turn of the frame but for the stiffness, which adds what is of the second order
/// in the strain.
Mat3 turning_hessian(double turning, const Mat3& mean, const Mat3& forces_by_places) {
  const Mat3 left = change_of_left(mean);
  return turning * left.transpose() * left + 0.5 * (forces_by_places + forces_by_places.transpose()) -
         forces_by_places.trace() * Mat3::Identity();
}

/// Each three columns seen from outside a frame.
Eigen::MatrixXd columns_turned(Eigen::MatrixXd block, const Mat3& frame) {
  const Mat3 back = frame.transpose();
  for (Eigen::Index b = 0; b < block.cols(); b += 3)
    block.middleCols<3>(b) = (block.middleCols<3>(b) * back).eval();
  return block;
}

void add_turning(const FramedSolid::Piece& piece, Eigen::MatrixXd& block) {
  for (Eigen::Index b = 0; b < piece.slopes.cols(); ++b)
    for (Eigen::Index a = 0; a < piece.slopes.cols(); ++a) {
      const Vec3 one = piece.slopes.col(a), other = piece.slopes.col(b);
      block.block<3, 3>(3 * a, 3 * b) +=
          0.25 * piece.turning * (one.dot(other) * Mat3::Identity() - other * one.transpose());
    }
}

}  // namespace

FramedSolid::FramedSolid(const VecX& rest, Parts parts) : parts_(std::move(parts)), first_{0} {
  for (const Piece& piece : parts_.pieces)
    first_.push_back(first_.back() + static_cast<Eigen::Index>(piece.nodes.size()));
  for (const Piece& piece : parts_.pieces)
    nodes_.insert(nodes_.end(), piece.nodes.begin(), piece.nodes.end());
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  for (const Piece& piece : parts_.pieces)
    for (int node : piece.nodes)
      place_.push_back(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
  rest_.resize(3, first_.back());
  for (std::size_t p = 0; p < parts_.pieces.size(); ++p) {
    auto own = rest_.middleCols(first_[p], count(p));
    for (Eigen::Index a = 0; a < count(p); ++a)
      own.col(a) = rest.segment<3>(Eigen::Index{3} * parts_.pieces[p].nodes[static_cast<std::size_t>(a)]);
    own.colwise() -= Vec3(own.rowwise().mean());
  }
}

void FramedSolid::look(const Eigen::Matrix3Xd& places, Seen& seen) const {
  for (std::size_t p = 0; p < parts_.pieces.size(); ++p)
    seen.at.middleCols(first_[p], count(p)) =
        seen.frames[p].transpose() * places.middleCols(first_[p], count(p));
  const Eigen::Matrix3Xd moved = seen.at - rest_;
  seen.forces.setZero(3, moved.cols());
  for (const Stiffness& s : parts_.stiffness) {
    const Eigen::Index one = 3 * first_[s.one], other = 3 * first_[s.other];
    flat(seen.forces).segment(one, s.block.rows()).noalias() +=
        s.block * flat(moved).segment(other, s.block.cols());
    if (s.one != s.other)
      flat(seen.forces).segment(other, s.block.cols()).noalias() +=
          s.block.transpose() * flat(moved).segment(one, s.block.rows());
  }
  seen.energy = 0.5 * flat(seen.forces).dot(flat(moved));
  for (std::size_t p = 0; p < parts_.pieces.size(); ++p) {
    const Piece& piece = parts_.pieces[p];
    seen.means[p] = seen.at.middleCols(first_[p], count(p)) * piece.slopes.transpose();
    const Vec3 left = 0.5 * axis_of(seen.means[p]);
    seen.energy += 0.5 * piece.turning * left.squaredNorm();
    for (Eigen::Index a = 0; a < count(p); ++a)
      seen.forces.col(first_[p] + a) += 0.5 * piece.turning * left.cross(Vec3(piece.slopes.col(a)));
  }
}

FramedSolid::Seen FramedSolid::see(const VecX& x) const {
  constexpr int most_rounds = 60;
  constexpr double turned = 1e-12;  // rad
  const double infinite = std::numeric_limits<double>::infinity();
  const std::size_t pieces = parts_.pieces.size();
  Seen out{false, std::vector<Mat3>(pieces), std::vector<Mat3>(pieces), rest_, rest_, infinite};
  Eigen::Matrix3Xd places(3, rest_.cols());
  for (std::size_t p = 0; p < pieces; ++p) {
    auto own = places.middleCols(first_[p], count(p));
    for (Eigen::Index a = 0; a < count(p); ++a)
      own.col(a) = x.segment<3>(Eigen::Index{3} * parts_.pieces[p].nodes[static_cast<std::size_t>(a)]);
    own.colwise() -= Vec3(own.rowwise().mean());
    const Mat3 mean = own * parts_.pieces[p].slopes.transpose();
    if (!(mean.determinant() > 0)) return out;
    out.frames[p] = polar_rotation(mean);
  }
  for (int round = 0; round < most_rounds; ++round) {
    look(places, out);
    double largest = 0;
    for (std::size_t p = 0; p < pieces; ++p) {
      const auto at = out.at.middleCols(first_[p], count(p)),
                 forces = out.forces.middleCols(first_[p], count(p));
      const Mat3 by_places = forces * at.transpose();
      const Vec3 turn = turning_hessian(parts_.pieces[p].turning, out.means[p], by_places).inverse() *
                        -axis_of(by_places.transpose());
      const double angle = turn.norm();
      if (!std::isfinite(angle)) return out.energy = infinite, out;
      largest = std::max(largest, angle);
      if (angle > turned)
        out.frames[p] = out.frames[p] * Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
    }
    if (largest <= turned) return out.admissible = true, out;
  }
  return out.energy = infinite, out;
}

double FramedSolid::value(const VecX& x) const { return see(x).energy; }

void FramedSolid::add_gradient(const VecX& x, VecX& gradient) const {
  const Seen seen = see(x);
  for (std::size_t p = 0; p < parts_.pieces.size(); ++p)
    for (Eigen::Index a = 0; a < count(p); ++a)
      gradient.segment<3>(Eigen::Index{3} * parts_.pieces[p].nodes[static_cast<std::size_t>(a)]) +=
          seen.frames[p] * seen.forces.col(first_[p] + a);
}

void FramedSolid::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  const Seen seen = see(x);
  const auto pieces = static_cast<Eigen::Index>(parts_.pieces.size());
  // Turns of each frame, as motions of the nodes in it, and the forces that they change.
  Eigen::MatrixXd turns(3 * rest_.cols(), 3), mixed = Eigen::MatrixXd::Zero(3 * rest_.cols(), 3 * pieces);
  for (Eigen::Index a = 0; a < rest_.cols(); ++a) turns.middleRows<3>(3 * a) = cross_matrix(seen.at.col(a));
  const auto rows = [&](int p) { return 3 * first_[p]; };
  const auto length = [&](int p) { return 3 * count(static_cast<std::size_t>(p)); };
  for (const Stiffness& s : parts_.stiffness) {
    mixed.block(rows(s.one), 3 * s.other, length(s.one), 3).noalias() +=
        s.block * turns.middleRows(rows(s.other), length(s.other));
    if (s.one != s.other)
      mixed.block(rows(s.other), 3 * s.one, length(s.other), 3).noalias() +=
          s.block.transpose() * turns.middleRows(rows(s.one), length(s.one));
  }
  Eigen::MatrixXd by_turns(3 * pieces, 3 * pieces);
  for (int p = 0; p < pieces; ++p) {
    by_turns.middleRows<3>(3 * p).noalias() =
        turns.middleRows(rows(p), length(p)).transpose() * mixed.middleRows(rows(p), length(p));
    const Piece& piece = parts_.pieces[static_cast<std::size_t>(p)];
    const Mat3 by_places = seen.forces.middleCols(first_[p], length(p) / 3) *
                           seen.at.middleCols(first_[p], length(p) / 3).transpose();
    by_turns.block<3, 3>(3 * p, 3 * p) += turning_hessian(piece.turning, seen.means[p], by_places);
    const Mat3 left = change_of_left(seen.means[p]);
    for (Eigen::Index a = 0; 3 * a < length(p); ++a)
      mixed.block<3, 3>(rows(p) + 3 * a, 3 * p) -=
          0.5 * piece.turning * cross_matrix(piece.slopes.col(a)) * left +
          cross_matrix(seen.forces.col(first_[p] + a));
  }
  const auto unknowns = 3 * static_cast<Eigen::Index>(nodes_.size());
  // Over all nodes in the world's directions: what pairs of pieces add, each but once, and what turns take away.
  Eigen::MatrixXd paired = Eigen::MatrixXd::Zero(unknowns, unknowns), own = paired,
                  turned = Eigen::MatrixXd::Zero(unknowns, 3 * pieces);
  for (const Stiffness& s : parts_.stiffness) {
    const int p = s.one, q = s.other;
    Eigen::MatrixXd block = s.block;
    if (p == q) add_turning(parts_.pieces[static_cast<std::size_t>(p)], block);
    block = columns_turned(columns_turned(std::move(block), seen.frames[q]).transpose(), seen.frames[p]);
    Eigen::MatrixXd& sum = p == q ? own : paired;
    for (Eigen::Index b = 0; 3 * b < length(p); ++b)
      for (Eigen::Index a = 0; 3 * a < length(q); ++a)
        sum.block<3, 3>(3 * place_[first_[q] + a], 3 * place_[first_[p] + b]) +=
            block.block<3, 3>(3 * a, 3 * b);
  }
  for (int p = 0; p < pieces; ++p)
    for (Eigen::Index a = 0; 3 * a < length(p); ++a)
      turned.middleRows<3>(3 * place_[first_[p] + a]) +=
          seen.frames[p] * mixed.middleRows<3>(rows(p) + 3 * a);
  own.noalias() -= turned * Eigen::PartialPivLU<Eigen::MatrixXd>(by_turns).solve(turned.transpose());
  for (std::size_t b = 0; b < nodes_.size(); ++b)
    for (std::size_t a = b; a < nodes_.size(); ++a) {
      const auto i = 3 * static_cast<Eigen::Index>(a), j = 3 * static_cast<Eigen::Index>(b);
      matrix.add(nodes_[a], nodes_[b],
                 own.block<3, 3>(i, j) + paired.block<3, 3>(i, j) + paired.block<3, 3>(j, i).transpose());
    }
}

std::vector<std::vector<int>> FramedSolid::cliques() const { return {nodes_}; }

std::vector<Mat3> FramedSolid::frames(const VecX& x) const { return see(x).frames; }

}  // namespace calot
