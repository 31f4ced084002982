#include "anatomy/instruments.h"

#include <algorithm>

#include "base/index_of.h"
#include "base/units.h"

namespace calot {
namespace {

/// A shaft whose jaws have no window, as wide and thick as that (m).
InstrumentGeometry forceps(double length, double width, double thickness, double rounding) {
  InstrumentGeometry out;
  out.fenestrated = false;
  out.jaw_length = length;
  out.jaw_width = width;
  out.jaw_thickness = thickness;
  out.jaw_rounding = rounding;
  return out;
}

/// A shaft that ends in a neck and a round electrode (m).
InstrumentGeometry rod(double end_length, double neck_radius, double electrode_radius,
                       double electrode_length, double aside) {
  InstrumentGeometry out = forceps(end_length, 0, 0, 0);
  out.jaw_opening = 0;
  out.neck_radius = neck_radius;
  out.electrode_radius = electrode_radius;
  out.electrode_length = electrode_length;
  out.electrode_aside = aside;
  return out;
}

/// 10 mm shaft (c); its jaws pass it, and open as wide as a clip of 9 mm is (d).
InstrumentGeometry applier() {
  InstrumentGeometry out = forceps(18e-3, 5e-3, 2.6e-3, 0.8e-3);
  out.shaft_radius = 5e-3;
  out.jaw_opening = 36 * units::deg;
  return out;
}

}  // namespace

const std::vector<InstrumentRow>& instrument_rows() {
  using enum InstrumentType;
  using enum InstrumentAction;
  // Shafts of 5 mm, jaws of 20 mm, blades of 12 to 20 mm and hooks of 5 to 10 mm are published (c); how wide and thick
  // their ends are is design (d). Semm's flat pads hold as smooth metal does, friction 0.3 (c), and pass a sleeve of 8 mm.
  static const std::vector<InstrumentRow> rows = {
      {atraumatic_grasper, "atraumatic_grasper", "has long fenestrated jaws with teeth"},
      {bipolar_electrode,
       "bipolar_electrode",
       "(with channel) has no jaws and only pushes",
       rod(12e-3, 1.9e-3, 2.5e-3, 6e-3, 0),
       {activate}},
      {semm_forceps,
       "semm_forceps",
       "has short broad flat jaws",
       forceps(15e-3, 7e-3, 2.2e-3, 0.8e-3),
       {activate},
       JawUse::hold,
       0.3},
      {maryland_dissector, "maryland_dissector", "has slim curved jaws",
       forceps(20e-3, 4e-3, 1.8e-3, 0.8e-3)},
      {l_hook,
       "l_hook",
       "is a wire that ends in a foot to one side, and has no jaws",
       rod(14e-3, 0.9e-3, 0.9e-3, 1.8e-3, 5e-3),
       {activate}},
      {scissors, "scissors", "has blades", forceps(16e-3, 2.4e-3, 2.2e-3, 0.6e-3), {}, JawUse::cut},
      {clip_applier, "clip_applier", "has a shaft of 10 mm and sets clips", applier(), {fire}, JawUse::carry},
      {aspiration_needle,
       "aspiration_needle",
       "is a needle of 14 gauge that draws out what a hollow organ holds, and has no jaws",
       rod(24e-3, 1.5e-3, 1.05e-3, 16e-3, 0),
       {aspirate}},
  };
  return rows;
}

const std::vector<ClipRow>& clip_rows() {
  // For vessels of 2 to 4 and of 3.5 to 7 mm, 6 and 9 mm long when they are shut (c); of wire as thick as that (d).
  static const std::vector<ClipRow> rows = {{ClipSize::m, "M", 6e-3, 0.7e-3},
                                            {ClipSize::ml, "ML", 9e-3, 0.8e-3}};
  return rows;
}

const ClipRow& clip_row(ClipSize size) { return clip_rows()[static_cast<std::size_t>(size)]; }

std::vector<std::string> clip_names() {
  std::vector<std::string> out;
  for (const ClipRow& row : clip_rows()) out.emplace_back(row.name);
  return out;
}

const InstrumentRow& instrument_row(InstrumentType type) {
  return instrument_rows()[static_cast<std::size_t>(type)];
}

const std::vector<std::string>& instrument_type_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const InstrumentRow& row : instrument_rows()) out.emplace_back(row.name);
    return out;
  }();
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
  const std::vector<InstrumentAction>& known = instrument_row(type).actions;
  return action == InstrumentAction::none || action == InstrumentAction::exchange ||
         std::find(known.begin(), known.end(), action) != known.end();
}

InstrumentAction main_action(InstrumentType type) {
  const std::vector<InstrumentAction>& known = instrument_row(type).actions;
  return known.empty() ? InstrumentAction::none : known.front();
}

bool has_jaws(InstrumentType type) { return instrument_row(type).geometry.has_jaws(); }

InstrumentDefinition default_instrument(InstrumentType type) {
  InstrumentDefinition instrument;
  instrument.type = type;
  instrument.pad_friction = instrument_row(type).pad_friction;
  return instrument;
}

}  // namespace calot
