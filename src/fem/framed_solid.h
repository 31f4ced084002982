#pragma once
// A solid in pieces, each linear in a frame that turns with it: it may turn by any angle while what bends stays small
// within a piece.
//
// A piece has rest places X and places y = R'(x - c) of its nodes seen in its frame R. The energy is, over all pieces p
// with displacements u = y - X,
//
//   min over the frames of  sum 1/2 u_p' S_pq u_q + sum 1/2 k_p |w_p|^2,   w = 1/2 sum of slope x y,
//
// w being the turn that is left of the piece's mean deformation: with a k above the stiffness S by some ten times R is
// the rotation of the polar decomposition but for an angle of the second order in the strain. As the frames minimise, the
// gradient is the one at fixed frames, forces have no net torque, and the Hessian is exact in closed form. It is not
// projected: it may be indefinite where the solid is squeezed.

#include <memory>
#include <mutex>
#include <span>

#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

class FramedSolid {
 public:
  struct Piece {
    std::vector<int> nodes;   ///< increasing
    Eigen::Matrix3Xd slopes;  ///< 1/m, a column a node: the mean deformation gradient is the sum of x slope'
    double turning = 0;       ///< k, J
  };
  /// S_pq and its transpose S_qp, N/m, by x, y, z of the pieces' nodes; one that is its own is symmetric. With all frames
  /// equal rigid motions cost nothing, to first order.
  struct Stiffness {
    int one = 0, other = 0;
    Eigen::MatrixXd block;
  };
  struct Parts {
    std::vector<Piece> pieces;
    std::vector<Stiffness> stiffness;  ///< of every pair of pieces once
  };
  FramedSolid() = default;
  FramedSolid(const VecX& rest, Parts parts);

  /// J; infinite where a piece is inside out.
  double value(const VecX& x) const;
  void add_gradient(const VecX& x, VecX& gradient) const;
  void add_hessian(const VecX& x, BlockMatrix& matrix) const;
  std::vector<std::vector<int>> cliques() const;
  std::vector<Mat3> frames(const VecX& x) const;
  const Parts& parts() const { return parts_; }

 private:
  /// Places in frames are linear in the frames' entries, nine a piece (R, row by row), and so is what the stiffness does
  /// there: it is asked once a state, however often the frames turn until they fit.
  struct Placed {
    std::vector<Eigen::MatrixX3d> at;  ///< m, of each piece, from its middle: a row a node
    std::vector<Mat3> means;           ///< mean deformation gradients
    /// Of each piece, N and J by the entries of all frames: forces on its nodes, all in x, then y, then z; and the sums
    /// of these times the nodes' places, by the entries of its own frame.
    std::vector<Eigen::MatrixXd> forces, moments;
    std::vector<Mat3> moments_of_rest;  ///< J, of what the stiffness does at rest
  };
  /// The pieces in their frames.
  struct Seen {
    bool admissible = false;
    Placed placed;
    std::vector<Mat3> frames, means;           ///< mean deformation gradients in the frames
    std::vector<Eigen::MatrixX3d> at, forces;  ///< m, N
    double energy = 0;
  };
  Eigen::Index count(std::size_t piece) const { return first_[piece + 1] - first_[piece]; }
  /// Places and mean deformation gradients.
  Placed placed_at(const VecX& x) const;
  /// What the stiffness does there.
  void answer(Placed& placed) const;
  /// A piece in its frame: its mean deformation gradient, and the sum of its forces times its places, J.
  struct Twisted {
    Mat3 mean, by_places;
  };
  std::vector<Twisted> twisted(const Placed& placed, const std::vector<Mat3>& frames) const;
  /// What turns the frames towards where the energy is least, three numbers a frame, rad: each as if the others stood
  /// still; or all by Newton's method, not finite where the energy curves down.
  Eigen::Matrix3Xd turns_one_by_one(const Placed& placed, const std::vector<Mat3>& frames) const;
  Eigen::Matrix3Xd turns_together(const Placed& placed, const std::vector<Mat3>& frames) const;
  /// Turns the frames to where the energy is least; false: there is no such place near.
  bool fit(const Placed& placed, std::vector<Mat3>& frames) const;
  /// Energy and forces in the frames.
  void look(Seen& seen) const;
  Seen look_at(const VecX& x) const;
  /// look_at(), remembered: a solve asks for value, gradient and Hessian at one x.
  std::shared_ptr<const Seen> see(const VecX& x) const;
  /// What was seen last. It follows from x alone, so copies share it, and so may threads.
  struct Memory {
    std::mutex mutex;
    VecX x;
    std::shared_ptr<const Seen> seen;
  };
  /// How forces and energy change with turns of the frames about their own axes: three columns a piece.
  struct TurnSlopes {
    /// N a rad, on the pieces' nodes (three rows a node of each piece), seen in the pieces' frames.
    Eigen::MatrixXd forces;
    Eigen::MatrixXd second;  ///< J a rad^2, the energy's second derivative by two turns
  };
  /// What the stiffness by itself has of that second derivative.
  Eigen::MatrixXd second_by_turns(const Placed& placed, const std::vector<Mat3>& frames) const;
  /// These slopes at fixed places of the nodes.
  TurnSlopes turn_slopes(const Seen& seen) const;
  /// The slopes' forces in the world's directions, N a rad, summed over the pieces: three rows a node of nodes_.
  Eigen::MatrixXd forces_on_nodes(const Seen& seen, const TurnSlopes& slopes) const;
  /// Adds the stiffness of the nodes where no frame turns, N/m, in the world's directions, three rows and columns a node
  /// of nodes_: a half, which the stiffness is the sum of with its transpose.
  void add_half_stiffness(const Seen& seen, Eigen::MatrixXd& half) const;
  /// The same of what keeps the frames turned with their pieces.
  void add_half_turning(const Seen& seen, Eigen::MatrixXd& half) const;
  /// The number of the nodes' coordinates: three a node of nodes_.
  Eigen::Index unknowns() const { return 3 * static_cast<Eigen::Index>(nodes_.size()); }

  Parts parts_;
  std::vector<Eigen::Index> first_;  ///< column of each piece, and their number
  std::vector<int> nodes_;           ///< of all pieces, increasing
  std::vector<Eigen::Index> place_;  ///< of each column among them
  /// m, from each piece's middle, and N, what the stiffness does where these are displacements.
  std::vector<Eigen::MatrixX3d> rest_, held_by_rest_;
  /// N/m, as Parts::stiffness, but by ways: where the nodes of the other piece go in x, y, z (first index), the forces on
  /// those of the one in x, y, z (second), a row for each of these and a column for each of those. A stiffness that is
  /// its own has only those with first >= second: the others are their transposes.
  struct ByWays {
    std::array<std::array<Eigen::MatrixXd, 3>, 3> blocks;
  };
  std::vector<ByWays> by_ways_;  ///< as Parts::stiffness
  std::shared_ptr<Memory> memory_ = std::make_shared<Memory>();
};

}  // namespace calot
