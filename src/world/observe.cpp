#include "world/observe.h"

#include <algorithm>
#include <cmath>

#include "acts/current.h"
#include "acts/hands.h"
#include "acts/pads.h"
#include "field/between_jaws.h"
#include "field/field_tissues.h"
#include "field/grip.h"
#include "motion/tool_loads.h"
#include "organs/body_kinds.h"

namespace calot {
namespace {

InstrumentState instrument_state(const Field& field, std::size_t index, const ToolLoad& load) {
  const Tool& tool = field.tools[index];
  InstrumentState state;
  state.pose = tool.pose;
  state.tip = tip_position(tool.trocar, tool.pose, tool.geometry);
  state.force = load.force;
  state.at_tip = force_at_tip(tool, load.force, load.moment);
  state.handle_force =
      handle_force(tool.trocar, tool.pose, tool.geometry, state.at_tip + tool.meeting.force) + tool.drag;
  // Jaws that rest on a fold are no lag of the hand.
  InstrumentPose asked = tool.command;
  if (tool.jaws_rest()) asked.jaw = tool.pose.jaw;
  state.lag = (tip_position(tool.trocar, asked, tool.geometry) - state.tip).norm();
  state.roll_torque = load.moment.dot(hinge_frame(tool.trocar, tool.pose, tool.geometry).linear().col(2));
  state.roll_lag = std::abs(tool.command.roll - tool.pose.roll);
  state.meets = tool.meeting.with;
  state.meeting_force = tool.meeting.force.norm();
  const int number = static_cast<int>(index);
  for (const Organ& organ : field.organs) state.grip_points += grip_count(organ, number);
  if (tool.jaw_stopped) state.holds = between_pads(field, number);
  state.pad_pressure = pad_pressure(field, number);
  state.clips = tool.clips;
  state.waits = tool.waits;
  state.aspirated = tool.needle.drawn_ever;
  state.touching = load.touches > 0;
  state.parts = load.parts;
  const bool closed = tool.pose.jaw <= 0.5 * grip_grid || tool.pressing;
  const bool touches_jaws = state.load_on(ToolPart::jaws).touches > 0;
  if (!state.holds.empty()) {
    state.grip = GripState::holding;
  } else if (tool.lost) {
    state.grip = GripState::slipped;
  } else if (closed) {
    state.grip = tool.beside || touches_jaws ? GripState::beside : GripState::empty;
  }
  return state;
}

OrganState organ_state(const Organ& organ) {
  OrganState state;
  state.name = organ.definition.name;
  state.record = organ.record;
  const VecX& x = organ.state.x;
  if (const Liquid* liquid = organ.body->liquid()) {
    state.pressure = liquid->pressure_at_top(x, organ.state.datum_pressure);
    state.volume = liquid->volume(x);
  }
  if (const RodBody* rod = rod_of(organ))
    for (const Clip& clip : organ.clips)
      state.clips.push_back({clip.size, rod->share_at(clip.at), clip.opening});
  state.energy = organ.body->strain_energy(x);
  state.max_stretch = organ.body->max_stretch(x);
  state.extensions = static_cast<int>(organ.extensions.size());
  state.details = static_cast<int>(organ.body->details().size());
  return state;
}

/// Those of one name are pieces of one tissue, whose organ was divided.
std::vector<TissueState> tissue_states(const Field& field) {
  std::vector<TissueState> out;
  for (const Tissue& tissue : field.tissues) {
    const auto same = [&](const TissueState& state) { return state.name == tissue.definition.name; };
    auto at = std::find_if(out.begin(), out.end(), same);
    if (at == out.end()) at = out.insert(out.end(), {tissue.definition.name, 0, 0});
    at->strands += static_cast<int>(tissue.now.opened.size());
    at->torn += tissue.torn();
  }
  return out;
}

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

/// What the seals of the ports drag at tools that come from where they were before.
void feel_ports(std::vector<Tool>& tools, const std::vector<InstrumentState>& before, double duration) {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    Tool& tool = tools[i];
    const bool slid = i < before.size() && !tool.waits && !before[i].waits;
    tool.drag =
        slid ? port_drag(tool, tool.pose.insertion - before[i].pose.insertion, duration) : Vec3(Vec3::Zero());
  }
}

void report_states(const Field& field, const std::vector<ToolLoad>& loads, StepReport& report) {
  report.instruments.clear();
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    report.instruments.push_back(instrument_state(field, i, loads[i]));
    report.instruments.back().action = field.tools[i].action;
  }
  report.organs.resize(field.organs.size());
  for_each_chunk(field.workers(), static_cast<int>(field.organs.size()), [&](int chunk) noexcept {
    const auto k = static_cast<std::size_t>(chunk);
    report.organs[k] = organ_state(field.organs[k]);
  });
  report.tissues = tissue_states(field);
  report.lost = field.spill.lost;
}

}  // namespace

void report_states(const Field& field, StepReport& report) {
  report_states(field, tool_loads(field), report);
}

void observe(Field& field, const std::vector<InstrumentAction>& actions, double duration,
             std::vector<WorldEvent> events, StepReport& report) {
  const std::vector<ToolLoad> loads = tool_loads(field);
  const std::vector<OrganState> before = report.organs;
  const std::vector<InstrumentState> tools_before = report.instruments;
  feel_ports(field.tools, tools_before, duration);
  report_states(field, loads, report);

  // Events are raised when a condition begins, not while it lasts.
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    const InstrumentState& state = report.instruments[i];
    const std::string& organ = loads[i].organ;
    if (state.touching && !tool.touched)
      events.push_back({EventKind::contact, 0, tool.definition.name, organ, 0, touched_place(state)});
    const InstrumentAction asked = actions.empty() ? InstrumentAction::none : actions[i];
    if (asked == InstrumentAction::activate && tool.action != asked)
      events.push_back({EventKind::activation, 0, tool.definition.name, organ, 0, touched_place(state)});
    tool.action = report.instruments[i].action = asked;
    const PartLoad& on_jaws = state.load_on(ToolPart::jaws);
    const bool over = on_jaws.force.norm() > tool.definition.force_limit;
    if (over && !tool.over_limit)
      events.push_back({EventKind::overforce, 0, tool.definition.name, on_jaws.organ, on_jaws.force.norm(),
                        place_of(on_jaws)});
    tool.touched = state.touching;
    tool.over_limit = over;
    if (i < tools_before.size()) feel_stiffness(tool, tools_before[i], state);
    if (!state.meets.empty() && !tool.met) {
      WorldEvent event{EventKind::clash, 0, tool.definition.name, {}, state.meeting_force};
      event.text = state.meets;
      events.push_back(std::move(event));
    }
    tool.met = !state.meets.empty();
  }
  for (const WorldEvent& event : apply_current(field, report.instruments, duration)) events.push_back(event);
  report.tissues = tissue_states(field);
  judge_stretch(field, before, report.organs, events);
  for (WorldEvent& event : events) {
    event.time = report.time;
    for (std::size_t i = 0; i < field.tools.size() && !event.place; ++i)
      if (field.tools[i].definition.name == event.instrument) event.place = report.instruments[i].tip;
  }
  report.events = std::move(events);
}

}  // namespace calot
