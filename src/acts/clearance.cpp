#include "acts/clearance.h"

#include <algorithm>
#include <limits>

#include "body/skin_bounds.h"
#include "group/contact_search.h"

namespace calot {
namespace {

/// Whether a body's surface may be nearer than `reach` (m) to one of some shapes, by boxes around both.
bool may_reach(const Body& body, const VecX& x, const std::vector<Shape>& shapes, double reach) {
  Eigen::AlignedBox3d box = skin_box(body, x);
  const Vec3 wider = Vec3::Constant(reach + body.thickest());
  box.min() -= wider;
  box.max() += wider;
  return std::any_of(shapes.begin(), shapes.end(), [&](const Shape& shape) {
    const Bounds around = bounds(shape);
    return box.intersects(Eigen::AlignedBox3d(around.lower, around.upper));
  });
}

/// On a triangle (columns, m) that carries a surface of such radii (m) around its corners. The distance is convex along it:
/// steps from corner to corner that only go down end where it is least. Negative inside.
Clearance nearest_on_triangle(const Shape& shape, const Mat3& corners, const Vec3& radii) {
  constexpr double finest = 1e-3;  // of an edge
  const auto distance = [&](const Vec3& weights) {
    return signed_distance(shape, corners * weights) - radii.dot(weights);
  };
  Vec3 weights = Vec3::Constant(1.0 / 3);
  double least = distance(weights);
  for (double step = 1.0 / 3; step > finest;) {
    bool lower = false;
    for (int way = 0; way < 6; ++way) {
      Vec3 next = weights;
      const int from = way / 2, to = (from + 1 + way % 2) % 3;
      const double moved = std::min(step, weights[from]);
      next[from] -= moved;
      next[to] += moved;
      if (const double there = distance(next); there < least) {
        weights = next;
        least = there;
        lower = true;
      }
    }
    if (!lower) step *= 0.5;
  }
  const Vec3 at = corners * weights;
  return {least, at - radii.dot(weights) * distance_slope(shape, at).gradient};
}

/// From a place to the nearest of some shapes, m.
double distance_to(const std::vector<Shape>& shapes, const Vec3& place) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Shape& shape : shapes) nearest = std::min(nearest, signed_distance(shape, place));
  return nearest;
}

/// The nearest of its skin points, which is never nearer than its surface.
Clearance clearance_of_points(const std::vector<Shape>& shapes, const Organ& organ) {
  const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
  const std::vector<double>& radii = organ.body->skin_radii();
  Clearance nearest{std::numeric_limits<double>::infinity()};
  for (std::size_t p = 0; p < skin.size(); ++p) {
    const double distance = distance_to(shapes, skin[p]) - (radii.empty() ? 0.0 : radii[p]);
    if (distance < nearest.distance) nearest = {distance, skin[p]};
  }
  nearest.distance = std::max(0.0, nearest.distance);
  return nearest;
}

}  // namespace

std::vector<Shape> working_shapes(const Tool& tool) {
  const std::vector<Shape> all = instrument_shapes(tool.trocar, tool.pose, tool.geometry);
  std::vector<Shape> out;
  for (int part = 0; part < shapes_per_tool; ++part)
    if (conducts(tool.geometry, part)) out.push_back(all[static_cast<std::size_t>(part)]);
  return out;
}

std::optional<Clearance> clearance_within(const std::vector<Shape>& shapes, const Organ& organ,
                                          double within) {
  const Body& body = *organ.body;
  const VecX& x = organ.state.x;
  if (!may_reach(body, x, shapes, within)) return std::nullopt;
  ContactLoads near;
  near.shapes = shapes;
  near.barrier.range = within;
  const std::vector<double>& radii = body.skin_radii();
  ContactPlaces places(body.skin(), x, radii);
  Clearance nearest{within};
  bool found = false;
  for (const ContactPair& pair : gather_pairs(body, x, near, -contact_margin)) {
    if (pair.distance >= nearest.distance) continue;
    const Triangle& t = body.skin().triangles[pair.triangle];
    const Vec3 around = radii.empty() ? Vec3::Zero().eval() : Vec3(radii[t[0]], radii[t[1]], radii[t[2]]);
    const Clearance there = nearest_on_triangle(shapes[pair.shape], places.corners(pair.triangle), around);
    if (there.distance >= nearest.distance) continue;
    nearest = there;
    found = true;
  }
  if (!found) return std::nullopt;
  nearest.distance = std::max(0.0, nearest.distance);
  return nearest;
}

Clearance clearance(const std::vector<Shape>& shapes, const Organ& organ) {
  const Clearance of_points = clearance_of_points(shapes, organ);
  return clearance_within(shapes, organ, of_points.distance).value_or(of_points);
}

Clearance clearance(const Tool& tool, const Organ& organ) { return clearance(working_shapes(tool), organ); }

}  // namespace calot
