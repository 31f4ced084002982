#include "world/report_states.h"

#include <algorithm>
#include <cmath>

#include "acts/hands.h"
#include "acts/pads.h"
#include "body/rod_body.h"
#include "field/grip.h"
#include "motion/tool_loads.h"
#include "organs/body_kinds.h"

namespace calot {
namespace {

const PartLoad& on(const GroundLoad& ground, ToolPart part) {
  return ground.parts[static_cast<std::size_t>(part)];
}

/// N, of ground on the whole tool.
Vec3 force_of(const GroundLoad& ground) {
  return on(ground, ToolPart::jaws).force + on(ground, ToolPart::shaft).force;
}

/// The ground that presses hardest.
std::string hardest_of(const GroundLoad& ground) {
  const PartLoad &jaws = on(ground, ToolPart::jaws), &shaft = on(ground, ToolPart::shaft);
  return (jaws.largest >= shaft.largest ? jaws : shaft).organ;
}

/// What organs and ground do to a tool's parts together.
PartLoads with_ground(PartLoads parts, const GroundLoad& ground) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    PartLoad& part = parts[k];
    const PartLoad& more = ground.parts[k];
    part.force += more.force;
    if (more.touches > 0 && (part.touches == 0 || more.largest > part.largest)) {
      part.at = more.at;
      part.largest = more.largest;
      part.organ = more.organ;
    }
    part.touches += more.touches;
  }
  return parts;
}

InstrumentState instrument_state(const Field& field, std::size_t index, const ToolLoad& load) {
  const Tool& tool = field.tools[index];
  InstrumentState state;
  state.pose = tool.pose;
  state.tip = tip_position(tool.trocar, tool.pose, tool.geometry);
  state.force = load.force + force_of(tool.ground);
  state.at_tip = force_at_tip(tool, load.force, load.moment);
  state.handle_force = handle_force(tool.trocar, tool.pose, tool.geometry,
                                    state.at_tip + tool.meeting.force + tool.ground.force) +
                       tool.drag;
  // Jaws that rest on a fold are no lag of the hand.
  InstrumentPose asked = tool.command;
  if (tool.jaws_rest()) asked.jaw = tool.pose.jaw;
  state.lag = (tip_position(tool.trocar, asked, tool.geometry) - state.tip).norm();
  state.roll_torque = load.moment.dot(hinge_frame(tool.trocar, tool.pose, tool.geometry).linear().col(2));
  state.roll_lag = std::abs(tool.command.roll - tool.pose.roll);
  state.meets = tool.meeting.with;
  state.meeting_force = tool.meeting.force.norm();
  const ToolIndex number(index);
  for (const Organ& organ : field.organs) state.grip_points += grip_count(organ, number);
  if (tool.jaw_stopped) state.holds = between_pads(field, number);
  state.pad_pressure = pad_pressure(field, number);
  state.clips = tool.clips;
  state.waits = tool.waits;
  state.aspirated = tool.needle.drawn_ever;
  state.touching = load.touches > 0 || tool.ground.touches();
  state.parts = with_ground(load.parts, tool.ground);
  state.touches = load.touches > 0 ? load.organ : hardest_of(tool.ground);
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

OrganState organ_state(const Organ& organ, Workers* workers) {
  OrganState state;
  state.name = organ.definition.name;
  state.record = organ.record;
  const VecX& x = organ.state.x;
  if (const Liquid* liquid = organ.body->liquid()) {
    state.pressure = liquid->pressure_at_top(x, organ.state.datum_pressure);
    state.volume = liquid->volume(x);
  }
  if (const RodBody* rod = organ.body->as_tube())
    for (const Clip& clip : organ.clips)
      state.clips.push_back({clip.size, rod->share_at(clip.at), clip.opening});
  do_at_once(
      workers, [&] { state.energy = organ.body->strain_energy(x); },
      [&] { state.max_stretch = organ.body->max_stretch(x); });
  state.extensions = static_cast<int>(organ.extensions.size());
  state.details = static_cast<int>(organ.body->details().size());
  return state;
}

}  // namespace

void report_states(const Field& field, StepReport& report) {
  const std::vector<ToolLoad> loads = tool_loads(field);
  report.instruments.clear();
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    report.instruments.push_back(instrument_state(field, i, loads[i]));
    report.instruments.back().action = field.tools[i].action;
  }
  report.organs.resize(field.organs.size());
  for_each_chunk(field.workers(), static_cast<int>(field.organs.size()), [&](int chunk) {
    const auto k = static_cast<std::size_t>(chunk);
    report.organs[k] = organ_state(field.organs[k], field.workers());
  });
  report_burnt(field, report);
  report.lost = field.spill.lost;
}

void report_burnt(const Field& field, StepReport& report) {
  for (std::size_t k = 0; k < field.organs.size(); ++k) report.organs[k].raw = raw_area(field.organs[k]);
  std::vector<TissueState>& out = report.tissues;
  out.clear();
  // Those of one name are pieces of one tissue, whose organ was divided.
  for (const Tissue& tissue : field.tissues) {
    const auto same = [&](const TissueState& state) { return state.name == tissue.definition.name; };
    auto at = std::find_if(out.begin(), out.end(), same);
    if (at == out.end()) at = out.insert(out.end(), {tissue.definition.name, 0, 0, 0});
    at->strands += static_cast<int>(tissue.now.opened.size());
    at->torn += tissue.torn();
    at->blunt += tissue.torn_bluntly();
  }
}

}  // namespace calot
