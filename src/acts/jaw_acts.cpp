#include "acts/jaw_acts.h"

#include <algorithm>
#include <utility>

#include "acts/blades.h"
#include "acts/clips.h"
#include "acts/exchange.h"
#include "acts/grip_slip.h"
#include "acts/hard_hold.h"
#include "acts/pads.h"
#include "field/grip.h"
#include "field/leaving.h"
#include "field/take_hold.h"
#include "liquid/perforate.h"

namespace calot {
namespace {

/// What of a tissue was torn in a step.
void judge_tearing(Tissue& tissue, int torn_before, std::vector<WorldEvent>& events) {
  const int torn = tissue.torn(), strands = static_cast<int>(tissue.now.opened.size());
  const bool was_tearing = std::exchange(tissue.now.tearing, torn > torn_before);
  const std::string& name = tissue.definition.name;
  if (tissue.now.tearing && !was_tearing)
    events.push_back({EventKind::tear,
                      0,
                      {},
                      name,
                      static_cast<double>(torn) / strands,
                      std::nullopt,
                      EventCause::stretch});
  if (torn == strands && torn_before < strands)
    events.push_back({EventKind::parted, 0, {}, name, 0, std::nullopt, EventCause::stretch});
}

/// Blades closed on what they hold: each wall is cut, a hollow one opened; a rigid thing is not.
void note_cut(Field& field, ToolIndex instrument, std::vector<WorldEvent>& events) {
  const std::string& tool = field.tool(instrument).definition.name;
  bool cut = false;
  for (Organ& organ : field.organs) {
    if (grip_count(organ, instrument) == 0 || std::holds_alternative<RigidShape>(organ.definition.shape))
      continue;
    const bool liver = std::holds_alternative<LobeShape>(organ.definition.shape);
    events.push_back({liver ? EventKind::cut_liver : EventKind::perforation, 0, tool, organ.definition.name,
                      0, std::nullopt, EventCause::blades});
    perforate(organ, instrument, tool);
    cut = true;
  }
  if (!cut)
    events.push_back({EventKind::empty_cut, 0, tool, between_pads(field, instrument), 0, std::nullopt,
                      EventCause::blades});
}

/// A wall that jaws pinch harder than it bears is opened; so is one that blades stand on.
void note_hold(Field& field, ToolIndex instrument, std::vector<WorldEvent>& events) {
  const InstrumentDefinition& tool = field.tool(instrument).definition;
  if (instrument_row(tool.type).jaws == JawUse::cut) return note_cut(field, instrument, events);
  events.push_back({EventKind::grasp, 0, tool.name, between_pads(field, instrument), 0});
  for (Organ& organ : field.organs) {
    if (!is_hollow(organ.definition.shape) || grip_count(organ, instrument) == 0) continue;
    if (tool.pinch_force <= organ.definition.wall.pinch_limit) continue;
    events.push_back(
        {EventKind::perforation, 0, tool.name, organ.definition.name, 0, std::nullopt, EventCause::pinch});
    perforate(organ, instrument, tool.name);
  }
}

/// Whether neither pad holds what both press on.
bool slides(const Clasped& held, const Tool& tool) {
  constexpr double most = 0.98;  // of what friction holds: points at the rim stick
  for (std::size_t jaw : {0u, 1u})
    if (held.along[jaw].norm() < most * tool.definition.pad_friction * held.pressed[jaw]) return false;
  return true;
}

}  // namespace

void TearWatch::judge(Field& field, std::vector<WorldEvent>& events) const {
  for (std::size_t t = 0; t < field.tissues.size(); ++t) judge_tearing(field.tissues[t], torn_[t], events);
}

void TearWatch::look(const Field& field) {
  torn_.clear();
  for (const Tissue& tissue : field.tissues) torn_.push_back(tissue.torn());
}

Result<bool> let_go(Field& field, const std::vector<InstrumentPose>& targets, std::vector<WorldEvent>& events,
                    SolveStatistics& statistics) {
  let_left_go(field);
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    // Jaws that stop closing before tissue carries their pinch press on nothing.
    const bool closing = targets[i].jaw < tool.pose.jaw;
    if (targets[i].jaw > tool.pose.jaw) tool.lost = tool.beside = tool.has_cut = false;
    if (closing || (tool.jaws_rest() && targets[i].jaw == tool.pose.jaw)) continue;
    const ToolIndex index(i);
    const std::string organ = between_pads(field, index);
    const bool held = tool.jaw_stopped && instrument_row(tool.definition.type).jaws != JawUse::cut;
    if (field.step_time > 0)
      let_leave(field, index);
    else if (!held_organ(field, index).empty())
      if (Result<bool> released = release(field, index, statistics); !released) return released.failure();
    if (held)
      events.push_back(
          {EventKind::release, 0, tool.definition.name, organ, 0, std::nullopt, EventCause::opening});
    tool.jaw_stopped = tool.pressing = false;
  }
  return true;
}

Result<bool> let_slip(Field& field, const std::vector<char>& slipped_before, std::vector<WorldEvent>& events,
                      SolveStatistics& statistics) {
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    const ToolIndex index(i);
    const std::string organ = held_organ(field, index);
    const double pull = holds_hard(field, index) ? pad_load(field, index).pull.norm() : 0;
    if (let_slide_on_hard(field, index)) {
      if (!tool.slipping && !slipped_before[i])
        events.push_back({EventKind::slip, 0, tool.definition.name, organ, pull});
      tool.slipping = true;
    }
    if (organ.empty() || !tool.jaws_rest() || holds_hard(field, index)) continue;
    if (Result<bool> left = leave_pads(field, index, statistics); !left) return left.failure();
    const Result<Slipped> slipped =
        held_organ(field, index).empty() ? Slipped{} : slip(field, index, statistics);
    if (!slipped) return slipped.failure();
    const bool slid = slipped->slid;
    if (slid && !tool.slipping && !slipped_before[i])
      events.push_back({slipped->turned ? EventKind::turn : EventKind::slip, 0, tool.definition.name, organ,
                        slipped->pull});
    tool.slipping |= slid;
    if (slid) let_clips_fall(field, index, events);
    // What one pad alone has bitten is held as far as that goes.
    if (both_pads_hold(field, index) || (!tool.jaw_stopped && !slid)) continue;
    if (Result<bool> released = release(field, index, statistics); !released) return released.failure();
    tool.pressing = false;
    if (!std::exchange(tool.jaw_stopped, false)) continue;
    tool.lost = true;
    events.push_back(
        {EventKind::release, 0, tool.definition.name, organ, 0, std::nullopt, EventCause::slipping});
  }
  return true;
}

Result<bool> close_jaws(Field& field, ToolIndex instrument, TearWatch& tears, std::vector<WorldEvent>& events,
                        SolveStatistics& statistics) {
  Tool& tool = field.tool(instrument);
  const JawUse use = instrument_row(tool.definition.type).jaws;
  if (use == JawUse::cut) {
    tears.judge(field, events);
    if (Result<bool> cut = close_blades(field, instrument, events, statistics); !cut) return cut.failure();
    tears.look(field);
  }
  end_leaving(field, instrument);
  let_left_go(field);  // what still touches the pads is held anew
  take_hold(field, instrument);
  if (fold_fills_jaws(field, instrument)) {
    tool.pressing = tool.lost = tool.beside = false;
    if (!std::exchange(tool.jaw_stopped, true)) note_hold(field, instrument, events);
    return true;
  }
  if (tool.pose.jaw > 0.5 * grip_grid) return true;
  tool.pressing = false;
  if (use != JawUse::carry && !tool.has_cut && !is_in_trocar(tool))
    events.push_back(
        {use == JawUse::cut ? EventKind::empty_cut : EventKind::empty_grasp, 0, tool.definition.name, {}, 0});
  tool.beside = !held_organ(field, instrument).empty();
  // Closed, and only one pad holds: what it dragged along slips back.
  return tool.beside ? release(field, instrument, statistics) : Result<bool>(true);
}

void judge_clasps(Field& field, const std::vector<char>& slipped_before, std::vector<WorldEvent>& events) {
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    const ToolIndex index(i);
    if (!tool.pressing) continue;
    const std::string organ = between_pads(field, index);
    const bool before = std::exchange(tool.jaw_stopped, !organ.empty());
    if (tool.jaw_stopped && !before) {
      tool.lost = tool.beside = false;
      note_hold(field, index, events);
    } else if (before && !tool.jaw_stopped) {
      tool.lost = true;
      events.push_back(
          {EventKind::release, 0, tool.definition.name, {}, 0, std::nullopt, EventCause::slipping});
    }
    const std::optional<Clasped> rubbed = before && tool.jaw_stopped ? clasped(field, index) : std::nullopt;
    if (!rubbed) continue;
    if (!slides(*rubbed, tool)) {
      catch_hard(field, index, *rubbed);
      continue;
    }
    tool.slipping = true;
    if (!slipped_before[i])
      events.push_back(
          {EventKind::slip, 0, tool.definition.name, organ, (rubbed->along[0] + rubbed->along[1]).norm()});
  }
}

}  // namespace calot
