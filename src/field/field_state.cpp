#include "field/field_state.h"

#include "field/change_bodies.h"

namespace calot {

FieldState field_state(const Field& field) {
  FieldState state;
  state.members = field.members;
  state.group = snapshot(field);
  state.spill = field.spill;
  for (const Tool& tool : field.tools)
    state.tools.push_back({tool.pose,
                           tool.touched,
                           tool.over_limit,
                           tool.jaw_stopped,
                           tool.lost,
                           tool.beside,
                           tool.slipping,
                           tool.action,
                           tool.dry,
                           tool.has_cut,
                           tool.clips,
                           tool.on_clip,
                           tool.beside_kept,
                           tool.burnt,
                           tool.burnt_record,
                           tool.waits,
                           tool.needle,
                           tool.command,
                           tool.tissue_stiffness,
                           tool.stiffness_across,
                           tool.meeting,
                           tool.met,
                           tool.drag,
                           tool.pressing,
                           tool.roll_stiffness});
  return state;
}

void restore(Field& field, const FieldState& state) {
  restore_members(field, state.members);
  restore(field, state.group);
  field.spill = state.spill;
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    const ToolSnapshot& was = state.tools[i];
    tool.pose = was.pose;
    tool.touched = was.touched;
    tool.over_limit = was.over_limit;
    tool.jaw_stopped = was.jaw_stopped;
    tool.lost = was.lost;
    tool.beside = was.beside;
    tool.slipping = was.slipping;
    tool.action = was.action;
    tool.dry = was.dry;
    tool.has_cut = was.has_cut;
    tool.clips = was.clips;
    tool.on_clip = was.on_clip;
    tool.beside_kept = was.beside_kept;
    tool.burnt = was.burnt;
    tool.burnt_record = was.burnt_record;
    tool.waits = was.waits;
    tool.needle = was.needle;
    tool.command = was.command;
    tool.tissue_stiffness = was.tissue_stiffness;
    tool.stiffness_across = was.stiffness_across;
    tool.meeting = was.meeting;
    tool.met = was.met;
    tool.drag = was.drag;
    tool.pressing = was.pressing;
    tool.roll_stiffness = was.roll_stiffness;
  }
}

}  // namespace calot
