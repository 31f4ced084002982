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
  /// The pieces in their frames; columns follow each other piece by piece.
  struct Seen {
    bool admissible = false;
    std::vector<Mat3> frames, means;  ///< mean deformation gradients in the frames
    Eigen::Matrix3Xd at, forces;      ///< m, N
    double energy = 0;
  };
  Eigen::Index count(std::size_t piece) const { return first_[piece + 1] - first_[piece]; }
  Seen see(const VecX& x) const;
  /// Energy and forces in the present frames.
  void look(const Eigen::Matrix3Xd& places, Seen& seen) const;

  Parts parts_;
  std::vector<Eigen::Index> first_;  ///< column of each piece, and their number
  std::vector<int> nodes_;           ///< of all pieces, increasing
  std::vector<Eigen::Index> place_;  ///< of each column among them
  Eigen::Matrix3Xd rest_;            ///< m, from each piece's middle
};

}  // namespace calot
