#include "field/grip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "body/rod_body.h"
#include "field/between_jaws.h"

namespace calot {

int grip_count(const Organ& organ, ToolIndex instrument) {
  return static_cast<int>(std::count_if(organ.grips.begin(), organ.grips.end(),
                                        [&](const GripPoint& g) { return g.instrument == instrument; }));
}

double held_area(const Field& field, ToolIndex instrument) {
  std::array<double, 2> area{};
  for (const Organ& organ : field.organs) {
    if (!clips_between(field, instrument, organ).empty()) continue;
    const RodBody* rod = organ.body->as_tube();
    for (const GripPoint& grip : organ.grips) {
      if (grip.instrument != instrument) continue;
      double own = organ.body->skin_areas()[grip.skin_point];
      // A rod's areas are its lengths times its radius.
      if (rod != nullptr) own *= rod->flat_width(grip.skin_point) / rod->outer_radius(grip.skin_point);
      area[grip.jaw] += own;
    }
  }
  return std::min(area[0], area[1]);
}

std::string held_organ(const Field& field, ToolIndex instrument) {
  for (const Organ& organ : field.organs)
    if (grip_count(organ, instrument) > 0) return organ.definition.name;
  return {};
}

bool both_pads_hold(const Organ& organ, ToolIndex instrument) {
  bool holds[2] = {false, false};
  for (const GripPoint& grip : organ.grips)
    if (grip.instrument == instrument && !grip.leaves) holds[grip.jaw] = true;
  return holds[0] && holds[1];
}

bool both_pads_hold(const Field& field, ToolIndex instrument) {
  return std::any_of(field.organs.begin(), field.organs.end(),
                     [&](const Organ& organ) { return both_pads_hold(organ, instrument); });
}

namespace {

/// Half the height of a tube pressed flat, m: of the thickest place that a tool holds, or of a clip on it.
double flat_radius(const Field& field, ToolIndex instrument, const Organ& organ) {
  double thickest = 0;
  for (const GripPoint& grip : organ.grips)
    if (grip.instrument == instrument)
      thickest = std::max(thickest, organ.body->core_radii()[static_cast<std::size_t>(grip.skin_point)]);
  // Skins are felt that far inside the pads, clips are not.
  for (const ClipBetween& clip : clips_between(field, instrument, organ))
    thickest = std::max(thickest, clip.half_height + contact_inset);
  return thickest;
}

}  // namespace

bool fold_fills_jaws(const Field& field, ToolIndex instrument) {
  constexpr double fold_squeeze =
      0.6;  // share of their thickness to which two walls are squeezed between the pads
  const Tool& tool = field.tool(instrument);
  for (const Organ& organ : field.organs) {
    int count[2] = {0, 0};
    double depth = 0;  // along the jaws
    for (const GripPoint& grip : organ.grips) {
      if (grip.instrument != instrument) continue;
      ++count[grip.jaw];
      depth += grip.local.z();
    }
    if (count[0] == 0 || count[1] == 0 || !organ.body->is_bitten()) continue;
    const double reach = 2.0 * depth / (count[0] + count[1]);
    if (organ.body->is_line()) {
      // A tube is pressed flat where the next angle leaves it no room.
      const double next = reach * std::sin(0.5 * std::max(0.0, tool.pose.jaw - grip_grid));
      if (next + 2 * contact_inset <= 2 * flat_radius(field, instrument, organ)) return true;
      continue;
    }
    if (reach * std::sin(0.5 * tool.pose.jaw) <= fold_squeeze * 2.0 * organ.definition.wall.thickness)
      return true;
  }
  return false;
}

GripSprings grip_springs(const Organ& organ, const std::vector<Tool>& tools,
                         const std::vector<InstrumentPose>& poses) {
  GripSprings springs;
  Pose jaw = Pose::Identity();
  const GripPoint* last = nullptr;  // those of one jaw follow each other
  for (const GripPoint& grip : organ.grips) {
    const Tool& tool = tools[grip.instrument.value];
    if (!last || last->instrument != grip.instrument || last->jaw != grip.jaw)
      jaw = jaw_frame(tool.trocar, poses[grip.instrument.value], tool.geometry, grip.jaw);
    last = &grip;
    springs.row.push_back(grip.skin_point);
    springs.target.push_back(jaw * grip.local);
    springs.stiffness.push_back(grip.stiffness);
    springs.pad.push_back(jaw.linear().col(0));
  }
  return springs;
}

}  // namespace calot
