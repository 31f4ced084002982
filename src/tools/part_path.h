#pragma once
// How far the parts of a tool may move before they meet points and lines that move meanwhile.

#include "tools/tool.h"

namespace calot {

/// The motion of a tool's part (0 shaft, 1 and 2 the jaws) from one pose to another, beside many points. The tool must outlive it.
class PartPath {
 public:
  PartPath(const Tool& tool, int part, const InstrumentPose& from, const InstrumentPose& to);
  /// Share [0 to 1] of the joint motion of a point (x to x + motion, m) and the part (`shape`, where it begins) that
  /// keeps them further apart than `keep` times their present distance. Judged in the part's own frame, where a point
  /// that is carried along hardly moves; the path's departure from a straight line there is bounded by the turn squared
  /// and taken off the distance. 0 where the point is inside already.
  double share_apart(const Shape& shape, const Vec3& x, const Vec3& motion, double keep) const;
  /// The same of a straight piece between two points.
  double share_apart(const Shape& shape, const StrandPiece& piece, const StrandPiece& motion,
                     double keep) const;
  /// Bound on how far the point goes seen from the part, m: convex in x and motion, so that no point of a triangle goes
  /// further than its corners may.
  double way(const Vec3& x, const Vec3& motion) const;

 private:
  const Tool& tool_;
  int part_;
  InstrumentPose from_, to_;
  double travel_;  ///< m, bound on the part's
  Pose back_;      ///< from the part's frame at the end to that at the start
};

}  // namespace calot
