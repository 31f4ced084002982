#pragma once
// A solid of tetrahedra, condensed onto few nodes once and for all: statics of what is free (the paper's
// groupstructure), and pieces that turn on their own.

#include "base/status.h"
#include "fem/framed_solid.h"
#include "fem/tetrahedron.h"

namespace calot {

/// The kept nodes are averages: those whose blends come nearest to where the points of the surface are. So the surface
/// is as soft between them as its tetrahedra are, and what pulls on a node pulls on all points that it stands for. Where
/// each point of the surface is a node of its own they are the points themselves.
struct SolidMesh {
  std::vector<QuadraticTet> tets;
  /// Each point as a blend of the kept nodes at rest, which gives affine motions of these exactly.
  StencilTable rows;
  std::vector<char> averaged;  ///< one a point: it is on the surface
  std::vector<int> piece_of;   ///< one a tetrahedron, from 0 on
  int nodes = 0;               ///< kept
};

/// What a piece's frame turns against, times its shear modulus and volume (FramedSolid::Piece::turning): the angle by
/// which it misses the polar decomposition's is a fortieth of the square of the strain.
inline constexpr double frame_turning = 40;

/// Vibrations of the inside with the nodes held (Craig and Bampton 1968), of the motions by which it answers when the
/// whole is accelerated as a rigid body: without them the fifth frequency of a lobe is 1.8 % too high, with them 0.7 %,
/// with as many of the slowest instead 1.1 %.
inline constexpr int inner_modes = 6;

struct ReducedSolid {
  FramedSolid::Parts parts;
  /// m^3 (a density of 1), by x, y, z of the nodes, with all frames as at rest. A shift has the whole mass in any
  /// posture; what turns far has its inertia nearly.
  Eigen::MatrixXd mass;
  /// Of the modes, by the way of their fastest point: m^3, N/m for the solid as it is, and m^3 with the nodes' motions.
  Eigen::Matrix<double, inner_modes, 1> mode_inertia, mode_stiffness;
  Eigen::MatrixXd mode_coupling;
};
/// The energy of the whole, condensed once: each piece's points are the blends of the kept nodes, seen in its frame, and
/// what they are off these where they are in balance with all frames equal, by the strains that all pieces have in their
/// own frames. With all frames equal that is the whole. Fails (scenario) where a tetrahedron is inside out at rest.
Result<ReducedSolid> reduce(const SolidMesh& mesh, const VecX& rest, const ElasticSolid& solid);

}  // namespace calot
