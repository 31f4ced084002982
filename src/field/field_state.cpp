#include "field/field_state.h"

#include "field/change_bodies.h"

namespace calot {

FieldState field_state(const Field& field) {
  FieldState state;
  state.members = field.members;
  state.group = snapshot(field);
  state.spill = field.spill;
  state.wounds = field.wounds;
  state.tools.assign(field.tools.begin(), field.tools.end());
  return state;
}

void restore(Field& field, const FieldState& state) {
  restore_members(field, state.members);
  restore(field, state.group);
  field.spill = state.spill;
  field.wounds = state.wounds;
  for (std::size_t i = 0; i < field.tools.size(); ++i)
    static_cast<ToolState&>(field.tools[i]) = state.tools[i];
}

}  // namespace calot
