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

struct ReducedSolid {
  FramedSolid::Parts parts;
  /// m^3, by x, y, z of the nodes: the mean of that of the same motions, with all frames as at rest, which is a little
  /// too light for what lies between the nodes, and of that of the blends alone, which is too heavy. So no modes of the
  /// inside are needed: the first five frequencies of a lobe are within 1 % of the whole's (1.7 and 3 % by either
  /// alone). A shift has the whole mass in any posture; what turns far has its inertia nearly.
  Eigen::MatrixXd mass;
};
/// The energy of the whole, condensed once: each piece's points are the blends of the kept nodes, seen in its frame, and
/// what they are off these where they are in balance with all frames equal, by the strains that all pieces have in their
/// own frames. With all frames equal that is the whole. Fails (scenario) where a tetrahedron is inside out at rest.
Result<ReducedSolid> reduce(const SolidMesh& mesh, const VecX& rest, const ElasticSolid& solid);

}  // namespace calot
