#include "motion/rubbing.h"

#include <algorithm>

#include "field/teeth.h"

namespace calot {
namespace {

/// The frame that a shape's anchors are kept in; the ground's is the world's.
Pose shape_frame(const Field& field, const std::vector<InstrumentPose>& poses, int shape) {
  const FieldShape which = field.shape(shape);
  if (which.is_ground()) return Pose::Identity();
  return part_frame(field.tool(which.tool), poses[which.tool.value], which.part);
}

std::vector<Pose> shape_frames(const Field& field, const std::vector<InstrumentPose>& poses) {
  std::vector<Pose> frames;
  const int shapes = FieldShape::of_ground(static_cast<int>(field.ground.size())).index(field.tools.size());
  for (int shape = 0; shape < shapes; ++shape) frames.push_back(shape_frame(field, poses, shape));
  return frames;
}

/// At a place of a shape and by its normal there, both in the shape's frame.
double coefficient(const Field& field, const Organ& organ, int shape, const Vec3& at, const Vec3& normal) {
  const FieldShape which = field.shape(shape);
  if (which.is_ground()) return field.ground[which.ground].friction;
  const Tool& tool = field.tool(which.tool);
  const double smooth = tool.definition.friction;
  if (which.is_shaft() || is_bitten(organ) || !has_teeth(tool)) return smooth;
  return smooth + teeth_share(at, normal, tool.geometry) * (tool.definition.pad_friction - smooth);
}

/// Whether each tool's jaws hold a part of the organ.
std::vector<bool> holding_tools(const Field& field, const Organ& organ) {
  std::vector<bool> out(field.tools.size(), false);
  for (const GripPoint& grip : organ.grips) out[grip.instrument.value] = true;
  return out;
}

bool is_holding_jaw(const std::vector<bool>& holding, int shape) {
  const FieldShape which = FieldShape::at(shape, holding.size());
  return !which.is_ground() && !which.is_shaft() && holding[which.tool.value];
}

/// Sum of the changes of the points' limits along their normals, over the sum of the limits.
double change(const FrictionLoad& from, const FrictionLoad& to) {
  double changed = 0, sum = 0;
  for (const RubbingPoint& rubbing : to.points) {
    Vec3 force = rubbing.hold.limit * rubbing.hold.normal;
    sum += rubbing.hold.limit;
    if (const RubbingPoint* old = from.find(rubbing.shape, rubbing.point))
      force -= old->hold.limit * old->hold.normal;
    changed += force.norm();
  }
  for (const RubbingPoint& rubbing : from.points)
    if (!to.find(rubbing.shape, rubbing.point)) changed += rubbing.hold.limit;
  return changed / std::max(sum, least_friction);
}

}  // namespace

bool has_friction(const Field& field) {
  if (field.group.friction > 0 && field.organs.size() > 1) return true;
  if (std::any_of(field.ground.begin(), field.ground.end(),
                  [](const Ground& ground) { return ground.friction > 0; }))
    return true;
  return std::any_of(field.tools.begin(), field.tools.end(),
                     [](const Tool& tool) { return tool.definition.friction > 0; }) ||
         (std::any_of(field.tools.begin(), field.tools.end(), has_teeth) &&
          !std::all_of(field.organs.begin(), field.organs.end(), is_bitten));
}

FrictionLoad friction_load(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses) {
  FrictionLoad out;
  if (organ.friction.points.empty()) return out;
  const std::vector<Pose> frames = shape_frames(field, poses);
  const std::vector<bool> holding = holding_tools(field, organ);
  for (const RubbingPoint& rubbing : organ.friction.points)
    if (!is_holding_jaw(holding, rubbing.shape))
      out.points.push_back({rubbing.point, rubbing.shape, rubbing.hold.carried(frames[rubbing.shape])});
  return out;
}

double renew_friction(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                      const VecX& before, double share, ContactLoads& around) {
  const std::vector<Pose> frames = shape_frames(field, poses);
  const std::vector<bool> holding = holding_tools(field, organ);
  const std::vector<Pose> frames_before = shape_frames(field, present_poses(field));
  FrictionLoad now;
  ContactPlaces places_before(organ.body->skin(), before);
  for (const auto& [point, shape, at, d, answer, area, radius] :
       organ.search.touching(*organ.body, organ.state.x, around)) {
    if (is_holding_jaw(holding, shape)) continue;
    const Pose to_shape = frames[shape].inverse();
    const double mu = coefficient(field, organ, shape, to_shape * at, to_shape.linear() * d.gradient);
    if (mu <= 0) continue;
    StickSlip hold;
    hold.normal = d.gradient;
    hold.limit = -mu * area * answer.derivative;
    hold.stiffness = stick_stiffness * area;
    const RubbingPoint* old = organ.friction.find(shape, point);
    hold.anchor =
        frames[shape] * (old ? old->hold.anchor : frames_before[shape].inverse() * places_before.at(point));
    now.points.push_back({point, shape, hold});
  }
  const double changed = change(around.friction, now);
  for (RubbingPoint& rubbing : now.points) {
    const RubbingPoint* old = around.friction.find(rubbing.shape, rubbing.point);
    const double limit = old ? old->hold.limit : 0.0;
    rubbing.hold.limit = limit + share * (rubbing.hold.limit - limit);
  }
  around.friction = std::move(now);
  return changed;
}

void keep_friction(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                   const FrictionLoad& friction) {
  const std::vector<Pose> frames = shape_frames(field, poses);
  ContactPlaces places(organ.body->skin(), organ.state.x);
  organ.friction.points.clear();
  for (RubbingPoint rubbing : friction.points) {
    rubbing.hold.anchor = rubbing.hold.anchor_after(places.at(rubbing.point));
    rubbing.hold = rubbing.hold.carried(frames[rubbing.shape].inverse());
    organ.friction.points.push_back(rubbing);
  }
}

}  // namespace calot
