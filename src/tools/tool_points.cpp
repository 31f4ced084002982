#include "tools/tool_points.h"

#include <algorithm>
#include <cmath>

namespace calot {
namespace {

constexpr double rod_spacing = 0.5e-3, jaw_spacing = 1e-3;  ///< m, at most

/// Even places from `first` to `last`, no further apart than `spacing`.
std::vector<double> even_places(double first, double last, double spacing) {
  const int parts = std::max(1, static_cast<int>(std::ceil((last - first) / spacing)));
  std::vector<double> out;
  for (int k = 0; k <= parts; ++k) out.push_back(first + (last - first) * k / parts);
  return out;
}

void add_rod(int part, const Capsule& rod, std::vector<ToolPoint>& out) {
  const double length = (rod.b - rod.a).norm();
  const std::vector<double> places = even_places(0, length, rod_spacing);
  const Vec3 along = (rod.b - rod.a) / length;
  const double spacing = places[1] - places[0];
  for (double place : places)
    out.push_back({part, rod.a + place * along, rod.radius, 2 * rod.radius * spacing});
}

void add_jaw(int part, const RoundedBox& box, std::vector<ToolPoint>& out) {
  const auto along = [&](int axis) { return even_places(-box.half[axis], box.half[axis], jaw_spacing); };
  const std::vector<double> xs = along(0), ys = along(1), zs = along(2);
  const double area = (ys[1] - ys[0]) * (zs[1] - zs[0]);
  for (double x : {xs.front(), xs.back()})
    for (double y : ys)
      for (double z : zs) out.push_back({part, box.pose * Vec3(x, y, z), box.radius, area});
}

}  // namespace

std::vector<ToolPoint> tool_points(const InstrumentGeometry& geometry) {
  // With the hinge in the trocar and pointing straight, places in the hinge's frame are the world's turned back.
  InstrumentPose closed;
  closed.insertion = geometry.jaw_length;
  const Pose to_hinge = hinge_frame(Vec3::Zero(), closed, geometry).inverse();
  const std::vector<Shape> shapes = instrument_shapes(Vec3::Zero(), closed, geometry);
  std::vector<ToolPoint> out;
  for (int part = 0; part < shapes_per_tool; ++part) {
    if (const auto* rod = std::get_if<Capsule>(&shapes[part])) {
      add_rod(part, {to_hinge * rod->a, to_hinge * rod->b, rod->radius}, out);
    } else {
      RoundedBox jaw = std::get<RoundedBox>(shapes[part]);
      jaw.pose = jaw_frame(Vec3::Zero(), closed, geometry, part - 1).inverse() * jaw.pose;
      add_jaw(part, jaw, out);
    }
  }
  return out;
}

PosedTool::PosedTool(const Tool& posed, const ToolVector& q)
    : tool(posed), pose(pose_at(q)), shapes(instrument_shapes(posed.trocar, pose, posed.geometry)) {
  for (int part = 0; part < shapes_per_tool; ++part) parts.emplace_back(posed, pose, part);
}

double point_bend(const Tool& tool, const InstrumentPose& a, const InstrumentPose& b, const Vec3& p) {
  const double turn = std::abs(b.pitch - a.pitch) + std::abs(b.yaw - a.yaw) + std::abs(b.roll - a.roll) +
                      0.5 * std::abs(b.jaw - a.jaw);
  const double pushed = std::abs(b.insertion - a.insertion);
  return 0.125 * turn * (turn * ((p - tool.trocar).norm() + pushed) + 2 * pushed);
}

Eigen::AlignedBox3d box_around(const Shape& shape, double wider) {
  const Bounds b = bounds(offset(shape, wider));
  return {b.lower, b.upper};
}

}  // namespace calot
