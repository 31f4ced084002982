#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/units.h"
#include "body/rigid_body.h"
#include "geometry/mesh_io.h"
#include "geometry/solid_surface.h"
#include "geometry/turn.h"
#include "organs/body_kinds.h"

namespace calot {
namespace {

using units::mm;
/// m: contact points lie between. What is sharp has them closer, or a tool's edge would come in between two.
double spacing_of(const RigidShape& rigid) { return std::clamp(rigid.rounding, 0.5 * mm, 1.5 * mm); }
constexpr double longest_edge = 2 * mm;  // of a file's surface: what touches it is thicker
constexpr double least_size = 2 * mm, largest_size = 200 * mm;
constexpr std::size_t most_contact_triangles = 12000;

Failure wrong_mesh(const std::string& what, const std::string& hint) {
  return fail(FailureKind::scenario, "the mesh " + what, hint);
}

Result<TriMesh> file_surface(const RigidShape& rigid) {
  Result<TriMesh> mesh = read_obj(rigid.path, rigid.scale);
  if (!mesh) return mesh;
  TriMesh used = without_unused_points(mesh.value());
  Eigen::AlignedBox3d box;
  for (const Vec3& p : used.points) box.extend(p);
  const double size = box.diagonal().norm();
  if (!(size >= least_size && size <= largest_size))
    return wrong_mesh(
        fmt::format("is {:.3g} mm across", size / mm),
        fmt::format("its coordinates times its scale are metres: give a thing of {:g} to {:g} mm",
                    least_size / mm, largest_size / mm));
  if (mesh->triangles.size() > most_contact_triangles)
    return wrong_mesh(fmt::format("has {} triangles", mesh->triangles.size()),
                      fmt::format("simplify it to at most {}", most_contact_triangles));
  const int any = static_cast<int>(mesh->points.size());
  std::vector<Problem> problems =
      check(mesh.value(), {.most_edges_at_a_point = any, .counted_from = 1, .unused_points = true});
  if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
  TriMesh fine = with_short_edges(std::move(used), longest_edge, most_contact_triangles);
  if (fine.triangles.size() > most_contact_triangles)
    return wrong_mesh(fmt::format("has too large a surface to be touched every {:g} mm", longest_edge / mm),
                      "make the thing smaller, or simpler");
  return fine;
}

/// Before it is turned.
Result<TriMesh> upright_surface(const RigidShape& rigid) {
  if (rigid.path.empty() && rigid.ring == 0)
    return rounded_box(rigid.size, rigid.rounding, rigid.centre, spacing_of(rigid));
  Result<TriMesh> surface =
      rigid.ring > 0 ? ring_surface(rigid.ring, rigid.rounding, spacing_of(rigid)) : file_surface(rigid);
  if (surface)
    for (Vec3& p : surface->points) p += rigid.centre;
  return surface;
}

std::map<std::string, Vec3> rim_places(const RigidShape& rigid) {
  std::map<std::string, Vec3> places;
  for (const Landmark& row : landmark_rows())
    if (row.of == Landmark::Of::ring && rigid.ring > 0) {
      const double angle = 2 * M_PI * row.along;
      places[row.name] = rigid.centre + turned_about(rigid.turn) * Vec3(rigid.ring * std::cos(angle),
                                                                        rigid.ring * std::sin(angle), 0);
    }
  return places;
}

}  // namespace

Result<TriMesh> rigid_surface(const OrganDefinition& definition) {
  const auto& rigid = std::get<RigidShape>(definition.shape);
  Result<TriMesh> surface = upright_surface(rigid);
  if (!surface) return of_organ(surface.failure(), definition);
  if (rigid.turn == Vec3::Zero()) return surface;
  const Mat3 turned = turned_about(rigid.turn);
  for (Vec3& p : surface->points) p = rigid.centre + turned * (p - rigid.centre);
  return surface;
}

Result<RestedOrgan> make_rigid_organ(const OrganDefinition& definition, const OrganSetting& setting) {
  const auto& rigid = std::get<RigidShape>(definition.shape);
  Result<TriMesh> surface = rigid_surface(definition);
  if (!surface) return surface.failure();
  return organ_as_drawn(definition,
                        RigidBody::create({definition.name, std::move(surface).value(), rigid.density,
                                           rigid.stiffness, setting.up, rim_places(rigid)}),
                        setting);
}

}  // namespace calot
