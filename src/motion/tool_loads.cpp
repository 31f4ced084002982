#include "motion/tool_loads.h"

#include <fmt/format.h>

#include <algorithm>

#include "field/field_tissues.h"
#include "motion/settle_field.h"

namespace calot {
namespace {

/// Adds up what acts on the tools, part by part.
class LoadSum {
 public:
  explicit LoadSum(const Field& field) : field_(field), loads_(field.tools.size()) {
    for (const Tool& tool : field.tools) tips_.push_back(tip_position(tool.trocar, tool.pose, tool.geometry));
  }

  /// A force (N) at a point (m) of a shape; the ground's are left out. `touches`: the point counts, with its organ.
  void add(const FieldShape& shape, const Vec3& at, const Vec3& force, bool touches,
           const std::string& organ) {
    if (shape.is_ground()) return;
    const Tool& tool = field_.tool(shape.tool);
    ToolLoad& load = loads_[shape.tool.value];
    load.force += force;
    load.moment += (at - tool.trocar).cross(force);
    if (touches && load.touches++ == 0) load.organ = organ;
    if (!shape.is_shaft()) load.on_jaws[shape.jaw()] += force;
    add_load(tool, tips_[shape.tool.value], shape.is_shaft(), at, force, touches, organ, load.parts);
  }
  std::vector<ToolLoad> take() { return std::move(loads_); }

 private:
  const Field& field_;
  std::vector<Vec3> tips_;  ///< of the tools, m
  std::vector<ToolLoad> loads_;
};

}  // namespace

void add_load(const Tool& tool, const Vec3& tip, bool on_shaft, const Vec3& at, const Vec3& force,
              bool touches, const std::string& organ, PartLoads& parts) {
  const auto add = [&](ToolPart which) {
    PartLoad& part = parts[static_cast<std::size_t>(which)];
    part.force += force;
    if (!touches) return;
    if (part.touches++ > 0 && force.norm() <= part.largest) return;
    part.at = at;
    part.largest = force.norm();
    part.organ = organ;
  };
  add(on_shaft ? ToolPart::shaft : ToolPart::jaws);
  if (!on_shaft && (tip - tool.trocar).normalized().dot(tip - at) <= tip_length) add(ToolPart::tip);
}

std::vector<ToolLoad> tool_loads(const Field& field) {
  LoadSum sum(field);
  const std::vector<InstrumentPose> poses = present_poses(field);
  for (const Organ& organ : field.organs) {
    const std::string& name = organ.definition.name;
    const ContactLoads now = contact_loads(field, organ, poses);
    const std::vector<Touch>& touching = organ.search.touching(*organ.body, organ.state.x, now);
    for (const ContactForce& contact : contact_forces(touching))
      sum.add(field.shape(contact.shape), contact.at, contact.on_shape, true, name);
    ContactPlaces places(organ.body->skin(), organ.state.x);
    for (const RubbingPoint& rubbing : now.friction.points) {
      // The point is counted where it presses.
      const Vec3 at = places.at(rubbing.point);
      sum.add(field.shape(rubbing.shape), at, rubbing.hold.sample(at).gradient, false, name);
    }
    for (std::size_t g = 0; g < organ.grips.size(); ++g) {
      const GripPoint& grip = organ.grips[g];
      const Vec3 at = organ.body->skin_point(grip.skin_point, organ.state.x);
      sum.add(FieldShape::of_jaw(grip.instrument, grip.jaw), at, now.grip.sample(g, at).gradient, true, name);
    }
  }
  if (field.tissues.empty()) return sum.take();
  const VecX x = place_strands_and_tools(field);
  for (const Tissue& tissue : field.tissues)
    tissue.strands->for_contacts(x, [&](std::size_t, const StrandContact& contact) {
      sum.add(field.shape(contact.shape), contact.at, contact.force_on_shape(), true, tissue.definition.name);
    });
  return sum.take();
}

Result<bool> check_clear(const Field& field) {
  const std::vector<ToolLoad> loads = tool_loads(field);
  const auto touches =
      std::find_if(loads.begin(), loads.end(), [](const ToolLoad& l) { return l.touches > 0; });
  if (touches == loads.end() && deepest_penetration(field) <= 0) return true;
  const bool strands = touches != loads.end() &&
                       std::none_of(field.organs.begin(), field.organs.end(), [&](const Organ& organ) {
                         return organ.definition.name == touches->organ;
                       });
  const std::string name =
      touches == loads.end() ? std::string() : field.tools[touches - loads.begin()].definition.name;
  return fail(FailureKind::scenario,
              fmt::format("{} that waits in its trocar, 30 mm deep, touches {}",
                          name.empty() ? "an instrument" : fmt::format("instrument '{}'", name),
                          strands ? fmt::format("strands of '{}'", touches->organ) : "an organ"),
              "choose another port, or move the organ",
              {"", 0, name.empty() ? "scene.instruments" : fmt::format("scene.instruments.{}.port", name)});
}

double deepest_penetration(const Field& field, const Tool& tool) {
  constexpr int parts = 4;  // other points than those that are felt
  double deepest = 0;
  for (const Shape& shape : instrument_shapes(tool.trocar, tool.pose, tool.geometry)) {
    const Eigen::AlignedBox3d box(bounds(shape).lower, bounds(shape).upper);
    for (const Organ& organ : field.organs) {
      const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
      for (const Triangle& t : organ.body->skin().triangles) {
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
  return deepest;
}

double deepest_penetration(const Field& field) {
  double deepest = 0;
  for (const Tool& tool : field.tools) deepest = std::max(deepest, deepest_penetration(field, tool));
  return deepest;
}

bool touches_nothing(const Field& field, ToolIndex instrument) {
  return tool_loads(field)[instrument.value].touches == 0 &&
         deepest_penetration(field, field.tool(instrument)) <= 0;
}

}  // namespace calot
