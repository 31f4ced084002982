// The instruments an author names.

#include "anatomy/definitions.h"
#include "base/index_of.h"

namespace calot {

const std::vector<std::string>& instrument_type_names() {
  static const std::vector<std::string> names = {"atraumatic_grasper", "bipolar_electrode", "semm_forceps"};
  return names;
}

std::string to_text(InstrumentType type) { return instrument_type_names()[static_cast<std::size_t>(type)]; }

std::optional<InstrumentType> instrument_type_called(const std::string& name) {
  return enumerator_called<InstrumentType>(name, instrument_type_names());
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
  return enumerator_called<InstrumentAction>(name, instrument_action_names());
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
