#include "field/teeth.h"

#include <algorithm>
#include <cmath>

namespace calot {

bool has_teeth(const Tool& tool) {
  return tool.geometry.has_jaws() && instrument_row(tool.definition.type).jaws == JawUse::hold &&
         tool.definition.pad_friction > 0;
}

bool is_bitten(const Organ& organ) { return organ.body->is_bitten(); }

bool before_pad(const Vec3& local, const InstrumentGeometry& g) {
  return std::abs(local.y()) < 0.5 * g.jaw_width && local.z() > g.jaw_rounding && local.z() < g.jaw_length;
}

double teeth_share(const Vec3& local, const Vec3& normal, const InstrumentGeometry& g) {
  constexpr double facing_aside = 0.25, facing_it = 0.75;  // of the normal, towards the other pad
  const auto ramp = [](double x) { return std::clamp(x, 0.0, 1.0); };
  const double from_edge = std::min(0.5 * g.jaw_width - std::abs(local.y()), g.jaw_length - local.z());
  return ramp((-normal.x() - facing_aside) / (facing_it - facing_aside)) * ramp(from_edge / g.jaw_rounding) *
         ramp(local.z() / g.jaw_rounding - 1);
}

}  // namespace calot
