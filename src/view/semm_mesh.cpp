#include "view/semm_mesh.h"

#include <array>
#include <cmath>

#include "view/instrument_parts.h"
#include "view/surfaces.h"

namespace calot {
namespace {

/// How far inside a jaw's outline and how far behind its pad a ring of the surface runs, m.
struct Ring {
  double inset, x;
  bool on_axis = false;  ///< drawn together onto y = 0: front and back close there
};

/// A solid within an outline: rings from the middle of its front over its flank to the middle of its back.
template <std::size_t N>
SceneMesh slab(Material material, const Outline& outline, const std::array<Ring, N>& rings, double rib) {
  constexpr int around = 112, rows = static_cast<int>(N) - 1;
  SceneMesh mesh = sheet(material, around, rows, [&](double u, double v) {
    const int row = static_cast<int>(std::lround(v * rows));
    const Vec2 yz = outline.at(u, rings[row].inset);
    // Ribs across the pad, 1.5 mm apart, shallow: the face that cooks is nearly flat.
    const bool on_pad = row <= 1;
    const double x = rings[row].x + (on_pad ? rib * (0.5 + 0.5 * std::cos(yz.y() / 1.5e-3 * 6.283)) : 0.0);
    return Vec3(x, rings[row].on_axis ? 0 : yz.x(), yz.y());
  });
  give_creased_normals(mesh, instrument_crease);
  return mesh;
}

struct Jaw {
  SceneMesh steel, insulation;
};

/// A heated steel plate under an insulating cover.
Jaw jaw_meshes(const InstrumentGeometry& g) {
  const double wide = 0.5 * g.jaw_width, thick = g.jaw_thickness, round = g.jaw_rounding;
  const Outline outline{0.1e-3, g.jaw_length - 0.05e-3, 0.62 * wide, wide - 0.05e-3};
  const double middle =
      0.6 * wide;  // where front and back close on a line, as the outline is narrowest there
  const std::array<Ring, 6> plate{{{middle, 0.02e-3, true},
                                   {1.15 * round, 0.02e-3},
                                   {0.45 * round, 0.32 * round},
                                   {0.08 * round, 0.85 * round},
                                   {0.08 * round, 0.55 * thick},
                                   {middle, 0.55 * thick, true}}};
  const double step = 0.35 * round;
  const std::array<Ring, 6> cover{{{middle, 0.5 * thick, true},
                                   {step, 0.5 * thick},
                                   {step, thick - 0.75 * round},
                                   {0.75 * round, thick - 0.22 * round},
                                   {1.3 * round, thick - 0.04e-3},
                                   {middle, thick - 0.04e-3, true}}};
  return {slab(Material::steel, outline, plate, 0.12e-3), slab(Material::insulation, outline, cover, 0)};
}

}  // namespace

std::vector<SceneMesh> semm_meshes(const Vec3& trocar, const InstrumentPose& pose,
                                   const InstrumentGeometry& geometry) {
  auto [steel, insulation] = forceps_shaft(trocar, pose, geometry);
  for (int jaw = 0; jaw < 2; ++jaw) {
    Jaw part = jaw_meshes(geometry);
    const Pose frame = jaw_frame(trocar, pose, geometry, jaw);
    move(part.steel, frame);
    move(part.insulation, frame);
    append(steel, part.steel);
    append(insulation, part.insulation);
  }
  return {steel, insulation};
}

}  // namespace calot
