#pragma once
// A solid in pieces, each linear in a frame that turns with it: it may turn by any angle while what bends stays small
// within a piece.
//
// A piece has the energy, at nodes x with rest places X and places y = R'(x - c) seen in its frame R,
//
//   min over R of  1/2 (y - X)' S (y - X) + 1/2 k |w|^2,   w = 1/2 sum of slope x y,
//
// w being the turn that is left of the piece's mean deformation: with a k above the stiffness S by some ten times R is
// the rotation of the polar decomposition but for an angle of the second order in the strain. As R minimises, the
// gradient is the one at a fixed R, forces have no net torque, and the Hessian is exact in closed form. It is not
// projected: it may be indefinite where the solid is squeezed.

#include <span>

#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

class FramedSolid {
 public:
  struct Piece {
    std::vector<int> nodes;     ///< increasing
    Eigen::MatrixXd stiffness;  ///< S, N/m: symmetric, rigid motions (to first order) cost nothing
    Eigen::Matrix3Xd slopes;  ///< 1/m, a column a node: the mean deformation gradient is the sum of x slope'
    double turning = 0;       ///< k, J
  };
  FramedSolid() = default;
  FramedSolid(const VecX& rest, std::vector<Piece> pieces);

  /// J; infinite where a piece is inside out.
  double value(const VecX& x) const;
  void add_gradient(const VecX& x, VecX& gradient) const;
  void add_hessian(const VecX& x, BlockMatrix& matrix) const;
  std::vector<std::vector<int>> cliques() const;
  std::vector<Mat3> frames(const VecX& x) const;
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  /// A piece in its frame.
  struct Seen {
    bool admissible = false;
    Mat3 frame = Mat3::Identity();
    Eigen::Matrix3Xd at, forces;  ///< m, N, in the frame, a column a node
    Vec3 left = Vec3::Zero();     ///< w
    double energy = 0;
  };
  struct Rest {
    Eigen::Matrix3Xd at;  ///< m, from the nodes' middle
  };
  Seen see(std::size_t piece, const VecX& x) const;

  std::vector<Piece> pieces_;
  std::vector<Rest> rest_;
};

}  // namespace calot
