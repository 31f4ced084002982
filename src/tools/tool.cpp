#include "tools/tool.h"

#include <algorithm>
#include <cmath>

namespace calot {

std::vector<Shape> shapes_in_field(const Tool& tool, const InstrumentPose& pose) {
  if (tool.waits) return std::vector<Shape>(shapes_per_tool, nowhere);
  return instrument_shapes(tool.trocar, pose, tool.geometry);
}

std::array<Pose, 2> to_jaws(const Tool& tool) {
  return {jaw_frame(tool.trocar, tool.pose, tool.geometry, 0).inverse(),
          jaw_frame(tool.trocar, tool.pose, tool.geometry, 1).inverse()};
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
