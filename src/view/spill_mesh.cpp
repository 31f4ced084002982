#include "view/spill_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "liquid/drops.h"
#include "liquid/films.h"
#include "view/surfaces.h"

namespace calot {
namespace {

constexpr double greatest_depth = 4e-3;  // m
constexpr double rim = 0.03e-3;          // m: where a film is thinner its surface is drawn below the skin

/// How far above the skin a film's surface is drawn, m: clear of it where it is thin, too.
double drawn_height(double depth) {
  constexpr double clear = 0.2e-3, soon = 0.05e-3;
  const double over = std::min(depth, greatest_depth) - rim;
  return over + clear * (1 - std::exp(-over / soon));
}

const SceneMesh& ball() {
  static const SceneMesh mesh = sheet(Material::bile, 14, 9, [](double u, double v) {
    const double a = 2 * std::numbers::pi * u, b = std::numbers::pi * v;
    return Vec3(std::sin(b) * std::cos(a), -std::sin(b) * std::sin(a), std::cos(b));
  });
  return mesh;
}

constexpr double wound_drop = 0.05e-6;  // m^3, that marks where ground was hurt: 4.6 mm across

/// Drawn out along its way as far as it goes while one looks.
void add_drop(const Vec3& at, const Vec3& velocity, double volume, SceneMesh& out) {
  constexpr double look = 4e-3, longest = 5;  // s; times as long as it is thick
  const double radius = std::cbrt(3 * volume / (4 * std::numbers::pi));
  const double speed = velocity.norm(), longer = std::min(longest, 1 + look * speed / (2 * radius));
  const Vec3 along = speed > 1e-6 ? Vec3(velocity / speed) : Vec3(Vec3::UnitZ()),
             side = along.unitOrthogonal();
  const double thin = radius / std::sqrt(longer);
  Mat3 shape;
  shape << thin * side, thin * along.cross(side), radius * longer * along;
  const Mat3 of_normals = shape.inverse().transpose();
  const int first = static_cast<int>(out.positions.size());
  for (std::size_t i = 0; i < ball().positions.size(); ++i) {
    out.positions.emplace_back(at + shape * ball().positions[i]);
    out.normals.emplace_back((of_normals * ball().normals[i]).normalized());
    out.rest_positions.emplace_back(0, 0, 0.7 * radius);
  }
  for (const Triangle& t : ball().triangles)
    out.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// The film's own surface over all triangles that it reaches; the normals are its own, so that it shines as a liquid.
void add_film(const WetSurface& surface, const std::map<int, double>& depths, SceneMesh& out) {
  std::map<int, int> drawn;  // of the surface's points
  SceneMesh film;
  const auto corner = [&](int point) {
    const auto [at, fresh] = drawn.try_emplace(point, static_cast<int>(film.positions.size()));
    if (!fresh) return at->second;
    const auto found = depths.find(point);
    const double depth = found == depths.end() ? 0.0 : std::min(found->second, greatest_depth);
    film.positions.emplace_back(surface.at[point] + drawn_height(depth) * surface.normals[point]);
    film.normals.emplace_back(0.2 * surface.normals[point]);
    film.rest_positions.emplace_back(0, 0, depth);
    return at->second;
  };
  for (const Triangle& t : surface.mesh->triangles) {
    if (std::none_of(t.begin(), t.end(), [&](int point) { return depths.contains(point); })) continue;
    film.triangles.push_back({corner(t[0]), corner(t[1]), corner(t[2])});
  }
  for (const Triangle& t : film.triangles) {
    const Vec3 across =
        (film.positions[t[1]] - film.positions[t[0]]).cross(film.positions[t[2]] - film.positions[t[0]]);
    const double size = across.norm();
    for (int k : t)
      if (size > 0) film.normals[k] += across / size;
  }
  for (Vec3& n : film.normals) n.normalize();
  append(out, film);
}

/// Depth of one liquid by points, m, smoothed as a liquid's surface is, on beyond its edge.
std::map<int, double> depths_of(const Film& film, const WetMesh& mesh, int liquid) {
  std::map<int, double> depths;
  for (const WetPoint& wet : film.wet)
    if (wet.volume[liquid] > 0) depths[wet.point] = wet.volume[liquid] / mesh.areas[wet.point];
  constexpr int passes = 2;
  for (int pass = 0; pass < passes; ++pass) {
    std::map<int, double> smooth;
    for (const auto& [point, depth] : depths) {
      const double share = depth / (1 + mesh.begin[point + 1] - mesh.begin[point]);
      smooth[point] += share;
      for (int e = mesh.begin[point]; e < mesh.begin[point + 1]; ++e) smooth[mesh.beside[e]] += share;
    }
    depths = std::move(smooth);
  }
  return depths;
}

Vec3 hanging_place(const Organ& organ, const Opening& opening) {
  const Mouth mouth = mouth_of(organ, opening);
  return mouth.at + (organ.body->is_line() ? 0.4e-3 : 0.5e-3) * mouth.out;
}

}  // namespace

std::vector<SceneMesh> spill_meshes(const World& world) {
  const Field& field = world.field();
  std::vector<SceneMesh> out;
  for (int liquid = 0; liquid < liquids; ++liquid) {
    SceneMesh mesh;
    mesh.material = static_cast<Carries>(liquid) == Carries::blood ? Material::blood : Material::bile;
    for (const Film& film : field.spill.films) {
      const WetSurface surface = wet_surface(field, film.on);
      if (!surface.mesh) continue;
      const std::map<int, double> depths = depths_of(film, *surface.mesh, liquid);
      if (!depths.empty()) add_film(surface, depths, mesh);
    }
    for (const Drop& drop : field.spill.drops)
      if (static_cast<int>(drop.liquid) == liquid) add_drop(drop.at, drop.velocity, drop.volume, mesh);
    for (const Organ& organ : field.organs)
      for (const Opening& opening : organ.openings) {
        const auto* tube = std::get_if<TubeShape>(&organ.definition.shape);
        const Carries carries = tube ? tube->carries : Carries::bile;
        if (opening.drop > 0.1e-9 && static_cast<int>(carries) == liquid)
          add_drop(hanging_place(organ, opening), Vec3::Zero(), opening.drop, mesh);
      }
    if (static_cast<Carries>(liquid) == Carries::blood)
      for (const Wound& wound : field.wounds) add_drop(wound.at, Vec3::Zero(), wound_drop, mesh);
    if (!mesh.triangles.empty()) out.push_back(std::move(mesh));
  }
  return out;
}

}  // namespace calot
