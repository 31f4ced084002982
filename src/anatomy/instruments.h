#pragma once
// The instruments an author names, one row a type: a new one is a row here and how it is drawn (view/instrument_mesh.cpp).

#include "anatomy/definitions.h"

namespace calot {

/// An instrument's measures, all in m and rad. The defaults are the atraumatic grasper's: 5 mm shaft, 310 mm
/// working length, jaws 20 mm (c). Without jaws, jaw_opening is 0 and the hinge, which cannot turn, is where the
/// shaft ends: a neck on the shaft's axis and an electrode that it carries, jaw_length long in all, follow.
struct InstrumentGeometry {
  double shaft_radius = 2.5e-3;
  double working_length = 310e-3;  ///< handle to the tip of the closed jaws
  double jaw_length = 20e-3;       ///< hinge to tip
  double jaw_width = 5e-3;
  double jaw_thickness = 1.9e-3;
  double jaw_rounding = 0.8e-3;             ///< edge radius of the jaw's box; at most half its thickness
  double jaw_opening = 1.0471975511965976;  ///< 60 deg fully open (c)
  double max_insertion = 300e-3;
  bool fenestrated = true;  ///< jaws with a window; contact takes them for solid
  double electrode_radius = 0, electrode_length = 0, neck_radius = 0;  ///< without jaws
  double electrode_aside = 0;  ///< how far its end stands off the shaft's axis: the foot of a hook
  bool has_jaws() const { return jaw_opening > 0; }
};

/// What closing jaws do with what is between them.
enum class JawUse {
  hold,   ///< by friction; what has none has no use for this either
  cut,    ///< they are blades
  carry,  ///< nothing: they carry a clip, which an action sets
};

struct InstrumentRow {
  InstrumentType type;
  const char* name;
  const char* doc;  ///< what an author should know of it
  InstrumentGeometry geometry = {};
  std::vector<InstrumentAction> actions = {};  ///< that it knows beside none
  JawUse jaws = JawUse::hold;
  double pad_friction = InstrumentDefinition().pad_friction;
};

/// A clip that is shut: two legs side by side, m.
struct ClipRow {
  ClipSize size;
  const char* name;
  double leg, wire;  ///< a leg's length and thickness
};
/// In the order of the sizes.
const std::vector<ClipRow>& clip_rows();
const ClipRow& clip_row(ClipSize size);
std::vector<std::string> clip_names();

/// In the order of the types.
const std::vector<InstrumentRow>& instrument_rows();
const InstrumentRow& instrument_row(InstrumentType type);

}  // namespace calot
