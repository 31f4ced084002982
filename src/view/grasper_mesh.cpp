#include "view/grasper_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "view/surfaces.h"

namespace calot {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double crease = 0.6;  // rad: rounded edges stay smooth, cut ones sharp

/// A surface of revolution about z through (radius, height) points, outward for rising heights.
SceneMesh turned(Material material, const std::vector<Vec2>& profile, int around) {
  const int rows = static_cast<int>(profile.size()) - 1;
  SceneMesh mesh = sheet(material, around, rows, [&](double u, double v) {
    const Vec2& p = profile[std::lround(v * rows)];
    return Vec3(p.x() * std::cos(2 * pi * u), p.x() * std::sin(2 * pi * u), p.y());
  });
  give_creased_normals(mesh, crease);
  return mesh;
}

/// Outline of a jaw (or of its window) in the plane of its width y and length z: a rounded strip that
/// narrows.
struct Outline {
  double start, end;            // z, m
  double start_half, end_half;  // half width, m

  /// t in [0, 1) runs once around, counter-clockwise seen from +x; `inset` moves inward.
  Vec2 at(double t, double inset) const {
    const double a = 2 * pi * t, c = std::cos(a), s = std::sin(a);
    // A superellipse: straight flanks, round ends.
    const double shape = std::pow(std::pow(std::abs(c), 5) + std::pow(std::abs(s), 5), -0.2);
    const double z = 0.5 * (start + end) + (0.5 * (end - start) - inset) * shape * s;
    const double along = (z - start) / (end - start);
    const double half = start_half + (end_half - start_half) * along - inset;
    return {half * shape * c, z};
  }
};

/// Depth of the pad's teeth below x = 0: rows across the jaw, 1 mm apart, flat crests.
double tooth(double z) {
  const double phase = z / 1.0e-3 - std::floor(z / 1.0e-3);
  return 0.28e-3 * std::clamp(2.2 * std::abs(phase - 0.5) * 2 - 0.8, 0.0, 1.0);
}

/// One jaw in its frame: a strip with a window, its section running pad - flank - back - window wall - pad.
SceneMesh jaw_mesh(const GrasperGeometry& g) {
  const double wide = 0.5 * g.jaw_width, thick = g.jaw_thickness, round = g.jaw_rounding;
  const Outline outer{0.1e-3, g.jaw_length - 0.05e-3, wide - 0.05e-3, 0.72 * wide};
  const Outline window{0.30 * g.jaw_length, 0.82 * g.jaw_length, 0.40 * wide, 0.30 * wide};
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
  give_creased_normals(mesh, crease);
  return mesh;
}

/// One prong of the clevis (side +1 or -1 in y): the shaft's capsule ends in a ball about z = -r, and the
/// prong is the slice of it, and of the cylinder behind, with |y| beyond the jaws' tangs. Closed by its first
/// and last row.
SceneMesh prong(const GrasperGeometry& g, double side) {
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
  give_creased_normals(mesh, crease);
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

std::vector<SceneMesh> grasper_meshes(const Vec3& trocar, const InstrumentPose& pose,
                                      const GrasperGeometry& geometry) {
  const double r = geometry.shaft_radius;
  const double outside = geometry.jaw_length - geometry.working_length;  // the handle, in the hinge's frame
  const Pose hinge = hinge_frame(trocar, pose, geometry);

  SceneMesh insulation =
      turned(Material::insulation,
             {{0.97 * r, outside}, {0.97 * r, -16e-3}, {0.97 * r, -13.2e-3}, {0.88 * r, -13e-3}}, 40);
  SceneMesh steel = turned(Material::steel,
                           {{0.86 * r, -13.5e-3},
                            {0.86 * r, -9e-3},
                            {0.92 * r, -8.6e-3},
                            {0.92 * r, -1.9 * r},
                            {0.80 * r, -1.75 * r},
                            {0.0, -1.75 * r}},
                           40);
  append(steel, prong(geometry, 1));
  append(steel, prong(geometry, -1));
  append(steel, bar(0.5 * r, 0.42 * r, -0.65 * r));
  append(steel, bar(0.26 * r, 0.945 * r, -0.95 * r));
  move(insulation, hinge);
  move(steel, hinge);
  for (int jaw = 0; jaw < 2; ++jaw) {
    SceneMesh part = jaw_mesh(geometry);
    move(part, jaw_frame(trocar, pose, geometry, jaw));
    append(steel, part);
  }
  return {steel, insulation};
}

}  // namespace calot
