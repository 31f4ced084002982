#pragma once
// A solid of tetrahedra, condensed onto few nodes once and for all: statics of what is free (the paper's
// groupstructure), and pieces that turn on their own.

#include "base/status.h"
#include "fem/framed_solid.h"
#include "fem/tetrahedron.h"

namespace calot {

struct SolidMesh {
  std::vector<QuadraticTet> tets;
  /// Each point as a blend of the kept nodes at rest, which gives affine motions of these exactly.
  StencilTable rows;
  std::vector<char> free;     ///< one a point: it finds its own balance, else it keeps its row
  std::vector<int> piece_of;  ///< one a tetrahedron, from 0 on
  int nodes = 0;              ///< kept
};

/// What a piece's frame turns against, times its shear modulus and volume (FramedSolid::Piece::turning): the angle by
/// which it misses the polar decomposition's is a fortieth of the square of the strain.
inline constexpr double frame_turning = 40;

/// The energy of the whole, whose free points are where they are in balance with all frames equal, shared out among the
/// pieces by what is in each: with all frames equal the pieces are the whole, condensed. Fails (scenario) where a
/// tetrahedron is inside out at rest.
Result<std::vector<FramedSolid::Piece>> reduce(const SolidMesh& mesh, const VecX& rest,
                                               const ElasticSolid& solid);

}  // namespace calot
