#include "view/needle_mesh.h"

#include <cmath>
#include <numbers>

#include "view/surfaces.h"

namespace calot {

InstrumentModel needle_model(const InstrumentGeometry& geometry) {
  const double r = geometry.shaft_radius;
  const double neck = 0.98 * geometry.neck_radius, needle = 0.99 * geometry.electrode_radius;
  const double handle = geometry.jaw_length - geometry.working_length;
  const double collar = geometry.jaw_length - geometry.electrode_length;  // where the needle leaves its neck
  SceneMesh insulation = turned(
      Material::insulation,
      {{0.97 * r, handle}, {0.97 * r, -1.12 * r}, {0.80 * r, -0.48 * r}, {neck, -0.2 * r}, {0, -0.2 * r}},
      40);
  std::vector<Vec2> profile{
      {0, -0.3 * r}, {neck, -0.3 * r}, {neck, collar}, {needle, collar + geometry.neck_radius}};
  constexpr int arc = 8;
  const double front = geometry.jaw_length - geometry.electrode_radius;
  for (int k = 0; k <= arc; ++k) {
    const double a = 0.5 * std::numbers::pi * k / arc;
    profile.emplace_back(k == arc ? 0.0 : needle * std::cos(a), front + needle * std::sin(a));
  }
  SceneMesh steel = turned(Material::steel, profile, 40);
  return {geometry, {steel, insulation}, {}};
}

SceneMesh needle_end_mesh(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry,
                          double length) {
  const double r = 0.99 * geometry.electrode_radius, tip = geometry.jaw_length + length;
  const double back = geometry.jaw_length - geometry.electrode_radius;
  SceneMesh steel = turned(Material::steel, {{0, back}, {r, back}, {r, tip - 3 * r}, {0, tip}}, 40);
  move(steel, hinge_frame(trocar, pose, geometry));
  return steel;
}

}  // namespace calot
