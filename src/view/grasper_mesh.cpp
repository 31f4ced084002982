#include "view/grasper_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "view/surfaces.h"

namespace calot {
namespace {

/// Depth of the pad's teeth below x = 0: rows across the jaw, 1 mm apart, flat crests.
double tooth(double z) {
  const double phase = z / 1.0e-3 - std::floor(z / 1.0e-3);
  return 0.28e-3 * std::clamp(2.2 * std::abs(phase - 0.5) * 2 - 0.8, 0.0, 1.0);
}

/// One jaw in its frame: a strip with a window, its section running pad - flank - back - window wall - pad.
SceneMesh jaw_mesh(const InstrumentGeometry& g) {
  const double wide = 0.5 * g.jaw_width, thick = g.jaw_thickness, round = g.jaw_rounding;
  const Outline outer{0.1e-3, g.jaw_length - 0.05e-3, wide - 0.05e-3, 0.72 * wide};
  const JawWindow opening = *jaw_window(g);
  const Outline window{opening.start, opening.end, opening.start_half, opening.end_half};
  struct Station {
    bool inner;    // on the window's outline rather than the outer one
    double inset;  // m, inward from the outline (negative: away from the window)
    double x;      // m; teeth are added on the pad
    bool pad;
  };
  const double rim = 0.3 * round;
  const std::array<Station, 12> section{{{true, 0, 0.3 * thick, false},
                                         {true, -rim, 0.05e-3, true},
                                         {false, 1.15 * round, 0.02e-3, true},
                                         {false, 0.45 * round, 0.32 * round, false},
                                         {false, 0.08 * round, 0.85 * round, false},
                                         {false, 0.06 * round, thick - 1.0 * round, false},
                                         {false, 0.42 * round, thick - 0.36 * round, false},
                                         {false, 1.1 * round, thick - 0.04e-3, false},
                                         {true, -rim, thick - 0.04e-3, false},
                                         {true, 0, thick - 0.3 * thick, false},
                                         {true, 0, 0.5 * thick, false},
                                         {true, 0, 0.3 * thick, false}}};
  constexpr int around = 60;
  constexpr int rows = static_cast<int>(section.size()) - 1;
  SceneMesh mesh = sheet(Material::steel, around, rows, [&](double u, double v) {
    const Station& s = section[std::lround(v * rows)];
    const Vec2 yz = (s.inner ? window : outer).at(u, s.inset);
    return Vec3(s.x + (s.pad ? tooth(yz.y()) : 0.0), yz.x(), yz.y());
  });
  give_creased_normals(mesh, instrument_crease);
  return mesh;
}

}  // namespace

InstrumentModel grasper_model(const InstrumentGeometry& geometry) {
  const InstrumentPart jaw{jaw_mesh(geometry), {}};
  return {geometry, forceps_shaft(geometry), {jaw, jaw}};
}

}  // namespace calot
