// The instruments an author names.

#include <algorithm>

#include "anatomy/definitions.h"

namespace calot {

const std::vector<std::string>& instrument_type_names() {
  static const std::vector<std::string> names = {"atraumatic_grasper", "bipolar_electrode", "semm_forceps"};
  return names;
}

std::string to_text(InstrumentType type) { return instrument_type_names()[static_cast<std::size_t>(type)]; }

std::optional<InstrumentType> instrument_type_called(const std::string& name) {
  const std::vector<std::string>& names = instrument_type_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<InstrumentType>(found - names.begin());
}

const std::vector<std::string>& instrument_action_names() {
  static const std::vector<std::string> names = {"none",     "activate", "fire",
                                                 "irrigate", "aspirate", "exchange"};
  return names;
}

std::string to_text(InstrumentAction action) {
  return instrument_action_names()[static_cast<std::size_t>(action)];
}

std::optional<InstrumentAction> instrument_action_called(const std::string& name) {
  const std::vector<std::string>& names = instrument_action_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<InstrumentAction>(found - names.begin());
}

bool has_action(InstrumentType type, InstrumentAction action) {
  if (action == InstrumentAction::activate) return type != InstrumentType::atraumatic_grasper;
  return action == InstrumentAction::none;
}

bool has_jaws(InstrumentType type) { return type != InstrumentType::bipolar_electrode; }

InstrumentDefinition default_instrument(InstrumentType type) {
  InstrumentDefinition instrument;
  instrument.type = type;
  if (type == InstrumentType::semm_forceps) instrument.pad_friction = 0.3;
  return instrument;
}

}  // namespace calot
