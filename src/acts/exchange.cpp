#include "acts/exchange.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "acts/hands.h"
#include "acts/pads.h"
#include "field/grip.h"
#include "motion/tool_loads.h"

namespace calot {
namespace {

constexpr double slack = 1e-6;  // m and rad: what a path's arithmetic may be off

bool alike(const InstrumentPose& a, const InstrumentPose& b) {
  return std::max({std::abs(a.pitch - b.pitch), std::abs(a.yaw - b.yaw), std::abs(a.insertion - b.insertion),
                   std::abs(a.roll - b.roll), std::abs(a.jaw - b.jaw)}) <= slack;
}

/// What a tool has between its jaws, by its teeth or clasped by friction alone; empty: nothing.
std::string held_in(const Field& field, ToolIndex index) {
  const std::string bitten = held_organ(field, index);
  return bitten.empty() && field.tool(index).jaw_stopped ? between_pads(field, index) : bitten;
}

/// As a tool that has done nothing yet: what its jaws did in the field is over.
void clean(Tool& tool) {
  tool.jaw_stopped = tool.pressing = tool.lost = tool.beside = tool.slipping = tool.has_cut = false;
}

/// Why a tool that waits cannot come in for the one (`index`) that is in its port; empty: it can, and is in.
std::string bring_in(Field& field, ToolIndex coming, ToolIndex index) {
  Tool& tool = field.tool(coming);
  Tool& leaving = field.tool(index);
  const std::string& name = leaving.definition.name;
  if (const std::string held = held_in(field, index); !held.empty())
    return fmt::format("{} holds {}", name, held);
  if (!is_in_trocar(leaving))
    return fmt::format("{} is {:.0f} mm in: no more than {:.0f} mm are out of the field", name,
                       leaving.pose.insertion / 1e-3, port_depth / 1e-3);
  const InstrumentPose waited = tool.pose;
  tool.pose = leaving.pose;
  tool.pose.roll = tool.pose.jaw = 0;
  tool.waits = false;
  leaving.waits = true;
  std::string why = tool_met(field, coming);
  if (!why.empty()) why += " is in the way";
  if (!touches_nothing(field, coming)) why = "it would touch what is before its port";
  if (!why.empty()) {
    tool.pose = waited;
    tool.waits = true;
    leaving.waits = false;
    return why;
  }
  tool.command = tool.pose;
  clean(leaving);
  return {};
}

}  // namespace

bool is_in_trocar(const Tool& tool) { return tool.pose.insertion <= port_depth + slack; }

ToolIndex tool_in_port(const std::vector<Tool>& tools, const Tool& waiting) {
  const auto there = std::find_if(tools.begin(), tools.end(), [&](const Tool& tool) {
    return !tool.waits && tool.definition.port == waiting.definition.port;
  });
  return ToolIndex(there - tools.begin());
}

std::optional<Failure> check_waiting(const std::vector<Tool>& tools, const StepInput& input) {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const bool acts = !input.actions.empty() && input.actions[i] != InstrumentAction::none &&
                      input.actions[i] != InstrumentAction::exchange;
    if (!tools[i].waits || (alike(tools[i].pose, input.instruments[i]) && !acts)) continue;
    const Tool& there = tools[tool_in_port(tools, tools[i]).value];
    return fail(FailureKind::scenario,
                fmt::format("instrument '{}' cannot {}: it waits outside, and '{}' is in the port \"{}\"",
                            tools[i].definition.name, acts ? "act" : "move", there.definition.name,
                            tools[i].definition.port),
                fmt::format("draw '{}' back into the port and give '{}' the action exchange first",
                            there.definition.name, tools[i].definition.name));
  }
  return std::nullopt;
}

void exchange_tools(Field& field, const std::vector<InstrumentAction>& actions,
                    std::vector<WorldEvent>& events) {
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (actions[i] != InstrumentAction::exchange || field.tools[i].action == InstrumentAction::exchange)
      continue;
    WorldEvent event{EventKind::blocked_exchange, 0, field.tools[i].definition.name, {}, 0};
    event.text = "it is in its port";
    if (field.tools[i].waits) {
      const ToolIndex coming(i), there = tool_in_port(field.tools, field.tools[i]);
      event.text = bring_in(field, coming, there);
      if (event.text.empty()) {
        event.kind = EventKind::exchange;
        event.text = field.tool(there).definition.name;
      }
    }
    events.push_back(std::move(event));
  }
}

}  // namespace calot
