#include "liquid/films.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/units.h"
#include "liquid/aspirate.h"
#include "liquid/leak_source.h"
#include "liquid/spill_surface.h"

namespace calot {
namespace {

constexpr double landed = 0.35e-3;    // m, thickness that a drop spreads to
constexpr double sticks = 0.06e-3;    // m, thickness that stays (d)
constexpr double wets = 0.2e-3;       // m, thickness that wets what is dry (d)
constexpr double film_speed = 0.15;   // m/s, at most
constexpr double hangs = 15e-9;       // m^3, of what hangs before it drops off (d)
constexpr double clings = 0.8e-3;     // m, thickness that hangs on an underside without dripping (d)
constexpr double least_drip = 1e-9;   // m^3
constexpr double least_flow = 1e-12;  // m^3, in a part of a step: what would run slower lies still
constexpr std::array<double, liquids> viscosities{bile_viscosity, 4e-3};  // Pa s, of bile and of blood (c)

double volume_of(const WetPoint& wet) { return std::accumulate(wet.volume.begin(), wet.volume.end(), 0.0); }

const Organ* organ_on(const Field& field, int record) {
  const std::optional<OrganIndex> organ = organ_of_record(field, record);
  return organ ? &field.organ(*organ) : nullptr;
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
  film.rest.reset();
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

const WetMesh& mesh_on(const Spill& spill, int on) {
  return on < 0 ? *spill.ground[static_cast<std::size_t>(-1 - on)]
                : *spill.skins[static_cast<std::size_t>(on)];
}

}  // namespace

void spread_drop(Spill& spill, const Drop& drop, const Landing& landing) {
  const WetMesh& mesh = mesh_on(spill, landing.on);
  std::vector<int> covered{landing.point};
  double area = mesh.areas[landing.point];
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
  add_to(film_on(spill, landing.on), added);
}

Landing land_on_ground(Field& field, int ground, const Vec3& place) {
  std::vector<WetMeshPointer>& known = field.spill.ground;
  known.resize(field.ground.size());
  WetMeshPointer& mesh = known[static_cast<std::size_t>(ground)];
  if (!mesh) mesh = std::make_shared<const WetMesh>(wet_ground(field.ground[ground].shape, field.middle));
  return {-1 - ground, walk_to_nearest(*mesh, place)};
}

Landing land_on_skin(Field& field, const Organ& organ, int point) {
  std::vector<WetMeshPointer>& known = field.spill.skins;
  if (organ.record >= static_cast<int>(known.size())) known.resize(organ.record + 1);
  WetMeshPointer& mesh = known[static_cast<std::size_t>(organ.record)];
  if (!mesh)
    mesh = std::make_shared<const WetMesh>(wet_mesh(organ.body->skin().triangles, organ.body->skin_areas()));
  return {organ.record, point};
}

bool lies_still(const Field& field, const Film& film, double part) {
  if (!film.rest || film.rest->part != part || film.rest->up != field.up) return false;
  const Organ* organ = film.on < 0 ? nullptr : organ_on(field, film.on);
  return organ == nullptr || (organ->body == film.rest->body && organ->state.x == film.rest->x);
}

FilmRest rest_of(const Field& field, const Film& film, double part) {
  const Organ* organ = film.on < 0 ? nullptr : organ_on(field, film.on);
  if (organ == nullptr) return {part, field.up, nullptr, {}};
  return {part, field.up, organ->body, organ->state.x};
}

FilmFlow::FilmFlow(WetSurface surface, const Vec3& up) : surface_(std::move(surface)), up_(up) {
  thickness_.assign(surface_.at.size(), 0.0);
  moved_.assign(surface_.at.size(), {});
  touched_.assign(surface_.at.size(), 0);
}

bool FilmFlow::run(Film& film, double part, std::vector<Drop>& drops) {
  for (const WetPoint& wet : film.wet)
    thickness_[wet.point] = volume_of(wet) / surface_.mesh->areas[wet.point];
  bool moves = false;
  for (const WetPoint& wet : film.wet) moves = flow_from(wet, part) || moves;
  move(film);
  for (WetPoint& wet : film.wet) {
    if (up_.dot(surface_.normals[wet.point]) > 0) continue;
    moves = drip(wet, drops) || moves;
    moves = drop_off(film, wet, drops) || moves;
  }
  return moves;
}

double FilmFlow::height(int point) const {
  return up_.dot(surface_.at[point]) + std::max(0.0, up_.dot(surface_.normals[point])) * thickness_[point];
}

double FilmFlow::loose(const WetPoint& wet) const {
  return std::max(0.0, volume_of(wet) - sticks * surface_.mesh->areas[wet.point]);
}

bool FilmFlow::flow_from(const WetPoint& wet, double part) {
  const double mobile = loose(wet), all = volume_of(wet), thickness = thickness_[wet.point];
  if (mobile < least_flow) return false;
  const WetMesh& mesh = *surface_.mesh;
  double mu = 0;
  for (int l = 0; l < liquids; ++l) mu += viscosities[l] * wet.volume[l] / all;
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
  return !flows_.empty();
}

void FilmFlow::move(Film& film) {
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

void FilmFlow::take(WetPoint& wet, double share, std::array<double, liquids>& taken) {
  for (int l = 0; l < liquids; ++l) {
    taken[l] += share * wet.volume[l];
    wet.volume[l] -= share * wet.volume[l];
  }
}

void FilmFlow::make_drops(const WetPoint& below, const std::array<double, liquids>& taken,
                          std::vector<Drop>& drops) const {
  for (int l = 0; l < liquids; ++l)
    if (taken[l] > 0)
      drops.push_back({static_cast<Carries>(l),
                       surface_.at[below.point] + 1.5e-3 * surface_.normals[below.point], Vec3::Zero(),
                       taken[l]});
}

bool FilmFlow::drip(WetPoint& wet, std::vector<Drop>& drops) const {
  const double all = volume_of(wet), excess = all - clings * surface_.mesh->areas[wet.point];
  if (excess < least_drip) return false;
  std::array<double, liquids> taken{};
  take(wet, excess / all, taken);
  make_drops(wet, taken, drops);
  return true;
}

bool FilmFlow::drop_off(Film& film, WetPoint& wet, std::vector<Drop>& drops) const {
  const WetMesh& mesh = *surface_.mesh;
  double hanging = loose(wet);
  if (!(hanging > 0)) return false;
  const double here = height(wet.point);
  std::vector<WetPoint*> all{&wet};
  for (int e = mesh.begin[wet.point]; e < mesh.begin[wet.point + 1]; ++e) {
    const int other = mesh.beside[e];
    if (height(other) < here) return false;
    const auto at = std::lower_bound(film.wet.begin(), film.wet.end(), other,
                                     [](const WetPoint& w, int point) { return w.point < point; });
    if (at == film.wet.end() || at->point != other) continue;
    hanging += loose(*at);
    all.push_back(&*at);
  }
  if (hanging < hangs) return false;
  std::array<double, liquids> taken{};
  for (WetPoint* point : all) take(*point, loose(*point) / volume_of(*point), taken);
  make_drops(wet, taken, drops);
  return true;
}

void forget_films_of_gone(Field& field) {
  std::erase_if(field.spill.films, [&](const Film& film) {
    if (film.on < 0 || organ_on(field, film.on) != nullptr) return false;
    for (const WetPoint& wet : film.wet)
      for (int l = 0; l < liquids; ++l) field.spill.out_of_sight[l] += wet.volume[l];
    return true;
  });
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

}  // namespace calot
