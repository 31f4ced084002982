#include "view/hook_mesh.h"

#include <cmath>
#include <numbers>

#include "view/surfaces.h"

namespace calot {
namespace {

constexpr double bare = 6e-3;  // m of the neck, before the bend, that no insulation covers (d)
constexpr double thin =
    0.92;  // of the electrode's radius: bent as tightly as that it stays within its straight parts

/// From within the shaft round the bend to the foot's end.
std::vector<Vec3> wire(const InstrumentGeometry& g) {
  const double bend = g.electrode_radius, level = g.jaw_length - g.electrode_radius;
  std::vector<Vec3> line{{0, 0, 0}, {0, 0, level - bare}};
  constexpr int parts = 6;
  for (int k = 0; k <= parts; ++k) {
    const double a = 0.5 * std::numbers::pi * k / parts;
    line.emplace_back(bend * (1 - std::cos(a)), 0, level - bend * (1 - std::sin(a)));
  }
  line.emplace_back(g.electrode_aside, 0, level);
  return line;
}

}  // namespace

InstrumentModel hook_model(const InstrumentGeometry& geometry) {
  const double r = geometry.shaft_radius, neck = 0.99 * geometry.neck_radius;
  const double handle = geometry.jaw_length - geometry.working_length;
  const double end = geometry.jaw_length - geometry.electrode_radius - bare;
  SceneMesh insulation = turned(Material::insulation,
                                {{0.97 * r, handle},
                                 {0.97 * r, -1.12 * r},
                                 {0.80 * r, -0.48 * r},
                                 {neck, -0.2 * r},
                                 {neck, end},
                                 {0, end}},
                                40);
  SceneMesh steel = bent_bar(Material::steel, wire(geometry), thin * geometry.electrode_radius);
  return {geometry, {steel, insulation}, {}};
}

}  // namespace calot
