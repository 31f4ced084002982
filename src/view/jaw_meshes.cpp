#include "view/jaw_meshes.h"

#include <cmath>
#include <numbers>

#include "view/surfaces.h"

namespace calot {
namespace {

using MakeJaw = SceneMesh (*)(const InstrumentGeometry& geometry, int jaw);

InstrumentModel with_jaws(const InstrumentGeometry& geometry, MakeJaw make) {
  return {geometry,
          forceps_shaft(geometry),
          {InstrumentPart{make(geometry, 0), {}}, InstrumentPart{make(geometry, 1), {}}}};
}

/// Both jaws bow to the same side: a jaw's frame is turned about z against the other's.
double bow(double z, const InstrumentGeometry& g, int jaw) {
  const double along = z / g.jaw_length;
  return (jaw == 0 ? 1 : -1) * 0.2 * g.jaw_width * (along * along - 0.35);
}

SceneMesh dissector_jaw(const InstrumentGeometry& g, int jaw) {
  const double wide = 0.5 * g.jaw_width, thick = g.jaw_thickness, round = g.jaw_rounding;
  const Outline outline{0.1e-3, g.jaw_length - 0.05e-3, 0.72 * wide, 0.42 * wide};
  const double middle = 0.4 * wide;
  const std::vector<JawRing> rings{{middle, 0.02e-3, true},
                                   {0.3 * wide, 0.02e-3},
                                   {0.14 * wide, 0.28 * round},
                                   {0, 0.7 * round},
                                   {0, thick - 1.0 * round},
                                   {0.16 * wide, thick - 0.4 * round},
                                   {middle, thick - 0.3 * round, true}};
  return jaw_slab(Material::steel, outline, rings, [&](int row, Vec3& at) {
    constexpr double rib = 0.16e-3, pitch = 0.8e-3;
    if (row <= 1) at.x() += rib * (0.5 + 0.5 * std::cos(2 * std::numbers::pi * at.z() / pitch));
    at.y() += bow(at.z(), g, jaw);
  });
}

SceneMesh scissors_jaw(const InstrumentGeometry& g, int) {
  const double wide = 0.5 * g.jaw_width, thick = g.jaw_thickness, round = g.jaw_rounding;
  const Outline outline{0.1e-3, g.jaw_length - 0.05e-3, 0.9 * wide, 0.45 * wide};
  const double middle = 0.44 * wide;
  // Ground from the edge, where the blades meet, to the back.
  const std::vector<JawRing> rings{{middle, 0.02e-3, true},
                                   {0.40 * wide, 0.05e-3},
                                   {0.02 * wide, 0.75 * round},
                                   {0.02 * wide, thick - 0.8 * round},
                                   {0.30 * wide, thick - 0.25 * round},
                                   {middle, thick - 0.22 * round, true}};
  return jaw_slab(Material::steel, outline, rings, [&](int row, Vec3& at) {
    // The back falls towards the point.
    if (row >= 3) at.x() *= 1 - 0.45 * std::pow(at.z() / g.jaw_length, 2);
  });
}

SceneMesh applier_jaw(const InstrumentGeometry& g, int) {
  const double wide = 0.5 * g.jaw_width, thick = g.jaw_thickness, round = g.jaw_rounding;
  const Outline outline{0.1e-3, g.jaw_length - 0.05e-3, 0.8 * wide, 0.62 * wide};
  const double middle = 0.6 * wide, groove = 0.34 * wide;
  const std::vector<JawRing> rings{{middle, 0.45e-3, true},
                                   {groove, 0.45e-3},
                                   {0.92 * groove, 0.02e-3},
                                   {0.45 * round, 0.32 * round},
                                   {0.08 * round, 0.85 * round},
                                   {0.08 * round, thick - 1.0 * round},
                                   {0.45 * round, thick - 0.36 * round},
                                   {middle, thick - 0.04e-3, true}};
  return jaw_slab(Material::steel, outline, rings, [](int, Vec3&) {});
}

}  // namespace

InstrumentModel dissector_model(const InstrumentGeometry& geometry) {
  return with_jaws(geometry, dissector_jaw);
}

InstrumentModel scissors_model(const InstrumentGeometry& geometry) {
  return with_jaws(geometry, scissors_jaw);
}

InstrumentModel applier_model(const InstrumentGeometry& geometry) { return with_jaws(geometry, applier_jaw); }

}  // namespace calot
