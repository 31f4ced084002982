#include "view/semm_mesh.h"

#include <cmath>

#include "view/surfaces.h"

namespace calot {
namespace {

/// Ribs across the pad, 1.5 mm apart, shallow: the face that cooks is nearly flat.
void rib(int row, Vec3& at) {
  constexpr double depth = 0.12e-3;
  if (row <= 1) at.x() += depth * (0.5 + 0.5 * std::cos(at.z() / 1.5e-3 * 6.283));
}

/// A heated steel plate under an insulating cover.
InstrumentPart jaw_part(const InstrumentGeometry& g) {
  const double wide = 0.5 * g.jaw_width, thick = g.jaw_thickness, round = g.jaw_rounding;
  const Outline outline{0.1e-3, g.jaw_length - 0.05e-3, 0.62 * wide, wide - 0.05e-3};
  const double middle =
      0.6 * wide;  // where front and back close on a line, as the outline is narrowest there
  const std::vector<JawRing> plate{{middle, 0.02e-3, true},      {1.15 * round, 0.02e-3},
                                   {0.45 * round, 0.32 * round}, {0.08 * round, 0.85 * round},
                                   {0.08 * round, 0.55 * thick}, {middle, 0.55 * thick, true}};
  const double step = 0.35 * round;
  const std::vector<JawRing> cover{{middle, 0.5 * thick, true},    {step, 0.5 * thick},
                                   {step, thick - 0.75 * round},   {0.75 * round, thick - 0.22 * round},
                                   {1.3 * round, thick - 0.04e-3}, {middle, thick - 0.04e-3, true}};
  return {jaw_slab(Material::steel, outline, plate, rib),
          jaw_slab(Material::insulation, outline, cover, [](int, Vec3&) {})};
}

}  // namespace

InstrumentModel semm_model(const InstrumentGeometry& geometry) {
  const InstrumentPart jaw = jaw_part(geometry);
  return {geometry, forceps_shaft(geometry), {jaw, jaw}};
}

}  // namespace calot
