#include "acts/pads.h"

#include <algorithm>

#include "field/grip.h"
#include "field/teeth.h"
#include "motion/rubbing.h"
#include "motion/tool_loads.h"

namespace calot {

double pressed_apart(const Field& field, ToolIndex instrument) {
  const Tool& tool = field.tool(instrument);
  const ToolLoad load = tool_loads(field)[instrument.value];
  double sum = 0;
  for (int jaw : {0, 1})
    sum += load.on_jaws[static_cast<std::size_t>(jaw)].dot(
        jaw_frame(tool.trocar, tool.pose, tool.geometry, jaw).linear().col(0));
  return 0.5 * sum;
}

std::optional<Clasped> clasped(const Field& field, ToolIndex instrument) {
  const Tool& tool = field.tool(instrument);
  if (!has_teeth(tool)) return std::nullopt;
  const std::array<Pose, 2> to_jaw = to_jaws(tool);
  const std::vector<InstrumentPose> poses = present_poses(field);
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    const Organ& organ = field.organs[k];
    if (is_bitten(organ)) continue;
    Clasped out;
    out.organ = OrganIndex(k);
    ContactPlaces places(organ.body->skin(), organ.state.x);
    for (const RubbingPoint& rubbing : friction_load(field, organ, poses).points) {
      const FieldShape which = field.shape(rubbing.shape);
      if (which.tool != instrument || which.is_shaft()) continue;
      const auto jaw = static_cast<std::size_t>(which.jaw());
      const Vec3 at = places.at(rubbing.point), normal = to_jaw[jaw].linear() * rubbing.hold.normal;
      const double teeth = teeth_share(to_jaw[jaw] * at, normal, tool.geometry);
      if (teeth == 0) continue;
      const double friction =
          tool.definition.friction + teeth * (tool.definition.pad_friction - tool.definition.friction);
      out.pressed[jaw] -= normal.x() * rubbing.hold.limit / friction;
      out.area[jaw] += organ.body->contact_area(rubbing.point);
      out.along[jaw] += rubbing.hold.sample(at).gradient;
    }
    if (out.pressed[0] > 0 && out.pressed[1] > 0) return out;
  }
  return std::nullopt;
}

double pad_pressure(const Field& field, ToolIndex instrument) {
  const Tool& tool = field.tool(instrument);
  if (!tool.jaw_stopped) return 0;
  const std::optional<Clasped> rubbed = clasped(field, instrument);
  const double area = rubbed ? std::min(rubbed->area[0], rubbed->area[1]) : held_area(field, instrument);
  return area > 0 ? tool.definition.pinch_force / area : 0.0;
}

std::string between_pads(const Field& field, ToolIndex instrument) {
  const std::string bitten = held_organ(field, instrument);
  if (!bitten.empty() && both_pads_hold(field, instrument)) return bitten;
  const std::optional<Clasped> rubbed = clasped(field, instrument);
  return rubbed ? field.organ(rubbed->organ).definition.name : std::string();
}

}  // namespace calot
