#include "liquid/spill.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "base/units.h"
#include "field/between_jaws.h"
#include "geometry/triangle_crossing.h"
#include "liquid/aspirate.h"
#include "liquid/leak.h"
#include "liquid/spill_surface.h"

namespace calot {
namespace {

constexpr double longest_part = 5e-3;     // s
constexpr double drop_volume = 10e-9;     // m^3; of a pipette 20 to 50 (d)
constexpr double jet_volume = 3e-9;       // m^3, of a jet's drop
constexpr double jet = 0.06;              // m/s: slower it drips
constexpr double slowed = 0.4;            // share of its speed that a ragged end leaves a jet (d)
constexpr double fastest = 2.5;           // m/s
constexpr double farthest_fall = 600e-3;  // m: what is farther has fallen away
constexpr double landed = 0.35e-3;        // m, thickness that a drop spreads to
constexpr double sticks = 0.06e-3;        // m, thickness that stays (d)
constexpr double wets = 0.2e-3;           // m, thickness that wets what is dry (d)
constexpr double film_speed = 0.15;       // m/s, at most
constexpr double hangs = 15e-9;           // m^3, of what hangs before it drops off (d)
constexpr double clings = 0.8e-3;         // m, thickness that hangs on an underside without dripping (d)
constexpr double least_drip = 1e-9;       // m^3
constexpr double least_flow = 1e-12;      // m^3, in a part of a step: what would run slower lies still
constexpr std::array<double, liquids> viscosity{bile_viscosity, 4e-3};  // Pa s, of bile and of blood (c)

double volume_of(const WetPoint& wet) { return std::accumulate(wet.volume.begin(), wet.volume.end(), 0.0); }

const Organ* organ_on(const Field& field, int record) {
  const int organ = organ_of_record(field, record);
  return organ < 0 ? nullptr : &field.organs[organ];
}

/// Meshes that films are on are made when they are first met.
void remember_ground(Field& field, int ground) {
  std::vector<WetMeshPointer>& known = field.spill.ground;
  known.resize(field.ground.size());
  WetMeshPointer& mesh = known[static_cast<std::size_t>(ground)];
  if (!mesh) mesh = std::make_shared<const WetMesh>(wet_ground(field.ground[ground].shape, field.middle));
}
void remember_skin(Field& field, const Organ& organ) {
  std::vector<WetMeshPointer>& known = field.spill.skins;
  if (organ.record >= static_cast<int>(known.size())) known.resize(organ.record + 1);
  WetMeshPointer& mesh = known[static_cast<std::size_t>(organ.record)];
  if (!mesh)
    mesh = std::make_shared<const WetMesh>(wet_mesh(organ.body->skin().triangles, organ.body->skin_areas()));
}

Film& film_on(Spill& spill, int on) {
  for (Film& film : spill.films)
    if (film.on == on) return film;
  return spill.films.emplace_back(Film{on, {}});
}

/// What is added to a film's points, put together in their order.
using Added = std::map<int, std::array<double, liquids>>;

void add_to(Film& film, const Added& added) {
  std::vector<WetPoint> out;
  out.reserve(film.wet.size() + added.size());
  auto next = added.begin();
  for (const WetPoint& wet : film.wet) {
    for (; next != added.end() && next->first < wet.point; ++next) out.push_back({next->first, next->second});
    out.push_back(wet);
    if (next == added.end() || next->first != wet.point) continue;
    for (int l = 0; l < liquids; ++l) out.back().volume[l] += next->second[l];
    ++next;
  }
  for (; next != added.end(); ++next) out.push_back({next->first, next->second});
  film.wet = std::move(out);
}

/// Around a point, as many points as the drop covers.
void spread_drop(const Drop& drop, const WetMesh& mesh, int point, Film& film) {
  std::vector<int> covered{point};
  double area = mesh.areas[point];
  for (std::size_t k = 0; k < covered.size() && area * landed < drop.volume; ++k)
    for (int e = mesh.begin[covered[k]]; e < mesh.begin[covered[k] + 1]; ++e) {
      const int other = mesh.beside[e];
      if (std::find(covered.begin(), covered.end(), other) != covered.end()) continue;
      covered.push_back(other);
      area += mesh.areas[other];
    }
  Added added;
  for (int other : covered)
    added[other][static_cast<std::size_t>(drop.liquid)] = drop.volume * mesh.areas[other] / area;
  add_to(film, added);
}

/// By the way to whichever neighbour is nearer, from the first point: the ground is convex.
int walk_to_nearest(const WetMesh& mesh, const Vec3& place) {
  int nearest = 0;
  double least = (mesh.at[0] - place).squaredNorm();
  for (bool more = true; std::exchange(more, false);)
    for (int e = mesh.begin[nearest], end = mesh.begin[nearest + 1]; e < end; ++e) {
      const double squared = (mesh.at[mesh.beside[e]] - place).squaredNorm();
      if (squared >= least) continue;
      least = squared;
      nearest = mesh.beside[e];
      more = true;
    }
  return nearest;
}

// ---- drops

/// What a drop may fall on of the organs: not tubes.
class Skins {
 public:
  explicit Skins(const Field& field) {
    for (std::size_t k = 0; k < field.organs.size(); ++k) {
      const Organ& organ = field.organs[k];
      if (rod_of(organ) != nullptr) continue;
      Skin skin{static_cast<int>(k), organ.body->skin_positions(organ.state.x), {}, {}, {}};
      skin.triangles = &organ.body->skin().triangles;
      skin.each = static_cast<std::size_t>(organ.body->triangles_each());
      skin.patches.resize(skin.triangles->size() / skin.each);
      for (std::size_t t = 0; t < skin.triangles->size(); ++t)
        for (int corner : (*skin.triangles)[t]) skin.patches[t / skin.each].extend(skin.at[corner]);
      skins_.push_back(std::move(skin));
    }
  }
  struct Met {
    int organ = -1, point = 0;
  };
  /// Organ and nearest skin point that are met from outside on the way.
  std::optional<Met> meets(const Vec3& from, const Vec3& to) const {
    Eigen::AlignedBox3d way(from, from);
    way.extend(to);
    std::optional<Met> met;
    double first = 1;
    for (const Skin& skin : skins_)
      for (std::size_t patch = 0; patch < skin.patches.size(); ++patch) {
        if (!skin.patches[patch].intersects(way)) continue;
        for (std::size_t k = patch * skin.each; k < (patch + 1) * skin.each; ++k) {
          const Triangle& t = (*skin.triangles)[k];
          const std::optional<double> share =
              crosses({skin.at[t[0]], skin.at[t[1]], skin.at[t[2]]}, from, to);
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

 private:
  struct Skin {
    int organ;
    std::vector<Vec3> at;
    std::vector<Eigen::AlignedBox3d> patches;  ///< around `each` triangles that follow each other
    const std::vector<Triangle>* triangles;
    std::size_t each;
  };
  /// Share of the way at which it goes through a triangle from its outside.
  static std::optional<double> crosses(const std::array<Vec3, 3>& t, const Vec3& from, const Vec3& to) {
    const Vec3 way = to - from;
    if (!((t[1] - t[0]).cross(t[2] - t[0]).dot(way) < 0)) return std::nullopt;
    const std::optional<double> share = met_at(t, from, way);
    return share && *share >= 0 && *share <= 1 ? share : std::nullopt;
  }
  std::vector<Skin> skins_;
};

/// Of an opening: where it is, and which way out.
std::pair<Vec3, Vec3> mouth_of(const Organ& organ, const Opening& opening) {
  const VecX& x = organ.state.x;
  const Vec3 at = organ.body->skin_point(opening.point, x);
  if (rod_of(organ) == nullptr) return {at, organ.body->skin_normals(x)[opening.point]};
  const int inner = opening.point == 0 ? 1 : opening.point - 1;
  return {at, (at - organ.body->skin_point(inner, x)).normalized()};
}

double width_of(const Organ& organ, const Opening& opening) {
  const RodBody* rod = rod_of(organ);
  if (rod == nullptr) return opening.area;
  return std::numbers::pi * std::pow(std::max(rod->lumen_radius(opening.point), 1e-4), 2);
}

/// A surface and its nearest point that are met on a way.
struct Landing {
  int on, point;
};
std::optional<Landing> lands(Field& field, const Skins& skins, const Vec3& from, const Vec3& to) {
  if (const std::optional<Skins::Met> met = skins.meets(from, to)) {
    const Organ& organ = field.organs[met->organ];
    remember_skin(field, organ);
    return Landing{organ.record, met->point};
  }
  for (std::size_t k = 0; k < field.ground.size(); ++k) {
    if (signed_distance(field.ground[k].shape, to) > 0) continue;
    remember_ground(field, static_cast<int>(k));
    return Landing{-1 - static_cast<int>(k), walk_to_nearest(*field.spill.ground[k], to)};
  }
  return std::nullopt;
}

const WetMesh& mesh_on(const Spill& spill, int on) {
  return on < 0 ? *spill.ground[static_cast<std::size_t>(-1 - on)]
                : *spill.skins[static_cast<std::size_t>(on)];
}

/// Whether it has met something, or is away.
bool fall(Field& field, const Skins& skins, Drop& drop, double part) {
  const Vec3 from = drop.at, g = -units::standard_gravity * field.up;
  const Vec3 to = from + part * drop.velocity + 0.5 * part * part * g;
  drop.velocity += part * g;
  drop.at = to;
  if (const std::optional<Landing> landing = lands(field, skins, from, to)) {
    spread_drop(drop, mesh_on(field.spill, landing->on), landing->point, film_on(field.spill, landing->on));
    return true;
  }
  if (to.norm() < farthest_fall) return false;
  field.spill.out_of_sight[static_cast<std::size_t>(drop.liquid)] += drop.volume;
  return true;
}

/// Drops of what hangs on openings, with the way that they have made since.
void let_fall(Field& field, double duration, std::optional<Skins>& skins) {
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

// ---- films

/// On one surface; what it knows of each point is of the present part of a step.
class FilmFlow {
 public:
  FilmFlow(WetSurface surface, const Vec3& up) : surface_(std::move(surface)), up_(up) {
    thickness_.assign(surface_.at.size(), 0.0);
    moved_.assign(surface_.at.size(), {});
    touched_.assign(surface_.at.size(), 0);
  }

  void run(Film& film, double part, std::vector<Drop>& drops) {
    for (const WetPoint& wet : film.wet)
      thickness_[wet.point] = volume_of(wet) / surface_.mesh->areas[wet.point];
    for (const WetPoint& wet : film.wet) flow_from(wet, part);
    move(film);
    for (WetPoint& wet : film.wet) {
      if (up_.dot(surface_.normals[wet.point]) > 0) continue;
      drip(wet, drops);
      drop_off(film, wet, drops);
    }
  }

 private:
  /// Of its surface, m; of an underside the skin's, so that what hangs draws no more to it.
  double height(int point) const {
    return up_.dot(surface_.at[point]) + std::max(0.0, up_.dot(surface_.normals[point])) * thickness_[point];
  }
  double loose(const WetPoint& wet) const {
    return std::max(0.0, volume_of(wet) - sticks * surface_.mesh->areas[wet.point]);
  }

  /// A sheet's flow to each neighbour that stands lower, until both stand alike.
  void flow_from(const WetPoint& wet, double part) {
    const double mobile = loose(wet), all = volume_of(wet), thickness = thickness_[wet.point];
    if (mobile < least_flow) return;
    const WetMesh& mesh = *surface_.mesh;
    double mu = 0;
    for (int l = 0; l < liquids; ++l) mu += viscosity[l] * wet.volume[l] / all;
    const double here = height(wet.point);
    flows_.clear();
    double sum = 0;
    for (int e = mesh.begin[wet.point]; e < mesh.begin[wet.point + 1]; ++e) {
      const int other = mesh.beside[e];
      const double lower = here - height(other);
      if (!(lower > 0) || (thickness_[other] == 0 && thickness < wets)) continue;
      const double way = (surface_.at[other] - surface_.at[wet.point]).norm();
      const double speed = std::min(film_speed, blood_density * units::standard_gravity * thickness *
                                                    thickness * std::min(1.0, lower / way) / (3 * mu));
      // On level ground what makes both stand alike is less than what would run.
      const double level = 0.25 * lower * std::min(mesh.areas[other], mesh.areas[wet.point]);
      const double flow = std::min(mobile * speed * part / way, level);
      if (flow < least_flow) continue;
      flows_.emplace_back(other, flow);
      sum += flow;
    }
    const double share = sum > 0.6 * mobile ? 0.6 * mobile / sum : 1.0;
    for (const auto& [other, flow] : flows_) {
      touched_[other] = 1;
      touched_[wet.point] = 1;
      for (int l = 0; l < liquids; ++l) {
        const double moved = share * flow * wet.volume[l] / all;
        moved_[other][l] += moved;
        moved_[wet.point][l] -= moved;
      }
      if (thickness_[other] == 0) fresh_.push_back(other);
    }
  }

  void move(Film& film) {
    for (WetPoint& wet : film.wet) {
      if (!touched_[wet.point]) continue;
      for (int l = 0; l < liquids; ++l) wet.volume[l] += std::exchange(moved_[wet.point][l], 0.0);
      touched_[wet.point] = 0;
    }
    std::sort(fresh_.begin(), fresh_.end());
    const auto middle = static_cast<std::ptrdiff_t>(film.wet.size());
    for (int point : fresh_) {
      if (!touched_[point]) continue;  // named twice
      film.wet.push_back({point, std::exchange(moved_[point], {})});
      touched_[point] = 0;
    }
    fresh_.clear();
    std::inplace_merge(film.wet.begin(), film.wet.begin() + middle, film.wet.end(),
                       [](const WetPoint& a, const WetPoint& b) { return a.point < b.point; });
  }

  /// A share of what is there leaves it, into what has left around it.
  static void take(WetPoint& wet, double share, std::array<double, liquids>& taken) {
    for (int l = 0; l < liquids; ++l) {
      taken[l] += share * wet.volume[l];
      wet.volume[l] -= share * wet.volume[l];
    }
  }
  void make_drops(const WetPoint& below, const std::array<double, liquids>& taken,
                  std::vector<Drop>& drops) const {
    for (int l = 0; l < liquids; ++l)
      if (taken[l] > 0)
        drops.push_back({static_cast<Carries>(l),
                         surface_.at[below.point] + 1.5e-3 * surface_.normals[below.point], Vec3::Zero(),
                         taken[l]});
  }

  /// Of an underside, where a film is too thick to hang.
  void drip(WetPoint& wet, std::vector<Drop>& drops) const {
    const double all = volume_of(wet), excess = all - clings * surface_.mesh->areas[wet.point];
    if (excess < least_drip) return;
    std::array<double, liquids> taken{};
    take(wet, excess / all, taken);
    make_drops(wet, taken, drops);
  }

  /// What hangs at a lowest place of an underside.
  void drop_off(Film& film, WetPoint& wet, std::vector<Drop>& drops) const {
    const WetMesh& mesh = *surface_.mesh;
    double hanging = loose(wet);
    if (!(hanging > 0)) return;
    const double here = height(wet.point);
    std::vector<WetPoint*> all{&wet};
    for (int e = mesh.begin[wet.point]; e < mesh.begin[wet.point + 1]; ++e) {
      const int other = mesh.beside[e];
      if (height(other) < here) return;
      const auto at = std::lower_bound(film.wet.begin(), film.wet.end(), other,
                                       [](const WetPoint& w, int point) { return w.point < point; });
      if (at == film.wet.end() || at->point != other) continue;
      hanging += loose(*at);
      all.push_back(&*at);
    }
    if (hanging < hangs) return;
    std::array<double, liquids> taken{};
    for (WetPoint* point : all) take(*point, loose(*point) / volume_of(*point), taken);
    make_drops(wet, taken, drops);
  }

  WetSurface surface_;
  const Vec3& up_;
  std::vector<double> thickness_;  ///< m, total; 0: dry
  std::vector<std::array<double, liquids>> moved_;
  std::vector<char> touched_;
  std::vector<int> fresh_;  ///< dry until now
  std::vector<std::pair<int, double>> flows_;
};

void forget_gone(Field& field) {
  std::erase_if(field.spill.films, [&](const Film& film) {
    if (film.on < 0 || organ_on(field, film.on) != nullptr) return false;
    for (const WetPoint& wet : film.wet)
      for (int l = 0; l < liquids; ++l) field.spill.out_of_sight[l] += wet.volume[l];
    return true;
  });
}

}  // namespace

void drop_clip(Field& field, ClipSize size, const Vec3& from, const Vec3& legs) {
  constexpr double part = 2e-3;  // m: ground is met within it
  const Skins skins(field);
  for (Vec3 at = from; at.norm() < farthest_fall; at -= part * field.up) {
    const std::optional<Landing> landing = lands(field, skins, at, at - part * field.up);
    if (!landing) continue;
    field.spill.clips.push_back({size, landing->on, landing->point, legs});
    return;
  }
}

WetSurface wet_surface(const Field& field, int on) {
  if (on < 0) {
    const WetMeshPointer& mesh = field.spill.ground[static_cast<std::size_t>(-1 - on)];
    return {mesh, mesh->at, mesh->normals};
  }
  const Organ* organ = organ_on(field, on);
  if (organ == nullptr) return {};
  return {field.spill.skins[static_cast<std::size_t>(on)], organ->body->skin_positions(organ->state.x),
          organ->body->skin_normals(organ->state.x)};
}

void spill(Field& field, double duration) {
  Spill& all = field.spill;
  forget_gone(field);
  const int parts = std::max(1, static_cast<int>(std::ceil(duration / longest_part - 1e-9)));
  const double part = duration / parts;
  std::optional<Skins> skins;
  std::map<int, FilmFlow> flows;
  for (int k = 0; k < parts; ++k) {
    if (!all.drops.empty() && !skins) skins.emplace(field);
    std::erase_if(all.drops, [&](Drop& drop) { return fall(field, *skins, drop, part); });
    for (Film& film : all.films) {
      auto at = flows.find(film.on);
      if (at == flows.end())
        at = flows.emplace(film.on, FilmFlow(wet_surface(field, film.on), field.up)).first;
      at->second.run(film, part, all.drops);
    }
  }
  let_fall(field, duration, skins);
}

}  // namespace calot
