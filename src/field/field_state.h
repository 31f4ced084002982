#pragma once
// Everything of a field that moves, in one copyable value: undo, prepared fields, rewinding and tests start from it.

#include <vector>

#include "field/field.h"

namespace calot {

struct ToolSnapshot {
  InstrumentPose pose;
  bool touched = false, over_limit = false, jaw_stopped = false, lost = false, beside = false,
       slipping = false;
  InstrumentAction action = InstrumentAction::none;
  double dry = 0;
  bool has_cut = false;
  int clips = 0;
  bool on_clip = false, beside_kept = false;
  double burnt = 0;
  int burnt_record = -1;
  bool waits = false;
  NeedleState needle = {};
  InstrumentPose command = {};
  double tissue_stiffness = 0, stiffness_across = 0;
  MeetingState meeting = {};
  bool met = false;
  Vec3 drag = Vec3::Zero();
  bool pressing = false;
  double roll_stiffness = 0;
};

struct FieldState {
  long steps = 0;
  std::shared_ptr<const FieldMembers> members;
  GroupSnapshot group;
  std::vector<ToolSnapshot> tools;
  Spill spill;
  StepReport report;  ///< of the step that led here: events are raised by what differs from it
};

/// Organs and tools; steps and report are the world's.
FieldState field_state(const Field& field);
/// The field must have the tools that the state is of; its bodies become the state's.
void restore(Field& field, const FieldState& state);

}  // namespace calot
