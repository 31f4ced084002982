#include "view/leaf_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "field/field.h"
#include "joins/skin_place.h"
#include "view/surfaces.h"

namespace calot {
namespace {

constexpr double thickness = 1e-3;       // in units of rest positions: what a whole leaf has
constexpr double above_tubes = 0.25e-3;  // m, of the tubes that it covers: they are drawn by other triangles
constexpr double wrapped = 1.1;          // rad, how far it reaches over a tube's front, beyond its crest (d)
constexpr int columns_a_strand = 3, leaf_rows = 18;

/// One strand, or what several are in the mean.
struct Fibre {
  double at = 0;  ///< m, along the tissue at rest
  Vec3 from = Vec3::Zero(), by = Vec3::Zero(), to = Vec3::Zero();
  double whole = 0, thick = 0;  ///< 1: not torn; m, how far fat stands out before it
};

/// Unit, the way along which a tissue is longest at rest: between two of its strands that lie far apart.
Vec3 long_way(const std::vector<Vec3>& points) {
  const auto furthest = [&](const Vec3& from) {
    return *std::max_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
      return (a - from).squaredNorm() < (b - from).squaredNorm();
    });
  };
  const Vec3 one = furthest(points[0]), other = furthest(one);
  return one == other ? Vec3(Vec3::UnitX()) : Vec3((other - one).normalized());
}

/// In their order along the tissue.
std::vector<Fibre> fibres_of(const Tissue& tissue, const std::vector<Organ>& organs) {
  const std::vector<StrandLine> lines = strand_lines(tissue, organs);
  std::vector<Vec3> rest;
  for (std::size_t k = 0; k < lines.size(); ++k)
    rest.emplace_back(tissue.body->rest().segment<3>(3 * static_cast<Eigen::Index>(k)));
  const Vec3 way = long_way(rest);
  std::vector<Fibre> out;
  for (std::size_t k = 0; k < lines.size(); ++k)
    out.push_back({way.dot(rest[k]), lines[k].from, lines[k].by, lines[k].to, tissue.torn(k) ? 0.0 : 1.0,
                   lobule_radius(tissue.strands->strands()[k])});
  std::sort(out.begin(), out.end(), [](const Fibre& a, const Fibre& b) { return a.at < b.at; });
  return out;
}

/// What the fibres are about `at`: a sheet evens out what its single strands do.
Fibre mean_about(double at, double reach, const std::vector<Fibre>& fibres) {
  Fibre out;
  double sum = 0;
  for (const Fibre& f : fibres) {
    const double weight = std::exp(-std::pow((f.at - at) / reach, 2));
    sum += weight;
    out.from += weight * f.from;
    out.by += weight * f.by;
    out.to += weight * f.to;
    out.whole += weight * f.whole;
    out.thick += weight * f.thick;
  }
  return {at, out.from / sum, out.by / sum, out.to / sum, out.whole / sum, out.thick / sum};
}

/// Strands end on a bent tube here and there; in between it is not where their mean is.
class TubeMiddle {
 public:
  explicit TubeMiddle(const Organ& organ) {
    if (organ.body->is_line()) finder_.emplace(*organ.body, organ.body->skin_positions(organ.state.x));
  }
  /// Of what is no tube: the place itself.
  Vec3 nearest(const Vec3& place) const {
    return finder_ ? finder_->at(finder_->nearest(place).place) : place;
  }

 private:
  std::optional<SkinFinder> finder_;
};

/// Evenly along the tissue, from its first strand to its last.
std::vector<Fibre> evened(const std::vector<Fibre>& fibres, const Organ& one, const Organ& other) {
  const double first = fibres.front().at, whole = fibres.back().at - first;
  const double reach = 1.6 * whole / static_cast<double>(fibres.size() - 1);  // (d)
  const int columns = columns_a_strand * static_cast<int>(fibres.size());
  const TubeMiddle of_one(one), of_other(other);
  std::vector<Fibre> out;
  for (int i = 0; i <= columns; ++i) {
    Fibre mean = mean_about(first + i * whole / columns, reach, fibres);
    mean.from = of_one.nearest(mean.from);
    mean.to = of_other.nearest(mean.to);
    out.push_back(mean);
  }
  return out;
}

/// Unit, across the sheet towards the front: what covers the triangle is its side that the laparoscope sees.
Vec3 front_of(const std::vector<Fibre>& at) {
  const Fibre& middle = at[at.size() / 2];
  const Vec3 along = at.back().by - at.front().by, out = along.cross(middle.to - middle.from).normalized();
  return out.dot(Vec3(0, -0.4, 1)) < 0 ? Vec3(-out) : out;
}

/// What a leaf lies on, and what it is like.
struct Laid {
  std::array<double, 2> radii{};   ///< m, of the two tubes
  std::array<double, 2> beyond{};  ///< m, how far it goes on past either
  double dense = 1;                ///< 1: a veil; 2: full of fat
};

/// Across a fibre, from beyond the crest of one tube, over it and the fat between, to beyond that of the other; v is 0 to 1.
Vec3 across(const Fibre& fibre, const Laid& laid, const Vec3& front, double v) {
  constexpr double past = 0.15;  // of v, where it goes on past a tube
  constexpr double back = 0.6;   // of that way, as far as it falls back
  const std::array<double, 2>& radii = laid.radii;
  const Vec3 way = (fibre.to - fibre.from).normalized();
  const Vec3 up = (front - way * way.dot(front)).normalized();
  constexpr double over_tube = 0.22;  // of v, at either end
  const auto on_tube = [&](const Vec3& middle, double radius, double angle) -> Vec3 {
    return middle + (radius + above_tubes) * (std::cos(angle) * up + std::sin(angle) * way);
  };
  const std::array<double, 2> free{laid.beyond[0] > 0 ? past : 0, laid.beyond[1] > 0 ? past : 0};
  if (v < free[0])
    return on_tube(fibre.from, radii[0], -wrapped) - laid.beyond[0] * (1 - v / past) * (way + back * up);
  if (v > 1 - free[1])
    return on_tube(fibre.to, radii[1], wrapped) + laid.beyond[1] * (1 - (1 - v) / past) * (way - back * up);
  v = (v - free[0]) / (1 - free[0] - free[1]);
  if (v < over_tube) return on_tube(fibre.from, radii[0], -wrapped * (1 - v / over_tube));
  if (v > 1 - over_tube) return on_tube(fibre.to, radii[1], wrapped * (1 - (1 - v) / over_tube));
  const double t = (v - over_tube) / (1 - 2 * over_tube);
  const Vec3 one = on_tube(fibre.from, radii[0], 0), other = on_tube(fibre.to, radii[1], 0);
  constexpr double dents = 1.6;  // times a lobule's radius: as far as it stands out (view/tissue_mesh.cpp)
  const Vec3 top = fibre.by + dents * fibre.thick * up;
  const Vec3 middle = 2 * top - 0.5 * (one + other);  // of the parabola through all three
  return (1 - t) * (1 - t) * one + 2 * t * (1 - t) * middle + t * t * other;
}

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

void face(SceneMesh& mesh, const Vec3& front) {
  if (mesh.normals[mesh.normals.size() / 2].dot(front) < 0) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    for (Vec3& n : mesh.normals) n = -n;
  }
  // It lies on a layer of fat that evens out its creases, but for their faintest part.
  for (Vec3& n : mesh.normals) n = (n + 0.8 * front).normalized();
}

/// Along and across, and how much of it is there: it thins out at its rim and towards what is torn.
void lay_out(SceneMesh& mesh, const std::vector<Fibre>& at, double width, double dense) {
  const std::size_t columns = at.size() - 1;
  for (std::size_t p = 0; p < mesh.positions.size(); ++p) {
    const Fibre& fibre = at[p % at.size()];
    const double u = static_cast<double>(p % at.size()) / static_cast<double>(columns),
                 v = static_cast<double>(p / at.size()) / leaf_rows;
    const double rim = smooth_step(0, 0.15, std::min(u, 1 - u)) * smooth_step(0, 0.2, std::min(v, 1 - v));
    mesh.rest_positions[p] = {fibre.at - at.front().at, v * width,
                              thickness * dense * rim * smooth_step(0.35, 0.75, fibre.whole)};
  }
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](int p) { return mesh.rest_positions[p].z() == 0; });
  });
}

/// Over tubes, or other organs, between which the fibres run.
void add_leaf(const std::vector<Fibre>& fibres, const Organ& one, const Organ& other, SceneMesh& out,
              Laid laid = {}) {
  if (fibres.size() < 3 || !(fibres.front().at < fibres.back().at)) return;
  laid.radii = {one.body->thickest(), other.body->thickest()};
  const std::vector<Fibre> at = evened(fibres, one, other);
  const Vec3 front = front_of(at);
  const int columns = static_cast<int>(at.size()) - 1;
  SceneMesh mesh = sheet(Material::leaf, columns, leaf_rows, [&](double u, double v) {
    return across(at[static_cast<std::size_t>(std::lround(u * columns))], laid, front, v);
  });
  face(mesh, front);
  const Fibre& middle = at[at.size() / 2];
  const double width = (middle.to - middle.from).norm() + laid.radii[0] + laid.radii[1];
  lay_out(mesh, at, width + laid.beyond[0] + laid.beyond[1], laid.dense);
  append(out, mesh);
}

/// Of a leaf that lies over two tubes: from each point of the first one's part to the nearest place of the other.
std::vector<Fibre> fibres_between(const Organ& one, const Organ& other, const LeafDefinition& leaf) {
  constexpr double fat = 1e-3;  // m, as thick as under it (d)
  const std::vector<Vec3>& rest = one.body->skin_rest();
  const std::vector<Vec3> line = one.body->skin_positions(one.state.x);
  std::vector<double> way{0};
  for (std::size_t k = 1; k < rest.size(); ++k) way.push_back(way.back() + (rest[k] - rest[k - 1]).norm());
  const TubeMiddle of_other(other);
  std::vector<Fibre> out;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (way[k] < leaf.start * way.back() || way[k] > leaf.stop * way.back()) continue;
    const Vec3 to = of_other.nearest(line[k]);
    out.push_back({way[k], line[k], 0.5 * (line[k] + to), to, 1, fat});
  }
  return out;
}

/// Nothing where one of the tubes is gone or was divided.
void add_leaf(const LeafDefinition& leaf, const Field& field, SceneMesh& out) {
  const std::optional<OrganIndex> from = organ_called(field, leaf.from), to = organ_called(field, leaf.to);
  if (!from || !to) return;
  const Organ &one = field.organ(*from), &other = field.organ(*to);
  if (one.body->is_line() && other.body->is_line())
    add_leaf(fibres_between(one, other, leaf), one, other, out,
             {.beyond = {leaf.free_edge, leaf.goes_on}, .dense = 2});
}

}  // namespace

SceneMesh leaf_mesh(const World& world) {
  SceneMesh out;
  out.material = Material::leaf;
  const Field& field = world.field();
  for (const Tissue& tissue : field.tissues) {
    const std::array<int, 2> bodies = tissue.strands->bodies();
    if (tissue.definition.covered)
      add_leaf(fibres_of(tissue, field.organs), field.organs[bodies[0]], field.organs[bodies[1]], out);
  }
  for (const LeafDefinition& leaf : world.scene().anatomy.leaves) add_leaf(leaf, field, out);
  return out;
}

}  // namespace calot
