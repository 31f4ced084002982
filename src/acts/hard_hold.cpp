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
#include "motion/tool_loads.h"

namespace calot {

bool holds_hard(const Field& field, ToolIndex instrument) {
  return std::any_of(field.organs.begin(), field.organs.end(), [&](const Organ& organ) {
    return !is_bitten(organ) && grip_count(organ, instrument) > 0;
  });
}

namespace {

/// Calls use(tool, which shape) for what touches an organ of all that tools are.
template <class Use>
void for_tool_touches(const Field& field, const Organ& organ, const Use& use) {
  const ContactLoads now = contact_loads(field, organ, present_poses(field));
  for (const Touch& touch : organ.search.touching(*organ.body, organ.state.x, now)) {
    const FieldShape which = field.shape(touch.shape);
    if (!which.is_ground()) use(which);
  }
}

}  // namespace

bool rests_on_hard(const Field& field, ToolIndex instrument) {
  if (!field.tool(instrument).geometry.has_jaws()) return false;
  for (const Organ& organ : field.organs) {
    if (is_bitten(organ)) continue;
    std::array<bool, 2> touched{};
    for_tool_touches(field, organ, [&](const FieldShape& which) {
      if (which.tool == instrument && !which.is_shaft())
        touched[static_cast<std::size_t>(which.jaw())] = true;
    });
    if (touched[0] && touched[1]) return true;
  }
  return false;
}

bool touches_hard(const Field& field) {
  bool any = false;
  for (const Organ& organ : field.organs)
    if (!is_bitten(organ)) for_tool_touches(field, organ, [&](const FieldShape&) { any = true; });
  return any;
}

bool may_touch_hard(const Field& field, double travel) {
  return std::any_of(field.organs.begin(), field.organs.end(), [&](const Organ& organ) {
    if (is_bitten(organ)) return false;
    const ContactLoads now = contact_loads(field, organ, present_poses(field));
    const std::vector<ContactPair> near =
        gather_pairs(*organ.body, organ.state.x, now, travel - contact_margin);
    return std::any_of(near.begin(), near.end(),
                       [&](const ContactPair& pair) { return !field.shape(pair.shape).is_ground(); });
  });
}

namespace {

/// Whether anything hard that a tool touches is strained as nothing rigid is.
bool strains_hard(const Field& field) {
  constexpr double most = 1.03;
  return std::any_of(field.organs.begin(), field.organs.end(), [](const Organ& organ) {
    return !is_bitten(organ) && organ.body->max_stretch(organ.state.x) > most;
  });
}

/// Whether any tool or jaw is pressed by more than so many times its hand's strength.
bool presses_beyond(const Field& field, double times) {
  const std::vector<ToolLoad> loads = tool_loads(field);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const double jaws = std::max(loads[i].on_jaws[0].norm(), loads[i].on_jaws[1].norm());
    if (std::max(loads[i].force.norm(), jaws) > times * field.tools[i].definition.hand_force) return true;
  }
  return false;
}

}  // namespace

bool wedges_hard(const Field& field) {
  return touches_hard(field) && strains_hard(field) && presses_beyond(field, 1);
}

bool crushes(const Field& field) {
  // What is out of balance, or closes fast, may press by a few times a hand's strength for a step.
  constexpr double beyond_any_hand = 20;
  return presses_beyond(field, beyond_any_hand);
}

namespace {

/// Skin points of the triangles that each jaw of a tool rubs on with its teeth.
std::array<std::set<int>, 2> touched_points(const Field& field, ToolIndex instrument, const Organ& organ,
                                            const std::array<Pose, 2>& to_jaw) {
  const Tool& tool = field.tool(instrument);
  std::array<std::set<int>, 2> out;
  for (const RubbingPoint& rubbing : organ.friction.points) {
    const FieldShape which = field.shape(rubbing.shape);
    if (which.tool != instrument || which.is_shaft() || which.is_ground()) continue;
    const auto jaw = static_cast<std::size_t>(which.jaw());
    for (int corner : organ.body->skin().triangles[rubbing.point / contacts_each])
      if (before_pad(to_jaw[jaw] * organ.body->skin_point(corner, organ.state.x), tool.geometry))
        out[jaw].insert(corner);
  }
  return out;
}

void take_away(Organ& organ, ToolIndex instrument) {
  std::erase_if(organ.grips, [&](const GripPoint& grip) { return grip.instrument == instrument; });
}

}  // namespace

void catch_hard(Field& field, ToolIndex instrument, const Clasped& held) {
  Organ& organ = field.organ(held.organ);
  const std::array<Pose, 2> to_jaw = to_jaws(field.tool(instrument));
  const std::array<std::set<int>, 2> points = touched_points(field, instrument, organ, to_jaw);
  if (points[0].empty() || points[1].empty()) return;
  for (std::size_t jaw : {0u, 1u})
    for (int point : points[jaw])
      organ.grips.push_back({instrument, static_cast<int>(jaw), point,
                             to_jaw[jaw] * organ.body->skin_point(point, organ.state.x), grip_stiffness});
  constexpr double most = 0.95;  // of what friction holds: what was caught would slide again at once
  if (asked_of_pads(field, instrument).share > most) return take_away(organ, instrument);
  sort_grips(organ);
}

namespace {

/// Moves what holds a point on, in the pad's plane, so that this share of its way from there is left.
void turn_on(const Organ& organ, const Pose& to_jaw, double left, GripPoint& grip) {
  Vec3 on = to_jaw * organ.body->skin_point(grip.skin_point, organ.state.x) - grip.local;
  on.x() = 0;
  grip.local += (1 - left) * on;
}

}  // namespace

bool let_slide_on_hard(Field& field, ToolIndex instrument) {
  constexpr double left = 0.98;  // of what friction holds, after it
  const Asked asked = holds_hard(field, instrument) ? asked_of_pads(field, instrument) : Asked{};
  if (asked.share <= 1) return false;
  const Tool& tool = field.tool(instrument);
  const std::array<Pose, 2> to_jaw = to_jaws(tool);
  for (Organ& organ : field.organs) {
    if (is_bitten(organ)) continue;
    if (!asked.turns) {
      take_away(organ, instrument);
      continue;
    }
    for (GripPoint& grip : organ.grips)
      if (grip.instrument == instrument)
        turn_on(organ, to_jaw[static_cast<std::size_t>(grip.jaw)], left / asked.share, grip);
    std::erase_if(organ.grips, [&](const GripPoint& grip) {
      return grip.instrument == instrument && !before_pad(grip.local, tool.geometry);
    });
    if (!both_pads_hold(organ, instrument)) take_away(organ, instrument);
  }
  return true;
}

}  // namespace calot
