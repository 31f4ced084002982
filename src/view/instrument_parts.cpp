#include "view/instrument_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "view/surfaces.h"

namespace calot {
namespace {

using std::numbers::pi;

/// One prong of the clevis (side +1 or -1 in y): the shaft's capsule ends in a ball about z = -r, and the
/// prong is the slice of it, and of the cylinder behind, with |y| beyond the jaws' tangs. Closed by its first
/// and last row.
SceneMesh prong(const InstrumentGeometry& g, double side) {
  const double r = g.shaft_radius;
  constexpr int rows = 8;
  SceneMesh mesh = sheet(Material::steel, 32, rows, [&](double u, double v) {
    const int row = static_cast<int>(std::lround(v * rows));
    const double share = std::clamp((row - 1.0) / (rows - 2.0), 0.0, 1.0), a = 2 * pi * u;
    const double y = (0.42 + 0.5 * share) * r;
    const double reach = row == 0 || row == rows ? 0 : std::sqrt(r * r - y * y) * 0.985;
    const double back = row == 0 || row == rows ? 0 : 1.2 * r;
    return Vec3(reach * std::cos(a), side * y, -r + std::sin(a) * (std::sin(a) > 0 ? reach : back));
  });
  give_creased_normals(mesh, instrument_crease);
  return mesh;
}

/// A round bar along y about (0, z): the hinge's pin, and the tangs on which the jaws turn.
SceneMesh bar(double radius, double half_length, double z) {
  SceneMesh mesh =
      turned(Material::steel,
             {{0, -half_length}, {radius, -half_length}, {radius, half_length}, {0, half_length}}, 24);
  for (Vec3& p : mesh.positions) p = Vec3(p.y(), p.z(), z + p.x());
  for (Vec3& n : mesh.normals) n = Vec3(n.y(), n.z(), n.x());
  return mesh;
}

}  // namespace

SceneMesh turned(Material material, const std::vector<Vec2>& profile, int around) {
  const int rows = static_cast<int>(profile.size()) - 1;
  SceneMesh mesh = sheet(material, around, rows, [&](double u, double v) {
    const Vec2& p = profile[std::lround(v * rows)];
    return Vec3(p.x() * std::cos(2 * pi * u), p.x() * std::sin(2 * pi * u), p.y());
  });
  give_creased_normals(mesh, instrument_crease);
  return mesh;
}

double Outline::half_width(double z) const {
  const double along = (z - start) / (end - start);
  return start_half + (end_half - start_half) * along;
}

Vec2 Outline::at(double t, double inset) const {
  const double a = 2 * pi * t, c = std::cos(a), s = std::sin(a);
  // A superellipse: straight flanks, round ends.
  const double shape = std::pow(std::pow(std::abs(c), 5) + std::pow(std::abs(s), 5), -0.2);
  const double z = 0.5 * (start + end) + (0.5 * (end - start) - inset) * shape * s;
  return {(half_width(z) - inset) * shape * c, z};
}

SceneMesh jaw_slab(Material material, const Outline& outline, const std::vector<JawRing>& rings,
                   const std::function<void(int row, Vec3& at)>& place) {
  constexpr int around = 112;
  const int rows = static_cast<int>(rings.size()) - 1;
  SceneMesh mesh = sheet(material, around, rows, [&](double u, double v) {
    const auto row = static_cast<std::size_t>(std::lround(v * rows));
    const Vec2 yz = outline.at(u, rings[row].inset);
    Vec3 at(rings[row].x, rings[row].on_axis ? 0 : yz.x(), yz.y());
    place(static_cast<int>(row), at);
    return at;
  });
  give_creased_normals(mesh, instrument_crease);
  return mesh;
}

SceneMesh bent_bar(Material material, const std::vector<Vec3>& line, double radius) {
  struct Ring {
    Vec3 at, along;
    double radius;
  };
  std::vector<Ring> rings;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Vec3 before = line[k] - line[k == 0 ? 0 : k - 1],
               after = line[std::min(k + 1, line.size() - 1)] - line[k];
    const Vec3 along = (before.normalized() + after.normalized()).normalized();
    if (k == 0) rings.push_back({line[k], along, 0});
    rings.push_back({line[k], along, radius});
  }
  const Ring last = rings.back();
  constexpr int arc = 6;
  for (int k = 1; k <= arc; ++k) {
    const double a = pi / 2 * k / arc;
    rings.push_back(
        {last.at + radius * std::sin(a) * last.along, last.along, k == arc ? 0 : radius * std::cos(a)});
  }
  const int rows = static_cast<int>(rings.size()) - 1;
  SceneMesh mesh = sheet(material, 24, rows, [&](double u, double v) {
    const Ring& ring = rings[static_cast<std::size_t>(std::lround(v * rows))];
    const Vec3 side = Vec3::UnitY(), up = ring.along.cross(side);
    return Vec3(ring.at + ring.radius * (std::cos(2 * pi * u) * side + std::sin(2 * pi * u) * up));
  });
  give_creased_normals(mesh, instrument_crease);
  return mesh;
}

InstrumentPart forceps_shaft(const InstrumentGeometry& geometry) {
  const double r = geometry.shaft_radius;
  const double outside = geometry.jaw_length - geometry.working_length;  // the handle, in the hinge's frame
  const double scale = r / 2.5e-3;                                       // lengths are those of a 5 mm shaft
  SceneMesh insulation = turned(Material::insulation,
                                {{0.97 * r, outside},
                                 {0.97 * r, -16e-3 * scale},
                                 {0.97 * r, -13.2e-3 * scale},
                                 {0.88 * r, -13e-3 * scale}},
                                40);
  SceneMesh steel = turned(Material::steel,
                           {{0.86 * r, -13.5e-3 * scale},
                            {0.86 * r, -9e-3 * scale},
                            {0.92 * r, -8.6e-3 * scale},
                            {0.92 * r, -1.9 * r},
                            {0.80 * r, -1.75 * r},
                            {0.0, -1.75 * r}},
                           40);
  append(steel, prong(geometry, 1));
  append(steel, prong(geometry, -1));
  append(steel, bar(0.5 * r, 0.42 * r, -0.65 * r));
  append(steel, bar(0.26 * r, 0.945 * r, -0.95 * r));
  return {steel, insulation};
}

}  // namespace calot
