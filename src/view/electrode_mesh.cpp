#include "view/electrode_mesh.h"

#include <cmath>
#include <numbers>

#include "view/surfaces.h"

namespace calot {
namespace {

using std::numbers::pi;
constexpr double channel_radius = 0.75e-3, channel_depth = 2.5e-3;  // m (d)
constexpr double strip = 0.7e-3;                                    // m across, between the poles (d)
constexpr int arc_points = 10;                                      // points of a round end's profile

/// Half a section of the rounded end at `share` of its radius: (radius, height) from the neck to the channel's rim.
std::vector<Vec2> end_profile(const InstrumentGeometry& g, double share, double rim) {
  const double r = share * g.electrode_radius;
  const double back = g.jaw_length - g.electrode_length + g.electrode_radius;
  const double front = g.jaw_length - g.electrode_radius;
  const double first = std::asin(g.neck_radius / g.electrode_radius), last = std::asin(rim / r);
  std::vector<Vec2> profile;
  for (int k = 0; k <= arc_points; ++k) {
    const double a = first + (pi / 2 - first) * k / arc_points;
    profile.push_back({r * std::sin(a), back - r * std::cos(a)});
  }
  for (int k = 0; k <= arc_points; ++k) {
    const double a = pi / 2 + (last - pi / 2) * k / arc_points;
    profile.push_back({r * std::sin(a), front + r * std::cos(a)});
  }
  return profile;
}

/// The insulator that carries the poles, with the channel's bore.
SceneMesh core(const InstrumentGeometry& g) {
  std::vector<Vec2> profile = end_profile(g, 0.95, channel_radius);
  profile.insert(profile.begin(), Vec2(0, profile.front().y()));
  const double mouth = profile.back().y();
  profile.push_back({0.9 * channel_radius, mouth - 0.3 * channel_radius});
  profile.push_back({0.9 * channel_radius, mouth - channel_depth});
  profile.push_back({0, mouth - channel_depth});
  return turned(Material::insulation, profile, 48);
}

/// One pole (side +1 or -1 in y): a shell over the insulator whose edges dive into it.
SceneMesh pole(const InstrumentGeometry& g, double side) {
  const double rim = 1.15 * channel_radius;
  const std::vector<Vec2> outer = end_profile(g, 0.985, rim), inner = end_profile(g, 0.92, rim);
  std::vector<Vec2> ring = outer, sunk = inner;
  ring.insert(ring.begin(), inner.front());
  sunk.insert(sunk.begin(), inner.front());
  for (std::size_t k = inner.size(); k-- > 0;) {
    ring.push_back(inner[k]);
    sunk.push_back(inner[k]);
  }
  constexpr int columns = 30;
  const int rows = static_cast<int>(ring.size()) - 1;
  SceneMesh mesh = sheet(Material::steel, columns, rows, [&](double u, double v) {
    const std::size_t row = static_cast<std::size_t>(std::lround(v * rows));
    const bool edge = u <= 0 || u >= 1;
    const Vec2& p = edge ? sunk[row] : ring[row];
    // As far from the strip's middle at every radius: its edges are straight.
    const double first = std::asin(0.5 * strip / p.x()), a = first + (pi - 2 * first) * u;
    return Vec3(p.x() * std::cos(a), side * p.x() * std::sin(a), p.y());
  });
  give_creased_normals(mesh, instrument_crease);
  return mesh;
}

}  // namespace

InstrumentModel electrode_model(const InstrumentGeometry& geometry) {
  const double r = geometry.shaft_radius, neck = 0.96 * geometry.neck_radius;
  const double handle = geometry.jaw_length - geometry.working_length;
  SceneMesh insulation = turned(Material::insulation,
                                {{0.97 * r, handle},
                                 {0.97 * r, -1.12 * r},
                                 {0.80 * r, -0.48 * r},
                                 {0.74 * r, -0.38 * r},
                                 {0, -0.38 * r}},
                                40);
  append(insulation, core(geometry));
  const double end = geometry.jaw_length - 0.75 * geometry.electrode_length;
  SceneMesh steel = turned(Material::steel, {{0, -0.4 * r}, {neck, -0.4 * r}, {neck, end}, {0, end}}, 40);
  append(steel, pole(geometry, 1));
  append(steel, pole(geometry, -1));
  return {geometry, {steel, insulation}, {}};
}

}  // namespace calot
