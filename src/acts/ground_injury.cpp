#include "acts/ground_injury.h"

#include <algorithm>
#include <utility>

#include "anatomy/instruments.h"

namespace calot {
namespace {

/// Of that name where it can be hurt; else null.
const Ground* tender_ground(const Field& field, const std::string& name) {
  const auto found = std::find_if(field.ground.begin(), field.ground.end(),
                                  [&](const Ground& ground) { return ground.name == name; });
  return found == field.ground.end() || found->injury.empty() ? nullptr : &*found;
}

void wound(Field& field, const Tool& tool, const GroundTouch& touch, EventCause cause,
           std::vector<WorldEvent>& events) {
  const Ground* ground = tender_ground(field, touch.ground);
  if (ground == nullptr) return;
  field.wounds.push_back({ground->name, touch.at});
  events.push_back(
      {EventKind::injury, 0, tool.definition.name, ground->name, 0, touch.at, cause, ground->injury});
}

/// How the tool has hurt that ground since it came on it.
GroundHurt hurt_before(const Tool& tool, const std::string& ground) {
  for (const GroundHurt& hurt : tool.hurts_ground)
    if (hurt.ground == ground) return hurt;
  return {ground};
}

}  // namespace

std::vector<WorldEvent> hurt_ground(Field& field, bool balanced) {
  std::vector<WorldEvent> events;
  for (Tool& tool : field.tools) {
    std::vector<GroundHurt> hurts;
    for (const GroundTouch& touch : tool.ground.touched) {
      const Ground* ground = tender_ground(field, touch.ground);
      if (ground == nullptr) continue;
      GroundHurt& hurt = hurts.emplace_back(hurt_before(tool, touch.ground));
      const auto judge = [&](bool hurts_now, bool& known, EventCause cause) {
        if (hurts_now && !std::exchange(known, true)) wound(field, tool, touch, cause, events);
      };
      judge(tool.closes && instrument_row(tool.definition.type).jaws == JawUse::cut, hurt.blades,
            EventCause::blades);
      judge(tool.action == InstrumentAction::activate && touch.conducts, hurt.current, EventCause::current);
      judge(balanced && touch.force.norm() > ground->thrust_limit, hurt.thrust, EventCause::thrust);
    }
    tool.hurts_ground = std::move(hurts);
  }
  return events;
}

void hurt_by_clip(Field& field, ToolIndex instrument, std::vector<WorldEvent>& events) {
  const Tool& tool = field.tool(instrument);
  for (const GroundTouch& touch : tool.ground.touched) wound(field, tool, touch, EventCause::clip, events);
}

}  // namespace calot
