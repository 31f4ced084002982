#include "sim/tool_loads.h"

#include <algorithm>

namespace calot {
namespace {

/// Adds up what acts on the tools, part by part.
class LoadSum {
 public:
  explicit LoadSum(const Field& field) : field_(field), loads_(field.tools.size()) {}

  /// Null for what is no tool's: the support.
  PartLoad* part(int shape) {
    const std::size_t tool = static_cast<std::size_t>(shape) / shapes_per_tool;
    return tool < loads_.size() ? &loads_[tool].parts[shape % shapes_per_tool] : nullptr;
  }
  void add_force(int shape, const Vec3& at, const Vec3& force) {
    ToolLoad& load = loads_[shape / shapes_per_tool];
    load.force += force;
    load.moment += (at - field_.tools[shape / shapes_per_tool].trocar).cross(force);
    PartLoad& on = *part(shape);
    on.place += force.norm() * at;
    on.carried += force.norm();
  }
  void count_touch(int shape, int organ) {
    ToolLoad& load = loads_[shape / shapes_per_tool];
    if (load.touches++ == 0) load.organ = field_.organs[organ].definition.name;
    PartLoad& on = *part(shape);
    if (on.touches++ == 0) on.organ = organ;
  }
  std::vector<ToolLoad> take() {
    for (ToolLoad& load : loads_)
      for (PartLoad& part : load.parts)
        if (part.carried > 0) part.place /= part.carried;
    return std::move(loads_);
  }

 private:
  const Field& field_;
  std::vector<ToolLoad> loads_;
};

}  // namespace

std::vector<ToolLoad> tool_loads(const Field& field) {
  LoadSum sum(field);
  const std::vector<InstrumentPose> poses = present_poses(field);
  for (int index = 0; index < static_cast<int>(field.organs.size()); ++index) {
    const Organ& organ = field.organs[index];
    const ContactLoads now = contact_loads(field, organ, poses);
    const std::vector<Touch>& touching = organ.search.touching(organ.body, organ.state.x, now);
    for (const ContactForce& contact : contact_forces(organ.body, now, touching)) {
      PartLoad* part = sum.part(contact.shape);
      if (!part) continue;
      part->contact += contact.on_shape;
      part->pressing += contact.on_shape.norm();
      sum.add_force(contact.shape, contact.at, contact.on_shape);
      sum.count_touch(contact.shape, index);
    }
    ContactPlaces places(organ.body.skin(), organ.state.x);
    for (const RubbingPoint& rubbing : now.friction.points) {
      PartLoad* part = sum.part(rubbing.shape);
      if (!part) continue;
      // The point is counted where it presses.
      const Vec3 at = places.at(rubbing.point), rub = rubbing.hold.sample(at).gradient;
      part->contact += rub;
      sum.add_force(rubbing.shape, at, rub);
    }
    for (std::size_t g = 0; g < organ.grips.size(); ++g) {
      const GripPoint& grip = organ.grips[g];
      const int shape = shapes_per_tool * grip.instrument + 1 + grip.jaw;
      const Vec3 at = organ.body.skin_point(grip.skin_point, organ.state.x);
      const Vec3 force = now.grip.stiffness[g] * (at - now.grip.target[g]);
      sum.part(shape)->grip += force;
      sum.add_force(shape, at, force);
      sum.count_touch(shape, index);
    }
  }
  return sum.take();
}

Result<bool> check_clear(const Field& field) {
  bool touches = deepest_penetration(field) > 0;
  for (const ToolLoad& load : tool_loads(field)) touches |= load.touches > 0;
  if (touches)
    return fail(FailureKind::scenario, "an instrument that waits in its trocar, 30 mm deep, touches an organ",
                "choose another port, or move the organ");
  return true;
}

double deepest_penetration(const Field& field) {
  constexpr int parts = 4;  // other points than those that are felt
  double deepest = 0;
  for (const Tool& tool : field.tools) {
    for (const Shape& shape : instrument_shapes(tool.trocar, tool.pose, tool.geometry)) {
      const Eigen::AlignedBox3d box(bounds(shape).lower, bounds(shape).upper);
      for (const Organ& organ : field.organs) {
        const std::vector<Vec3> skin = organ.body.skin_positions(organ.state.x);
        for (const Triangle& t : organ.body.skin().triangles) {
          Eigen::AlignedBox3d around;
          for (int corner : t) around.extend(skin[corner]);
          if (!around.intersects(box)) continue;
          for (int i = 0; i <= parts; ++i)
            for (int j = 0; i + j <= parts; ++j) {
              const Vec3 at = (i * skin[t[0]] + j * skin[t[1]] + (parts - i - j) * skin[t[2]]) / parts;
              deepest = std::max(deepest, -signed_distance(shape, at));
            }
        }
      }
    }
  }
  return deepest;
}

}  // namespace calot
