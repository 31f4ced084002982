#include "world/observe.h"

#include <algorithm>

#include "organs/body_kinds.h"

namespace calot {
namespace {

std::optional<Vec3> place_of(const PartLoad& load) {
  return load.touches > 0 ? std::optional<Vec3>(load.at) : std::nullopt;
}

/// Where an instrument is pressed hardest, m; none where it touches nothing.
std::optional<Vec3> touched_place(const InstrumentState& state) {
  const PartLoad* hardest = nullptr;
  for (const PartLoad& load : state.parts)
    if (load.touches > 0 && (hardest == nullptr || load.largest > hardest->largest)) hardest = &load;
  return hardest == nullptr ? std::nullopt : place_of(*hardest);
}

/// Walls that are stretched so far that they open, or too far, since this step.
void judge_stretch(const Field& field, const std::vector<OrganState>& before,
                   const std::vector<OrganState>& now, std::vector<WorldEvent>& events) {
  for (std::size_t k = 0; k < now.size(); ++k) {
    const OrganDefinition& organ = field.organs[k].definition;
    const auto goes_beyond = [&](double limit) {
      return now[k].max_stretch > limit &&
             std::none_of(before.begin(), before.end(), [&](const OrganState& one) {
               return one.record == now[k].record && one.max_stretch > limit;
             });
    };
    if (goes_beyond(organ.wall.overstretch))
      events.push_back({EventKind::overstretch, 0, "", organ.name, now[k].max_stretch});
    if (is_hollow(organ.shape) && goes_beyond(organ.wall.perforation_stretch))
      events.push_back({EventKind::perforation, 0, "", organ.name, 0, std::nullopt, EventCause::stretch});
  }
}

/// What begins at a tool.
void observe_tool(const InstrumentDefinition& tool, const InstrumentState& before, const InstrumentState& now,
                  std::vector<WorldEvent>& events) {
  if (now.touching && !before.touching)
    events.push_back({EventKind::contact, 0, tool.name, now.touches, 0, touched_place(now)});
  if (now.action == InstrumentAction::activate && before.action != now.action)
    events.push_back({EventKind::activation, 0, tool.name, now.touches, 0, touched_place(now)});
  if (!now.meets.empty() && before.meets.empty()) {
    WorldEvent event{EventKind::clash, 0, tool.name, {}, now.meeting_force};
    event.text = now.meets;
    events.push_back(std::move(event));
  }
}

/// Jaws that are pressed with more than they may, and were not when forces were in balance last.
void judge_force(const Tool& tool, const InstrumentState& now, std::vector<WorldEvent>& events) {
  if (!presses_too_hard(now, tool.definition.force_limit) || tool.over_limit) return;
  const PartLoad& on_jaws = now.load_on(ToolPart::jaws);
  events.push_back({EventKind::overforce, 0, tool.definition.name, on_jaws.organ, on_jaws.force.norm(),
                    place_of(on_jaws)});
}

}  // namespace

bool presses_too_hard(const InstrumentState& state, double limit) {
  return state.load_on(ToolPart::jaws).force.norm() > limit;
}

std::vector<WorldEvent> observe(const Field& field, const StepReport& before, const StepReport& now) {
  std::vector<WorldEvent> events;
  const InstrumentState unseen;
  for (std::size_t i = 0; i < field.tools.size(); ++i)
    observe_tool(field.tools[i].definition, i < before.instruments.size() ? before.instruments[i] : unseen,
                 now.instruments[i], events);
  // Forces and stretches of what is not in balance tell nothing; what they really are, the next steps show.
  if (!now.balanced) return events;
  for (std::size_t i = 0; i < field.tools.size(); ++i)
    judge_force(field.tools[i], now.instruments[i], events);
  judge_stretch(field, before.organs, now.organs, events);
  return events;
}

void place_events(const Field& field, const StepReport& report, std::vector<WorldEvent>& events) {
  for (WorldEvent& event : events) {
    event.time = report.time;
    for (std::size_t i = 0; i < field.tools.size() && !event.place; ++i)
      if (field.tools[i].definition.name == event.instrument) event.place = report.instruments[i].tip;
  }
}

}  // namespace calot
