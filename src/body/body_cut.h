#pragma once
// How a body is divided: at one of its skin points, into two that move on as it did.

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "geometry/types.h"

namespace calot {

class Body;

/// What of a body lies on one side of a cut.
struct BodyPiece {
  std::shared_ptr<const Body> body;
  /// Which of the piece's skin points each of the whole's is, and which of its triangles; -1: none.
  std::vector<int> points, triangles;
  /// Places or velocities of its nodes, 3 a node, for which it moves as the whole with its nodes at x does there.
  std::function<VecX(const VecX& x)> nodes;
  double begins = 0;  ///< m along the whole at rest, from its start
  double share = 0;   ///< of the whole's length at rest
};

struct BodyCut {
  int point = 0;                      ///< the whole's skin point there; both pieces have it
  double share = 0;                   ///< of the whole's length at rest, from its start
  bool open = false;                  ///< what the body carries can leave it there
  std::array<BodyPiece, 2> pieces{};  ///< the start's first

  /// The piece that a skin point of the whole is on: that at the cut on the first.
  int side_of(int skin_point) const { return pieces[0].points[skin_point] < 0 ? 1 : 0; }
};

}  // namespace calot
