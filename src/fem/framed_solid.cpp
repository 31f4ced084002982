#include "fem/framed_solid.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/decompose.h"

namespace calot {
namespace {

using Rows = Eigen::MatrixX3d;

/// The entries of all frames, in the order of FramedSolid::Placed.
VecX entries_of(const std::vector<Mat3>& frames) {
  VecX out(9 * static_cast<Eigen::Index>(frames.size()));
  for (std::size_t p = 0; p < frames.size(); ++p)
    out.segment<9>(9 * static_cast<Eigen::Index>(p)) = frames[p].transpose().reshaped();
  return out;
}

/// How a frame's entries change with a turn about its own axes.
Eigen::Matrix<double, 9, 3> entries_by_turn(const Mat3& frame) {
  Eigen::Matrix<double, 9, 3> out;
  for (Eigen::Index row = 0; row < 3; ++row) out.middleRows<3>(3 * row) = cross_matrix(frame.row(row));
  return out;
}

/// Of a stiffness, the forces in one way by motions in another.
Eigen::MatrixXd of_ways(const Eigen::MatrixXd& block, Eigen::Index force, Eigen::Index motion) {
  return block(Eigen::seq(force, Eigen::last, 3), Eigen::seq(motion, Eigen::last, 3));
}

/// Of m with a determinant above 0.
Mat3 polar_rotation(const Mat3& m) {
  const Singular parts = singular(m);
  return parts.left * parts.right.transpose();
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

/// Turns frames about their own axes by what turns(frames) says, a column a frame, until that is nothing. Whether it became
/// so; not where one is to turn further than the first time, nor where one ends far from where it began: energies are least
/// there, too, but of other ways to turn.
template <class Turns>
bool turn_until_still(std::vector<Mat3>& frames, const Turns& turns) {
  constexpr int most_rounds = 60;
  constexpr double still = 1e-12, furthest = 0.1, far = 0.5;  // rad; at a time, and in all
  const std::vector<Mat3> begin = frames;
  double first = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    const Eigen::Matrix3Xd by = turns(frames);
    const double largest = by.colwise().norm().maxCoeff();
    if (!by.allFinite() || largest > first) return false;
    if (round == 0) first = largest;
    const double share = std::min(1.0, furthest / largest);
    for (std::size_t p = 0; p < frames.size(); ++p) {
      const Vec3 turn = share * by.col(static_cast<Eigen::Index>(p));
      const double angle = turn.norm();
      if (angle > still) frames[p] = frames[p] * Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
    }
    if (largest > still) continue;
    return std::equal(frames.begin(), frames.end(), begin.begin(), [](const Mat3& now, const Mat3& before) {
      return (before.transpose() * now).trace() > 1 + 2 * std::cos(far);
    });
  }
  return false;
}

/// How a block of the stiffness, all of one frame's ways by the other's (entry 3 force + motion), is seen from outside the
/// frames.
Eigen::Matrix<double, 9, 9> ways_turned(const Mat3& of_forces, const Mat3& of_motions) {
  Eigen::Matrix<double, 9, 9> out;
  for (int force = 0; force < 3; ++force)
    for (int motion = 0; motion < 3; ++motion)
      for (int row = 0; row < 3; ++row)
        out.block<1, 3>(3 * force + motion, 3 * row) =
            of_forces(row, force) * of_motions.col(motion).transpose();
  return out;
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
  const std::size_t pieces = parts_.pieces.size();
  for (const Stiffness& s : parts_.stiffness) {
    ByWays& own = by_ways_.emplace_back();
    for (int motion = 0; motion < 3; ++motion)
      for (int force = 0; force < 3; ++force)
        if (s.one != s.other || motion >= force) own.blocks[motion][force] = of_ways(s.block, force, motion);
  }
  Placed placed = placed_at(rest);
  answer(placed);
  const VecX as_drawn = entries_of(std::vector<Mat3>(pieces, Mat3::Identity()));
  for (const Eigen::MatrixXd& by_entries : placed.forces)
    held_by_rest_.emplace_back((by_entries * as_drawn).reshaped(by_entries.rows() / 3, 3));
  rest_ = std::move(placed.at);
}

FramedSolid::Placed FramedSolid::placed_at(const VecX& x) const {
  Placed out;
  for (std::size_t p = 0; p < parts_.pieces.size(); ++p) {
    const Piece& piece = parts_.pieces[p];
    Rows at(count(p), 3);
    for (Eigen::Index a = 0; a < count(p); ++a)
      at.row(a) = x.segment<3>(Eigen::Index{3} * piece.nodes[static_cast<std::size_t>(a)]);
    at.rowwise() -= at.colwise().mean().eval();
    out.means.emplace_back(at.transpose() * piece.slopes.transpose());
    out.at.push_back(std::move(at));
  }
  return out;
}

void FramedSolid::answer(Placed& placed) const {
  const std::size_t pieces = parts_.pieces.size();
  const auto entries = 9 * static_cast<Eigen::Index>(pieces);
  for (std::size_t p = 0; p < pieces; ++p) placed.forces.emplace_back(3 * count(p), entries);
  // Entry 3 row + way of a frame has the nodes go in that way by their places' row.
  const auto add = [&](int to, int from, int motion, int force, const auto& block) {
    for (int row = 0; row < 3; ++row)
      placed.forces[to].col(9 * from + 3 * row + motion).segment(force * count(to), count(to)).noalias() =
          block * placed.at[from].col(row);
  };
  for (std::size_t k = 0; k < by_ways_.size(); ++k) {
    const int one = parts_.stiffness[k].one, other = parts_.stiffness[k].other;
    for (int motion = 0; motion < 3; ++motion)
      for (int force = 0; force < 3; ++force) {
        const Eigen::MatrixXd& block = by_ways_[k].blocks[motion][force];
        if (block.size() == 0) continue;
        add(one, other, motion, force, block);
        if (one != other || motion != force) add(other, one, force, motion, block.transpose());
      }
  }
  for (std::size_t p = 0; p < pieces; ++p) {
    Eigen::MatrixXd& moments = placed.moments.emplace_back(9, entries);
    const Rows summed =
        Eigen::Map<const Eigen::MatrixXd>(placed.forces[p].data(), count(p), 3 * entries).transpose() *
        placed.at[p];
    for (Eigen::Index k = 0; k < 3; ++k) moments.middleRows<3>(3 * k) = summed.col(k).reshaped(3, entries);
    if (!held_by_rest_.empty())
      placed.moments_of_rest.emplace_back(held_by_rest_[p].transpose() * placed.at[p]);
  }
}

std::vector<FramedSolid::Twisted> FramedSolid::twisted(const Placed& placed,
                                                       const std::vector<Mat3>& frames) const {
  const VecX entries = entries_of(frames);
  std::vector<Twisted> out;
  for (std::size_t p = 0; p < frames.size(); ++p) {
    const double turning = parts_.pieces[p].turning;
    const Mat3 mean = frames[p].transpose() * placed.means[p];
    const Vec3 left = 0.5 * axis_of(mean);
    const Mat3 moments = (placed.moments[p] * entries).reshaped(3, 3) - placed.moments_of_rest[p];
    out.push_back({mean, moments * frames[p] + 0.5 * turning * cross_matrix(left) * mean.transpose()});
  }
  return out;
}

Eigen::Matrix3Xd FramedSolid::turns_one_by_one(const Placed& placed, const std::vector<Mat3>& frames) const {
  const std::vector<Twisted> pieces = twisted(placed, frames);
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(frames.size()));
  for (std::size_t p = 0; p < frames.size(); ++p) {
    const auto& [mean, by_places] = pieces[p];
    out.col(static_cast<Eigen::Index>(p)) =
        turning_hessian(parts_.pieces[p].turning, mean, by_places).inverse() *
        -axis_of(by_places.transpose());
  }
  return out;
}

Eigen::Matrix3Xd FramedSolid::turns_together(const Placed& placed, const std::vector<Mat3>& frames) const {
  const std::vector<Twisted> pieces = twisted(placed, frames);
  Eigen::MatrixXd second = second_by_turns(placed, frames);
  VecX slope(second.rows());
  for (std::size_t p = 0; p < frames.size(); ++p) {
    const auto row = 3 * static_cast<Eigen::Index>(p);
    const auto& [mean, by_places] = pieces[p];
    slope.segment<3>(row) = axis_of(by_places.transpose());
    second.block<3, 3>(row, row) += turning_hessian(parts_.pieces[p].turning, mean, by_places);
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(second);
  if (factor.info() != Eigen::Success)
    return Eigen::Matrix3Xd::Constant(3, slope.size() / 3, std::numeric_limits<double>::quiet_NaN());
  return -factor.solve(slope).reshaped(3, slope.size() / 3);
}

bool FramedSolid::fit(const Placed& placed, std::vector<Mat3>& frames) const {
  // Most solids need a few of these rounds. But where strands draw a place far out each leaves two thirds of what was to
  // be turned, or more.
  std::vector<Mat3> one_by_one = frames;
  if (turn_until_still(one_by_one, [&](const auto& now) { return turns_one_by_one(placed, now); })) {
    frames = std::move(one_by_one);
    return true;
  }
  return turn_until_still(frames, [&](const auto& now) { return turns_together(placed, now); });
}

void FramedSolid::look(Seen& seen) const {
  const VecX entries = entries_of(seen.frames);
  seen.energy = 0;
  for (std::size_t p = 0; p < parts_.pieces.size(); ++p) {
    const Piece& piece = parts_.pieces[p];
    seen.at.emplace_back(seen.placed.at[p] * seen.frames[p]);
    Rows& forces = seen.forces.emplace_back((seen.placed.forces[p] * entries).reshaped(count(p), 3));
    forces -= held_by_rest_[p];
    seen.energy += 0.5 * forces.cwiseProduct(seen.at[p] - rest_[p]).sum();
    const Mat3 mean = seen.means.emplace_back(seen.frames[p].transpose() * seen.placed.means[p]);
    const Vec3 left = 0.5 * axis_of(mean);
    seen.energy += 0.5 * piece.turning * left.squaredNorm();
    forces += piece.slopes.transpose() * (0.5 * piece.turning * cross_matrix(left)).transpose();
  }
}

FramedSolid::Seen FramedSolid::look_at(const VecX& x) const {
  Seen out;
  out.energy = std::numeric_limits<double>::infinity();
  out.placed = placed_at(x);
  for (const Mat3& mean : out.placed.means) {
    if (!(mean.determinant() > 0)) return out;
    out.frames.push_back(polar_rotation(mean));
  }
  answer(out.placed);
  out.admissible = fit(out.placed, out.frames);
  if (out.admissible) look(out);
  return out;
}

std::shared_ptr<const FramedSolid::Seen> FramedSolid::see(const VecX& x) const {
  {
    const std::lock_guard lock(memory_->mutex);
    if (memory_->seen && memory_->x == x) return memory_->seen;
  }
  const auto seen = std::make_shared<const Seen>(look_at(x));
  const std::lock_guard lock(memory_->mutex);
  memory_->x = x;
  memory_->seen = seen;
  return seen;
}

double FramedSolid::value(const VecX& x) const { return see(x)->energy; }

void FramedSolid::add_gradient(const VecX& x, VecX& gradient) const {
  const std::shared_ptr<const Seen> shared = see(x);
  const Seen& seen = *shared;
  for (std::size_t p = 0; p < parts_.pieces.size(); ++p)
    for (Eigen::Index a = 0; a < count(p); ++a) {
      auto own = gradient.segment<3>(Eigen::Index{3} * parts_.pieces[p].nodes[static_cast<std::size_t>(a)]);
      if (seen.admissible)
        own += seen.frames[p] * seen.forces[p].row(a).transpose();
      else
        own.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
}

Eigen::MatrixXd FramedSolid::second_by_turns(const Placed& placed, const std::vector<Mat3>& frames) const {
  const auto pieces = static_cast<Eigen::Index>(frames.size());
  Eigen::MatrixXd out(3 * pieces, 3 * pieces);
  for (int q = 0; q < pieces; ++q) {
    const Eigen::Matrix<double, 9, 3> turn = entries_by_turn(frames[q]);
    for (int p = 0; p < pieces; ++p)
      out.block<3, 3>(3 * p, 3 * q) =
          entries_by_turn(frames[p]).transpose() * placed.moments[p].middleCols<9>(9 * q) * turn;
  }
  return out;
}

FramedSolid::TurnSlopes FramedSolid::turn_slopes(const Seen& seen) const {
  const auto pieces = static_cast<Eigen::Index>(parts_.pieces.size());
  const auto rows = [&](int p) { return 3 * first_[p]; };
  TurnSlopes out{Eigen::MatrixXd(3 * first_.back(), 3 * pieces), second_by_turns(seen.placed, seen.frames)};
  for (int q = 0; q < pieces; ++q) {
    const Eigen::Matrix<double, 9, 3> turn = entries_by_turn(seen.frames[q]);
    for (int p = 0; p < pieces; ++p) {
      // First all in x, then y and z.
      const Eigen::MatrixX3d forces = seen.placed.forces[p].middleCols<9>(9 * q) * turn;
      for (Eigen::Index a = 0; a < count(p); ++a)
        for (Eigen::Index k = 0; k < 3; ++k)
          out.forces.block<1, 3>(rows(p) + 3 * a + k, 3 * q) = forces.row(k * count(p) + a);
    }
  }
  for (int p = 0; p < pieces; ++p) {
    const Piece& piece = parts_.pieces[static_cast<std::size_t>(p)];
    const Mat3 by_places = seen.forces[p].transpose() * seen.at[p];
    out.second.block<3, 3>(3 * p, 3 * p) += turning_hessian(piece.turning, seen.means[p], by_places);
    const Mat3 left = change_of_left(seen.means[p]);
    for (Eigen::Index a = 0; a < count(p); ++a)
      out.forces.block<3, 3>(rows(p) + 3 * a, 3 * p) -=
          0.5 * piece.turning * cross_matrix(piece.slopes.col(a)) * left +
          cross_matrix(seen.forces[p].row(a));
  }
  return out;
}

Eigen::MatrixXd FramedSolid::forces_on_nodes(const Seen& seen, const TurnSlopes& slopes) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(unknowns(), slopes.forces.cols());
  for (std::size_t p = 0; p < parts_.pieces.size(); ++p)
    for (Eigen::Index a = 0; a < count(p); ++a)
      out.middleRows<3>(3 * place_[first_[p] + a]) +=
          seen.frames[p] * slopes.forces.middleRows<3>(3 * (first_[p] + a));
  return out;
}

void FramedSolid::add_half_stiffness(const Seen& seen, Eigen::MatrixXd& half) const {
  for (std::size_t k = 0; k < by_ways_.size(); ++k) {
    const auto one = static_cast<std::size_t>(parts_.stiffness[k].one),
               other = static_cast<std::size_t>(parts_.stiffness[k].other);
    Eigen::Matrix<double, 9, 9> turn = ways_turned(seen.frames[one], seen.frames[other]);
    if (one == other)
      for (int way : {0, 4, 8}) turn.row(way) *= 0.5;  // the others stand for their transposes
    Eigen::Matrix<double, Eigen::Dynamic, 9> column =
        Eigen::Matrix<double, Eigen::Dynamic, 9>::Zero(count(one), 9);
    Eigen::Matrix<double, Eigen::Dynamic, 9> turned(count(one), 9);
    for (Eigen::Index b = 0; b < count(other); ++b) {
      for (int force = 0; force < 3; ++force)
        for (int motion = one == other ? force : 0; motion < 3; ++motion)
          column.col(3 * force + motion) = by_ways_[k].blocks[motion][force].col(b);
      turned = column.lazyProduct(turn);
      for (Eigen::Index a = 0; a < count(one); ++a)
        for (int row = 0; row < 3; ++row)
          half.block<1, 3>(3 * place_[first_[one] + a] + row, 3 * place_[first_[other] + b]) +=
              turned.block<1, 3>(a, 3 * row);
    }
  }
}

void FramedSolid::add_half_turning(const Seen& seen, Eigen::MatrixXd& half) const {
  for (std::size_t p = 0; p < parts_.pieces.size(); ++p) {
    const Piece& piece = parts_.pieces[p];
    const Eigen::Matrix3Xd slopes = seen.frames[p] * piece.slopes;
    for (Eigen::Index b = 0; b < count(p); ++b)
      for (Eigen::Index a = 0; a < count(p); ++a) {
        const Vec3 one = slopes.col(a), other = slopes.col(b);
        half.block<3, 3>(3 * place_[first_[p] + a], 3 * place_[first_[p] + b]) +=
            0.125 * piece.turning * (one.dot(other) * Mat3::Identity() - other * one.transpose());
      }
  }
}

void FramedSolid::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  const std::shared_ptr<const Seen> shared = see(x);
  const Seen& seen = *shared;
  if (!seen.admissible) return matrix.add(nodes_[0], nodes_[0], Mat3::Constant(seen.energy));
  const TurnSlopes slopes = turn_slopes(seen);
  // The frames follow to where the energy is least: by that the nodes' stiffness is less than with frames held.
  const Eigen::MatrixXd turned = forces_on_nodes(seen, slopes);
  Eigen::MatrixXd half(unknowns(), unknowns());
  half.noalias() =
      -0.5 * turned * Eigen::PartialPivLU<Eigen::MatrixXd>(slopes.second).solve(turned.transpose());
  add_half_stiffness(seen, half);
  add_half_turning(seen, half);
  for (std::size_t b = 0; b < nodes_.size(); ++b)
    for (std::size_t a = b; a < nodes_.size(); ++a) {
      const auto i = 3 * static_cast<Eigen::Index>(a), j = 3 * static_cast<Eigen::Index>(b);
      matrix.add(nodes_[a], nodes_[b], half.block<3, 3>(i, j) + half.block<3, 3>(j, i).transpose());
    }
}

std::vector<std::vector<int>> FramedSolid::cliques() const { return {nodes_}; }

std::vector<Mat3> FramedSolid::frames(const VecX& x) const { return see(x)->frames; }

}  // namespace calot
