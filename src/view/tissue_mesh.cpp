#include "view/tissue_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/field.h"
#include "view/areolar_mesh.h"
#include "view/scatter.h"
#include "view/surfaces.h"

namespace calot {
namespace {

constexpr double spared = 0.6;    // share of its middle's heat that the ends of a strand do not get
constexpr double shrinks = 0.35;  // by which share charred fat is thinner
constexpr double torn_part =
    0.35;                      // of a strand's length: what is drawn of it at either end after it is torn
constexpr double curls = 2.2;  // rad, by which the end of that has curled (d)

/// A ball with dents, about the origin, as thick as 1.
SceneMesh dented_ball(int columns, int rows) {
  return sheet(Material::fat, columns, rows, [](double u, double v) {
    const double a = 2 * std::numbers::pi * u, b = std::numbers::pi * v;
    const Vec3 out(std::sin(b) * std::cos(a), -std::sin(b) * std::sin(a), std::cos(b));
    return Vec3((1 + 0.12 * std::sin(3 * out.x() + 4 * out.y()) * std::cos(3 * out.z())) * out);
  });
}

/// A place on a strand, and which way the strand goes there.
struct LobulePlace {
  Vec3 at, along;  ///< m; unit
};

Vec3 unit_or_front(const Vec3& way) { return way.norm() > 0 ? way.normalized() : Vec3::UnitZ(); }

LobulePlace on_whole(const StrandLine& line, double share) {
  return {line.at(share), unit_or_front(line.to - line.from)};
}

/// What is left at an end of a torn strand has drawn back, and curls up towards the front, as the edge of a cut sheet
/// does: an arc that leaves the end where the strand did. `share`: of that stump, from its end on; `length`: its own, m.
LobulePlace on_stump(const StrandLine& line, bool first, double share, double length) {
  const Vec3 &end = first ? line.from : line.to, &beyond = line.by;
  const Vec3 along = unit_or_front(beyond - end), front = Vec3::UnitZ();
  const Vec3 across = front - along * along.dot(front);
  const Vec3 side = across.norm() > 0.1 ? across.normalized() : along.unitOrthogonal();
  const double turned = curls * share;
  const double radius = length / curls;
  return {end + radius * (std::sin(turned) * along + (1 - std::cos(turned)) * side),
          std::cos(turned) * along + std::sin(turned) * side};
}

/// Stretched along the strand, as lobules are; the volume stays.
void add_lobule(const LobulePlace& place, double radius, double burnt, std::size_t strand, int lobule,
                const SceneMesh& form, SceneMesh& out) {
  const Vec3 &along = place.along, side = along.unitOrthogonal();
  const double longer = 1.1 + 0.5 * share_of(strand, lobule, 0), turned = 6 * share_of(strand, lobule, 1);
  const double thick = radius * (0.75 + 0.5 * share_of(strand, lobule, 2));
  Mat3 shape;
  shape.col(2) = thick * longer * along;
  shape.col(0) = thick * (std::cos(turned) * side + std::sin(turned) * along.cross(side));
  shape.col(1) = along.cross(shape.col(0)) * (0.7 + 0.3 * share_of(strand, lobule, 3));
  const Vec3 off_line = 0.35 * (shape.col(0) + (share_of(strand, lobule, 4) - 0.5) * shape.col(1));
  const Mat3 normal_shape = shape.inverse().transpose();
  // Each shows another part of the pattern.
  const Vec3 pattern =
      11e-3 * Vec3(static_cast<double>(strand % 17), lobule, static_cast<double>(strand % 5));
  const int first = static_cast<int>(out.positions.size());
  for (std::size_t i = 0; i < form.positions.size(); ++i) {
    out.positions.emplace_back(place.at + off_line + shape * form.positions[i]);
    out.normals.emplace_back((normal_shape * form.normals[i]).normalized());
    out.rest_positions.emplace_back(pattern + radius * form.positions[i]);
    out.burnt.push_back(burnt);
  }
  for (const Triangle& t : form.triangles)
    out.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

void add_fat(const Tissue& tissue, const std::vector<Organ>& organs, std::size_t first_strand,
             const SceneMesh& form, SceneMesh& out) {
  const std::vector<StrandLine> lines = strand_lines(tissue, organs);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const StrandLine& line = lines[k];
    const PlacedStrand& strand = tissue.strands->strands()[k];
    const StrandLaw::Setup& law = strand.strand.law.setup();
    const double radius = lobule_radius(strand);
    const bool torn = tissue.torn(k);
    const int lobules = std::max(1, static_cast<int>(std::lround(law.taut / (1.3 * radius))));
    const double heat = tissue.heated_share(k);
    for (int i = 0; i < lobules; ++i) {
      const double share = (i + 0.5) / lobules;
      // Where it is lifted it is heated most, and shrinks.
      const double burnt = heat * (1 - spared * std::abs(2 * share - 1));
      const bool first = share < 0.5;
      const LobulePlace place =
          torn ? on_stump(line, first, 2 * (first ? share : 1 - share), torn_part * law.taut)
               : on_whole(line, share);
      add_lobule(place, (1 - shrinks * burnt) * radius, burnt, first_strand + k, i, form, out);
    }
  }
}

}  // namespace

std::vector<SceneMesh> tissue_meshes(const World& world, SceneDetail detail) {
  static const SceneMesh fine_form = dented_ball(10, 7), coarse_form = dented_ball(6, 3);
  const SceneMesh& form = detail == SceneDetail::coarse ? coarse_form : fine_form;
  SceneMesh fat;
  fat.material = Material::fat;
  AreolarMeshes areolar;
  areolar.fibres.material = Material::areolar;
  areolar.films.material = Material::cobweb;
  const Field& field = world.field();
  std::size_t strands = 0;
  for (const Tissue& tissue : field.tissues) {
    if (tissue.definition.looks == TissueLooks::areolar)
      add_areolar(tissue, field.organs, strands, detail, areolar);
    else
      add_fat(tissue, field.organs, strands, form, fat);
    strands += tissue.strands->strands().size();
  }
  std::vector<SceneMesh> out;
  for (SceneMesh* mesh : {&fat, &areolar.fibres, &areolar.films})
    if (!mesh->triangles.empty()) out.push_back(std::move(*mesh));
  return out;
}

}  // namespace calot
