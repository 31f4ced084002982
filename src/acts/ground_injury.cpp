#include "acts/ground_injury.h"

#include <algorithm>

#include "anatomy/instruments.h"

namespace calot {
namespace {

/// Of that name where it can be hurt; else null.
const Ground* tender_ground(const Field& field, const std::string& name) {
  const auto found = std::find_if(field.ground.begin(), field.ground.end(),
                                  [&](const Ground& ground) { return ground.name == name; });
  return found == field.ground.end() || found->injury.empty() ? nullptr : &*found;
}

}  // namespace

std::vector<WorldEvent> hurt_ground(Field& field, bool balanced) {
  std::vector<WorldEvent> events;
  for (Tool& tool : field.tools) {
    const PartLoad& jaws = tool.ground.parts[static_cast<std::size_t>(ToolPart::jaws)];
    const Ground* ground = jaws.touches > 0 ? tender_ground(field, jaws.organ) : nullptr;
    if (ground == nullptr) {
      tool.hurts_ground = {};
      continue;
    }
    const auto hurt = [&](bool& known, EventCause cause) {
      if (std::exchange(known, true)) return;
      field.wounds.push_back({ground->name, jaws.at});
      events.push_back(
          {EventKind::injury, 0, tool.definition.name, ground->name, 0, jaws.at, cause, ground->injury});
    };
    if (tool.closes && instrument_row(tool.definition.type).jaws == JawUse::cut)
      hurt(tool.hurts_ground.blades, EventCause::blades);
    if (tool.action == InstrumentAction::fire) hurt(tool.hurts_ground.clip, EventCause::clip);
    if (tool.action == InstrumentAction::activate) hurt(tool.hurts_ground.current, EventCause::current);
    if (balanced && jaws.force.norm() > ground->thrust_limit)
      hurt(tool.hurts_ground.thrust, EventCause::thrust);
  }
  return events;
}

}  // namespace calot
