#pragma once
// What of an instrument meets other rigid things: points fixed in its parts, each a ball.

#include <vector>

#include "tools/posed_part.h"

namespace calot {

/// A ball that a part carries.
struct ToolPoint {
  int part = 0;
  Vec3 local = Vec3::Zero();  ///< m, in the part's frame
  double radius = 0;          ///< m
  double area = 0;            ///< m^2 of the tool's shadow that it stands for
};
/// Of all parts, in their order.
std::vector<ToolPoint> tool_points(const InstrumentGeometry& geometry);

/// A tool at a pose.
struct PosedTool {
  const Tool& tool;
  InstrumentPose pose;
  std::vector<PosedPart> parts;
  std::vector<Shape> shapes;
  PosedTool(const Tool& posed, const ToolVector& q);
};

/// By how much a point p (m) that a tool carries departs from its straight way, at most, m: an eighth of what its path would
/// be bent by in a unit of time.
double point_bend(const Tool& tool, const InstrumentPose& a, const InstrumentPose& b, const Vec3& p);

/// What is within `wider` m of a shape lies in it; infinite of a plane.
Eigen::AlignedBox3d box_around(const Shape& shape, double wider);

/// Calls use(point, its place, its part) for a tool's points that come nearer than `reach` m to a shape, whose box_around()
/// by that much is `near`.
template <class Use>
void for_points_near(const PosedTool& tool, const std::vector<ToolPoint>& points, const Shape& shape,
                     const Eigen::AlignedBox3d& near, double reach, const Use& use) {
  for (std::size_t first = 0, last = 0; first < points.size(); first = last) {
    const int carrier = points[first].part;
    while (last < points.size() && points[last].part == carrier) ++last;
    if (!near.intersects(box_around(tool.shapes[carrier], 0))) continue;
    for (std::size_t k = first; k < last; ++k) {
      const Vec3 at = tool.parts[carrier].frame() * points[k].local;
      if (signed_distance(shape, at) - points[k].radius < reach) use(points[k], at, tool.parts[carrier]);
    }
  }
}

}  // namespace calot
