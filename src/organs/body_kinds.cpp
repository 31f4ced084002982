#include "organs/body_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/suggest.h"
#include "geometry/mesh_io.h"

namespace calot {

const std::vector<BodyKind>& body_kinds() {
  static const std::vector<BodyKind> kinds = {{"pear", make_hollow_organ, released_hollow_organ},
                                              {"sphere", make_hollow_organ, released_hollow_organ},
                                              {"swept", make_hollow_organ, released_hollow_organ},
                                              {"obj", make_hollow_organ, released_hollow_organ},
                                              {"tube", make_tube, released_tube},
                                              {"rigid", make_rigid_organ},
                                              {"lobe", make_lobe, released_lobe}};
  return kinds;
}

Failure of_organ(Failure failure, const OrganDefinition& definition) {
  const std::string* path = mesh_path(definition.shape);
  for (Problem& problem : failure.problems) {
    const std::string mesh = path != nullptr && problem.place.line == 0 ? " (" + *path + ")" : "";
    problem.message = fmt::format("organ '{}'{}: {}", definition.name, mesh, problem.message);
    if (problem.place.line == 0) problem.place = {"", 0, ".shape"};
  }
  return failure;
}

std::vector<std::string> mesh_remarks(const SceneDefinition& scene) {
  std::vector<std::string> lines;
  for (const OrganDefinition& organ : scene.anatomy.organs) {
    const std::string* path = mesh_path(organ.shape);
    const Result<TriMesh> mesh = path != nullptr ? read_obj(*path, 1) : TriMesh{};
    if (!mesh) continue;
    const std::vector<int> unused = unused_points(mesh.value());
    if (unused.empty()) continue;
    lines.push_back(fmt::format("{}: {} of its points {} left out, as no face uses {}: the first is point {}",
                                *path, unused.size(), unused.size() == 1 ? "is" : "are",
                                unused.size() == 1 ? "it" : "them", unused.front() + 1));
  }
  return lines;
}

Result<RestedOrgan> make_organ(const BodyKind& kind, const OrganDefinition& definition,
                               const OrganSetting& setting) {
  Result<RestedOrgan> made = kind.make(definition, setting);
  if (made) made->organ.landmarks = made->organ.body->landmarks();
  return made;
}

Result<RestedOrgan> make_organ(const OrganDefinition& definition, const ContactLoads& loads, const Vec3& up,
                               double tolerance, int levels, FillingLimits* limits, KeptResults* kept) {
  return make_organ(body_kinds()[definition.shape.index()], definition,
                    {loads, up, tolerance, levels, limits, kept});
}

Result<bool> release_held(Organ& organ, const std::string& held) {
  std::vector<HeldRegion> left = organ.definition.held;
  std::vector<std::string> names;
  for (const HeldRegion& region : left) names.push_back(region.name);
  const auto found = std::find(names.begin(), names.end(), held);
  const std::vector<std::string>& before = organ.origin.released;
  if (found == names.end() && std::find(before.begin(), before.end(), held) != before.end())
    return fail(FailureKind::scenario,
                fmt::format("\"{}\" has let go of '{}' already", held, organ.definition.name),
                "release each once");
  if (found == names.end())
    return fail(FailureKind::scenario,
                fmt::format("nothing called \"{}\" holds '{}'", held, organ.definition.name),
                names.empty() ? "nothing holds it" : suggestion(held, names));
  const auto index = static_cast<std::size_t>(found - names.begin());
  left.erase(left.begin() + (found - names.begin()));
  Result<BodyPointer> body = body_kinds()[organ.definition.shape.index()].released(organ, left, index);
  if (!body) return body.failure();
  organ.body = std::move(body).value();
  organ.definition.held = std::move(left);
  organ.origin.released.push_back(held);
  return true;
}

std::optional<Failure> check_clear_of_ground(const Body& body, const ContactLoads& loads) {
  Failure failure{FailureKind::scenario, {}};
  for (const Shape& shape : loads.shapes) {
    double least = std::numeric_limits<double>::infinity();
    Vec3 place = Vec3::Zero();
    for (std::size_t row = 0; row < body.skin_rest().size(); ++row) {
      const double radius = body.is_line() ? body.skin_radii()[row] : 0;
      const double distance = signed_distance(shape, body.skin_rest()[row]) - radius;
      if (distance < least) least = distance, place = 1e3 * body.skin_rest()[row];
    }
    if (least > 0) continue;
    Problem problem;
    problem.message = fmt::format("organ '{}' starts {:.2g} mm inside the {}, at ({:.0f}, {:.0f}, {:.0f}) mm",
                                  body.name(), 1e3 * (contact_inset - least),
                                  std::holds_alternative<Plane>(shape) ? "supporting plane" : "ground",
                                  place.x(), place.y(), place.z());
    problem.hint = "move the organ, or what it lies on, by as much and a little more";
    failure.problems.push_back(std::move(problem));
  }
  if (failure.problems.empty()) return std::nullopt;
  return failure;
}

}  // namespace calot
