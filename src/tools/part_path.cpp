#include "tools/part_path.h"

#include <algorithm>
#include <cmath>

#include "collision/barrier.h"

namespace calot {
namespace {

/// Chord error of a path of unit duration is at most an eighth of its largest acceleration: turning about the
/// trocar (lever rho) and the hinge, and turning while moving.
double path_bend(const Tool& tool, const InstrumentPose& a, const InstrumentPose& b, const Vec3& x,
                 double moved) {
  const double turn = std::abs(b.pitch - a.pitch) + std::abs(b.yaw - a.yaw) + std::abs(b.roll - a.roll) +
                      0.5 * std::abs(b.jaw - a.jaw);
  const double lever = (x - tool.trocar).norm() + moved;
  return 0.125 * turn * (turn * lever + 2.0 * (moved + std::abs(b.insertion - a.insertion)));
}

}  // namespace

PartPath::PartPath(const Tool& tool, int part, const InstrumentPose& from, const InstrumentPose& to)
    : tool_(tool),
      part_(part),
      from_(from),
      to_(to),
      travel_(travel_bound(tool, from, to)),
      back_(part_motion(tool, from, to, part).inverse()) {}

double PartPath::way(const Vec3& x, const Vec3& motion) const {
  return (back_ * (x + motion) - x).norm() + path_bend(tool_, from_, to_, x, motion.norm());
}

double PartPath::share_apart(const Shape& shape, const Vec3& x, const Vec3& motion, double keep) const {
  const double gap = signed_distance(shape, x);
  if (gap <= 0) return 0;
  if ((1.0 - keep) * gap > travel_ + motion.norm()) return 1.0;
  const double bend = path_bend(tool_, from_, to_, x, motion.norm());
  if (bend > 0.25 * gap) {
    // It falls with the square of the share, so few halvings make it small beside the gap.
    const PartPath half(tool_, part_, from_, interpolate(from_, to_, 0.5));
    return 0.5 * half.share_apart(shape, x, 0.5 * motion, keep);
  }
  const Vec3 path = back_ * (x + motion) - x;
  if (path.norm() + bend < (1.0 - keep) * gap) return 1.0;
  return safe_share(x, path, offset(shape, bend), keep);
}

double PartPath::share_apart(const Shape& shape, const StrandPiece& piece, const StrandPiece& motion,
                             double keep) const {
  const double gap = nearest_on_piece(shape, piece).slope.distance;
  if (gap <= 0) return 0;
  double bend = 0;
  StrandPiece path, half_motion;
  for (std::size_t end = 0; end < 2; ++end) {
    path[end] = back_ * (piece[end] + motion[end]) - piece[end];
    half_motion[end] = 0.5 * motion[end];
    bend = std::max(bend, path_bend(tool_, from_, to_, piece[end], motion[end].norm()));
  }
  if (bend > 0.25 * gap) {
    const PartPath half(tool_, part_, from_, interpolate(from_, to_, 0.5));
    return 0.5 * half.share_apart(shape, piece, half_motion, keep);
  }
  return safe_share(piece, path, offset(shape, bend), keep);
}

}  // namespace calot
