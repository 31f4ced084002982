#include "acts/hard_hold.h"

#include <algorithm>
#include <array>
#include <set>

#include "acts/grip_slip.h"
#include "field/grip.h"
#include "field/take_hold.h"
#include "field/teeth.h"
#include "motion/rubbing.h"
#include "motion/settle_field.h"

namespace calot {

bool holds_hard(const Field& field, ToolIndex instrument) {
  return std::any_of(field.organs.begin(), field.organs.end(), [&](const Organ& organ) {
    return !is_bitten(organ) && grip_count(organ, instrument) > 0;
  });
}

bool rests_on_hard(const Field& field, ToolIndex instrument) {
  if (!field.tool(instrument).geometry.has_jaws()) return false;
  for (const Organ& organ : field.organs) {
    if (is_bitten(organ)) continue;
    std::array<bool, 2> touched{};
    const ContactLoads now = contact_loads(field, organ, present_poses(field));
    for (const Touch& touch : organ.search.touching(*organ.body, organ.state.x, now)) {
      const FieldShape which = field.shape(touch.shape);
      if (which.tool == instrument && !which.is_shaft() && !which.is_ground())
        touched[static_cast<std::size_t>(which.jaw())] = true;
    }
    if (touched[0] && touched[1]) return true;
  }
  return false;
}

namespace {

/// Skin points of the triangles that each jaw of a tool rubs on with its teeth.
std::array<std::set<int>, 2> touched_points(const Field& field, ToolIndex instrument, const Organ& organ) {
  const Tool& tool = field.tool(instrument);
  std::array<std::set<int>, 2> out;
  for (const RubbingPoint& rubbing : organ.friction.points) {
    const FieldShape which = field.shape(rubbing.shape);
    if (which.tool != instrument || which.is_shaft() || which.is_ground()) continue;
    const int jaw = which.jaw();
    const Pose to_jaw = jaw_frame(tool.trocar, tool.pose, tool.geometry, jaw).inverse();
    for (int corner : organ.body->skin().triangles[rubbing.point / contacts_each])
      if (before_pad(to_jaw * organ.body->skin_point(corner, organ.state.x), tool.geometry))
        out[static_cast<std::size_t>(jaw)].insert(corner);
  }
  return out;
}

void take_away(Organ& organ, ToolIndex instrument) {
  std::erase_if(organ.grips, [&](const GripPoint& grip) { return grip.instrument == instrument; });
}

}  // namespace

void catch_hard(Field& field, ToolIndex instrument, const Clasped& held) {
  Organ& organ = field.organ(held.organ);
  const std::array<std::set<int>, 2> points = touched_points(field, instrument, organ);
  if (points[0].empty() || points[1].empty()) return;
  const Tool& tool = field.tool(instrument);
  for (int jaw : {0, 1}) {
    const Pose to_jaw = jaw_frame(tool.trocar, tool.pose, tool.geometry, jaw).inverse();
    for (int point : points[static_cast<std::size_t>(jaw)])
      organ.grips.push_back(
          {instrument, jaw, point, to_jaw * organ.body->skin_point(point, organ.state.x), grip_stiffness});
  }
  constexpr double most = 0.95;  // of what friction holds: what was caught would slide again at once
  if (asked_share(field, instrument) > most) return take_away(organ, instrument);
  sort_grips(organ);
}

void let_slide_on_hard(Field& field, ToolIndex instrument) {
  if (!holds_hard(field, instrument) || asked_share(field, instrument) <= 1) return;
  for (Organ& organ : field.organs)
    if (!is_bitten(organ)) take_away(organ, instrument);
}

}  // namespace calot
