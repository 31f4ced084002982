#include "sim/rubbing.h"

#include <algorithm>
#include <tuple>

namespace calot {
namespace {

/// The frame that a shape's anchors are kept in; the support's is the world's.
Pose shape_frame(const Field& field, const std::vector<InstrumentPose>& poses, int shape) {
  const std::size_t tool = static_cast<std::size_t>(shape) / shapes_per_tool;
  if (tool >= field.tools.size()) return Pose::Identity();
  return part_frame(field.tools[tool], poses[tool], shape % shapes_per_tool);
}

std::vector<Pose> shape_frames(const Field& field, const std::vector<InstrumentPose>& poses) {
  std::vector<Pose> frames;
  const int shapes = static_cast<int>(field.tools.size()) * shapes_per_tool + 1;
  for (int shape = 0; shape < shapes; ++shape) frames.push_back(shape_frame(field, poses, shape));
  return frames;
}

double coefficient(const Field& field, int shape) {
  const std::size_t tool = static_cast<std::size_t>(shape) / shapes_per_tool;
  return tool < field.tools.size() ? field.tools[tool].definition.friction : field.support_friction;
}

/// Whether each tool's jaws hold a part of the organ.
std::vector<bool> holding_tools(const Field& field, const Organ& organ) {
  std::vector<bool> out(field.tools.size() + 1, false);  // the last is the support
  for (const GripPoint& grip : organ.grips) out[grip.instrument] = true;
  return out;
}

bool is_holding_jaw(const std::vector<bool>& holding, int shape) {
  return holding[shape / shapes_per_tool] && shape % shapes_per_tool > 0;
}

/// Sum of the changes of the points' limits along their normals, over the sum of the limits.
double change(const FrictionLoad& from, const FrictionLoad& to) {
  double changed = 0, sum = 0;
  for (const RubbingPoint& point : to.points) {
    Vec3 force = point.hold.limit * point.hold.normal;
    sum += point.hold.limit;
    if (const RubbingPoint* old = from.find(point.shape, point.row))
      force -= old->hold.limit * old->hold.normal;
    changed += force.norm();
  }
  for (const RubbingPoint& point : from.points)
    if (!to.find(point.shape, point.row)) changed += point.hold.limit;
  return changed / std::max(sum, least_friction);
}

}  // namespace

bool has_friction(const Field& field) {
  if (field.support && field.support_friction > 0) return true;
  return std::any_of(field.tools.begin(), field.tools.end(),
                     [](const Tool& tool) { return tool.definition.friction > 0; });
}

FrictionLoad friction_load(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses) {
  FrictionLoad out;
  if (organ.friction.points.empty()) return out;
  const std::vector<Pose> frames = shape_frames(field, poses);
  const std::vector<bool> holding = holding_tools(field, organ);
  for (const RubbingPoint& point : organ.friction.points)
    if (!is_holding_jaw(holding, point.shape))
      out.points.push_back({point.row, point.shape, point.hold.carried(frames[point.shape])});
  return out;
}

double renew_friction(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                      const VecX& before, double share, Surroundings& around) {
  const std::vector<Pose> frames = shape_frames(field, poses);
  const std::vector<bool> holding = holding_tools(field, organ);
  const std::vector<InstrumentPose> from = present_poses(field);
  FrictionLoad now;
  for (const ContactPair& pair : organ.search.pairs(organ.body, organ.state.x, around, 0.0)) {
    const double mu = coefficient(field, pair.shape);
    if (pair.distance >= around.barrier.range || mu <= 0 || is_holding_jaw(holding, pair.shape)) continue;
    const double area = organ.body.contact_areas()[pair.row];
    const DistanceSample d =
        sample_distance(around.shapes[pair.shape], organ.body.contact_point(pair.row, organ.state.x));
    StickSlip hold;
    hold.normal = d.gradient;
    hold.limit = -mu * area * around.barrier.sample(d.distance).derivative;
    hold.stiffness = stick_stiffness * area;
    const RubbingPoint* old = organ.friction.find(pair.shape, pair.row);
    hold.anchor = frames[pair.shape] * (old ? old->hold.anchor
                                            : shape_frame(field, from, pair.shape).inverse() *
                                                  organ.body.contact_point(pair.row, before));
    now.points.push_back({pair.row, pair.shape, hold});
  }
  std::sort(now.points.begin(), now.points.end(), [](const RubbingPoint& a, const RubbingPoint& b) {
    return std::tie(a.shape, a.row) < std::tie(b.shape, b.row);
  });
  const double changed = change(around.friction, now);
  for (RubbingPoint& point : now.points) {
    const RubbingPoint* old = around.friction.find(point.shape, point.row);
    const double limit = old ? old->hold.limit : 0.0;
    point.hold.limit = limit + share * (point.hold.limit - limit);
  }
  around.friction = std::move(now);
  return changed;
}

void keep_friction(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                   const FrictionLoad& friction) {
  const std::vector<Pose> frames = shape_frames(field, poses);
  organ.friction.points.clear();
  for (RubbingPoint point : friction.points) {
    point.hold.anchor = point.hold.anchor_after(organ.body.contact_point(point.row, organ.state.x));
    point.hold = point.hold.carried(frames[point.shape].inverse());
    organ.friction.points.push_back(point);
  }
}

}  // namespace calot
