#include "view/pins.h"

#include <cmath>
#include <numbers>

#include "view/surfaces.h"

namespace calot {
namespace {

constexpr double head = 2.5e-3, shaft = 0.5e-3;  // m, radii

/// A rod of a radius from one place to another, m, with round ends.
SceneMesh spindle(Material material, const Vec3& from, const Vec3& to, double radius) {
  const Vec3 along = (to - from).normalized(), side = along.unitOrthogonal(), across = along.cross(side);
  return sheet(material, 16, 12, [&](double u, double v) {
    const double a = 2 * std::numbers::pi * u, b = std::numbers::pi * v;
    const Vec3 out = std::sin(b) * (std::cos(a) * side + std::sin(a) * across);
    return Vec3((v < 0.5 ? from : to) + radius * (out - std::cos(b) * along));
  });
}

}  // namespace

std::vector<SceneMesh> pin_meshes(const std::vector<Vec3>& places, const Vec3& eye) {
  std::vector<SceneMesh> out;
  for (const Vec3& place : places) {
    const Vec3 end = 0.5 * (place + eye), aside = (eye - place).unitOrthogonal();
    // Seen from just behind its head nothing of it would be: it leans.
    const Vec3 top = end + 0.12 * (eye - place).norm() * aside;
    out.push_back(spindle(Material::steel, place, top, shaft));
    out.push_back(spindle(Material::artery, top, top + 1e-6 * aside, head));
  }
  return out;
}

}  // namespace calot
