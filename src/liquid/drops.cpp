#include "liquid/drops.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/units.h"
#include "body/rod_body.h"
#include "geometry/triangle_crossing.h"
#include "liquid/films.h"

namespace calot {
namespace {

constexpr double drop_volume = 10e-9;     // m^3; of a pipette 20 to 50 (d)
constexpr double jet_volume = 3e-9;       // m^3, of a jet's drop
constexpr double jet = 0.06;              // m/s: slower it drips
constexpr double slowed = 0.4;            // share of its speed that a ragged end leaves a jet (d)
constexpr double fastest = 2.5;           // m/s
constexpr double farthest_fall = 600e-3;  // m, from the field's middle: what is farther has fallen away

/// Share of the way at which it goes through a triangle from its outside.
std::optional<double> crosses(const std::array<Vec3, 3>& t, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  if (!((t[1] - t[0]).cross(t[2] - t[0]).dot(way) < 0)) return std::nullopt;
  const std::optional<double> share = met_at(t, from, way);
  return share && *share >= 0 && *share <= 1 ? share : std::nullopt;
}

bool is_end(const RodBody& rod, const Opening& opening) {
  return opening.point == 0 || opening.point == static_cast<int>(rod.last_point());
}

double width_of(const Organ& organ, const Opening& opening) {
  const RodBody* rod = organ.body->as_tube();
  if (rod == nullptr || !is_end(*rod, opening)) return opening.area;
  return std::numbers::pi * std::pow(std::max(rod->lumen_radius(opening.point), 1e-4), 2);
}

bool has_fallen_away(const Field& field, const Vec3& at) {
  return (at - field.middle).norm() >= farthest_fall;
}

/// Where what falls from one place to another lands; none: it falls on.
std::optional<Landing> lands(Field& field, const FallenOn& skins, const Vec3& from, const Vec3& to) {
  if (const std::optional<FallenOn::Met> met = skins.meets(from, to))
    return land_on_skin(field, field.organ(met->organ), met->point);
  for (std::size_t k = 0; k < field.ground.size(); ++k)
    if (signed_distance(field.ground[k].shape, to) <= 0)
      return land_on_ground(field, static_cast<int>(k), to);
  return std::nullopt;
}

}  // namespace

FallenOn::FallenOn(const Field& field) {
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    const Organ& organ = field.organs[k];
    if (organ.body->is_line()) continue;
    Skin skin{OrganIndex(k), organ.body->skin_positions(organ.state.x), &organ.body->skin().triangles,
              static_cast<std::size_t>(organ.body->triangles_each())};
    skin.patches.resize(skin.triangles->size() / skin.each);
    for (std::size_t t = 0; t < skin.triangles->size(); ++t)
      for (int corner : (*skin.triangles)[t]) skin.patches[t / skin.each].extend(skin.at[corner]);
    skins_.push_back(std::move(skin));
  }
}

std::optional<FallenOn::Met> FallenOn::meets(const Vec3& from, const Vec3& to) const {
  Eigen::AlignedBox3d way(from, from);
  way.extend(to);
  std::optional<Met> met;
  double first = 1;
  for (const Skin& skin : skins_)
    for (std::size_t patch = 0; patch < skin.patches.size(); ++patch) {
      if (!skin.patches[patch].intersects(way)) continue;
      for (std::size_t k = patch * skin.each; k < (patch + 1) * skin.each; ++k) {
        const Triangle& t = (*skin.triangles)[k];
        const std::optional<double> share = crosses({skin.at[t[0]], skin.at[t[1]], skin.at[t[2]]}, from, to);
        if (!share || *share > first) continue;
        first = *share;
        const Vec3 place = from + first * (to - from);
        const auto away = [&](int corner) { return (skin.at[corner] - place).squaredNorm(); };
        const auto nearer = [&](int one, int other) { return away(one) < away(other); };
        met = Met{skin.organ, *std::min_element(t.begin(), t.end(), nearer)};
      }
    }
  return met;
}

bool fall(Field& field, const FallenOn& skins, Drop& drop, double part) {
  const Vec3 from = drop.at, g = -units::standard_gravity * field.up;
  const Vec3 to = from + part * drop.velocity + 0.5 * part * part * g;
  drop.velocity += part * g;
  drop.at = to;
  if (const std::optional<Landing> landing = lands(field, skins, from, to)) {
    spread_drop(field.spill, drop, *landing);
    return true;
  }
  if (!has_fallen_away(field, to)) return false;
  field.spill.out_of_sight[static_cast<std::size_t>(drop.liquid)] += drop.volume;
  return true;
}

Mouth mouth_of(const Organ& organ, const Opening& opening) {
  const VecX& x = organ.state.x;
  const Vec3 at = organ.body->skin_point(opening.point, x);
  if (!organ.body->is_line()) return {at, organ.body->skin_normals(x)[opening.point]};
  const RodBody* rod = organ.body->as_tube();
  if (rod != nullptr && !is_end(*rod, opening))
    return {organ.body->surface_point(opening.point, x), organ.body->skin_normals(x)[opening.point]};
  const int inner = opening.point == 0 ? 1 : opening.point - 1;
  return {at, (at - organ.body->skin_point(inner, x)).normalized()};
}

void let_fall(Field& field, double duration, std::optional<FallenOn>& skins) {
  for (Organ& organ : field.organs) {
    const auto* tube = std::get_if<TubeShape>(&organ.definition.shape);
    for (Opening& opening : organ.openings) {
      if (!(opening.drop > 0)) continue;
      const double speed = std::min(fastest, slowed * opening.rate / width_of(organ, opening));
      const double whole = speed > jet ? jet_volume : drop_volume;
      const auto full = static_cast<int>(opening.drop / whole);
      if (full == 0 && opening.rate > 0) continue;
      const auto [at, out] = mouth_of(organ, opening);
      const int drops = std::max(1, full);
      const double volume = std::min(whole, opening.drop);
      if (!skins) skins.emplace(field);
      for (int k = 0; k < drops; ++k) {
        Drop drop{tube ? tube->carries : Carries::bile, at + 0.5e-3 * out, Vec3::Zero(), volume};
        if (speed > jet) drop.velocity = speed * out;
        opening.drop = std::max(0.0, opening.drop - volume);
        if (!fall(field, *skins, drop, duration * (k + 0.5) / drops)) field.spill.drops.push_back(drop);
      }
    }
  }
}

void drop_clip(Field& field, ClipSize size, const Vec3& from, const Vec3& legs) {
  constexpr double part = 2e-3;  // m: ground is met within it
  const FallenOn skins(field);
  for (Vec3 at = from; !has_fallen_away(field, at); at -= part * field.up) {
    const std::optional<Landing> landing = lands(field, skins, at, at - part * field.up);
    if (!landing) continue;
    field.spill.clips.push_back({size, landing->on, landing->point, legs});
    return;
  }
}

}  // namespace calot
