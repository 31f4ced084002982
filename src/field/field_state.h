#pragma once
// Everything of a field that moves, in one copyable value: undo, prepared fields, rewinding and tests start from it.

#include <vector>

#include "field/field.h"

namespace calot {

struct FieldState {
  long steps = 0;
  std::shared_ptr<const FieldMembers> members;
  GroupSnapshot group;
  std::vector<ToolState> tools;
  Spill spill;
  std::vector<Wound> wounds;
  StepReport report;  ///< of the step that led here: events are raised by what differs from it
};

/// Organs and tools; steps and report are the world's.
FieldState field_state(const Field& field);
/// The field must have the tools that the state is of; its bodies become the state's.
void restore(Field& field, const FieldState& state);

}  // namespace calot
