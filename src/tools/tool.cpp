#include "tools/tool.h"

#include <algorithm>
#include <cmath>

#include "collision/barrier.h"

namespace calot {

std::vector<Shape> shapes_in_field(const Tool& tool, const InstrumentPose& pose) {
  if (tool.waits) return std::vector<Shape>(shapes_per_tool, nowhere);
  return instrument_shapes(tool.trocar, pose, tool.geometry);
}

InstrumentPose interpolate(const InstrumentPose& a, const InstrumentPose& b, double share) {
  if (share >= 1.0) return b;
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  return {mix(a.pitch, b.pitch), mix(a.yaw, b.yaw), mix(a.insertion, b.insertion), mix(a.roll, b.roll),
          mix(a.jaw, b.jaw)};
}

std::vector<InstrumentPose> interpolate(const std::vector<InstrumentPose>& a,
                                        const std::vector<InstrumentPose>& b, double share) {
  std::vector<InstrumentPose> out;
  for (std::size_t i = 0; i < a.size(); ++i) out.push_back(interpolate(a[i], b[i], share));
  return out;
}

Pose part_frame(const Tool& tool, const InstrumentPose& pose, int part) {
  return part == 0 ? hinge_frame(tool.trocar, pose, tool.geometry)
                   : jaw_frame(tool.trocar, pose, tool.geometry, part - 1);
}

Pose part_motion(const Tool& tool, const InstrumentPose& from, const InstrumentPose& to, int part) {
  return part_frame(tool, to, part) * part_frame(tool, from, part).inverse();
}

double travel_bound(const Tool& tool, const InstrumentPose& a, const InstrumentPose& b) {
  const double width = std::max(tool.geometry.jaw_width, 2 * tool.geometry.shaft_radius);
  const double reach = std::max(a.insertion, b.insertion) + width;
  const double jaws = tool.geometry.jaw_length + width;
  return std::abs(b.insertion - a.insertion) +
         reach * (std::abs(b.pitch - a.pitch) + std::abs(b.yaw - a.yaw)) +
         jaws * (0.5 * std::abs(b.jaw - a.jaw) + std::abs(b.roll - a.roll));
}

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

std::vector<double> closing_stops(const InstrumentPose& from, const InstrumentPose& to, double grid) {
  std::vector<double> stops;
  const double change = to.jaw - from.jaw;
  if (!(change < 0)) return stops;
  constexpr double slack = 1e-9;  // of the grid: an angle that a step ends on is that step's, not the next's
  for (double k = std::ceil(from.jaw / grid - slack) - 1; k >= to.jaw / grid - slack; --k)
    stops.push_back(std::min(1.0, (k * grid - from.jaw) / change));
  return stops;
}

}  // namespace calot
