#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "anatomy/organ_frame.h"
#include "geometry/mesh_io.h"
#include "geometry/shapes.h"
#include "geometry/turn.h"
#include "organs/body_kinds.h"
#include "skin/subdivision.h"
#include "tools/instrument.h"

namespace calot {
namespace {

/// A file's points in the organ's frame.
Result<TriMesh> file_mesh(const MeshFile& file, const OrganDefinition& definition) {
  Result<TriMesh> mesh = read_obj(file.path, file.scale);
  if (!mesh) return mesh;
  Pose placed = Pose(turned_about(file.turn)).pretranslate(file.offset);
  if (file.axes == MeshAxes::scene) placed = organ_frame(definition).inverse() * placed;
  for (Vec3& p : mesh->points) p = placed * p;
  return mesh;
}

/// Vertices of the unstressed surface in the organ's frame; that of ours has its lower pole at the origin.
Result<TriMesh> unstressed_mesh(const OrganDefinition& definition) {
  if (const auto* file = std::get_if<MeshFile>(&definition.shape)) return file_mesh(*file, definition);
  if (const auto* sphere = std::get_if<SphereShape>(&definition.shape)) {
    Result<TriMesh> mesh = revolve(sphere_profile(sphere->radius), definition.nodes);
    // The profile is centred; the organ stands on its lower pole.
    if (mesh)
      for (Vec3& p : mesh->points) p.z() += sphere->radius;
    return mesh;
  }
  if (const auto* swept = std::get_if<SweptShape>(&definition.shape)) {
    const SweptForm form(swept->along, definition.liver_side);
    Result<TriMesh> mesh =
        revolve(form.profile(), definition.nodes, [&](const Vec3& p) { return form.spacing(p); });
    const Pose to_organ = organ_frame(definition).inverse();
    if (mesh)
      for (Vec3& p : mesh->points) p = to_organ * form.bent(p);
    return mesh;
  }
  const auto& pear = std::get<PearShape>(definition.shape);
  const Vec3 fundus(0, 0, pear.length);
  // Finer where the pear narrows, and within the radius of the fundus, fading out over another radius.
  const auto spacing = [&](const Vec3& p) {
    const double far = ((p - fundus).norm() - pear.refine_radius) / pear.refine_radius;
    const double blend = std::min(1.0, std::max(0.0, far));
    const double near = 1.0 / pear.refine;
    return pear_spacing(p, pear.length) * (near + (1.0 - near) * blend * blend * (3 - 2 * blend));
  };
  return revolve(pear_profile(pear.length, pear.width), definition.nodes, spacing);
}

constexpr double largest_organ = 0.4, smallest_organ = 5e-3;  // m
constexpr std::size_t most_triangles = 4 * most_nodes;        // a closed surface has about two a node

/// What a mesh file may bring: neither a file in millimetres read as metres, nor one in metres scaled down, nor a
/// scan of a million triangles.
std::optional<Failure> check_size(const TriMesh& mesh, const std::string& organ) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.points) box.extend(p);
  const double size = box.diagonal().norm();
  if (size > largest_organ)
    return fail(FailureKind::scenario, fmt::format("the mesh of organ '{}' is {:.3g} m across", organ, size),
                "give its scale: 0.001 for a file in millimetres");
  if (!(size >= smallest_organ))
    return fail(FailureKind::scenario, fmt::format("the mesh of organ '{}' is {:.3g} m across", organ, size),
                fmt::format("its coordinates times its scale are metres: at least {} m", smallest_organ));
  if (mesh.triangles.size() > most_triangles)
    return fail(FailureKind::scenario,
                fmt::format("the mesh of organ '{}' has {} triangles", organ, mesh.triangles.size()),
                fmt::format("simplify it to at most {}", most_triangles));
  if (mesh.points.size() > static_cast<std::size_t>(most_nodes))
    return fail(
        FailureKind::scenario,
        fmt::format("the mesh of organ '{}' has {} vertices", organ, mesh.points.size()),
        fmt::format("simplify it to at most {}: they are control points, the skin is smooth", most_nodes));
  return std::nullopt;
}

/// The unstressed mesh where it can be a control mesh.
Result<TriMesh> sound_mesh(const OrganDefinition& definition) {
  Result<TriMesh> mesh = unstressed_mesh(definition);
  if (!mesh) return of_organ(mesh.failure(), definition);
  const bool file = std::holds_alternative<MeshFile>(definition.shape);
  const TriMesh used = file ? without_unused_points(mesh.value()) : mesh.value();
  if (std::optional<Failure> failure = check_size(used, definition.name)) {
    failure->problems.front().place.path = ".shape";
    return *failure;
  }
  std::vector<Problem> problems = check(mesh.value(), {.counted_from = file ? 1 : 0, .unused_points = file});
  if (!problems.empty()) return of_organ({FailureKind::scenario, std::move(problems)}, definition);
  return used;
}

/// Control mesh in the world whose limit surface passes through the unstressed vertices; a mesh file is a
/// control mesh already unless it says otherwise.
Result<TriMesh> control_mesh(const OrganDefinition& definition) {
  Result<TriMesh> mesh = sound_mesh(definition);
  if (!mesh) return mesh;
  const auto* file = std::get_if<MeshFile>(&definition.shape);
  if (file == nullptr || file->through_points) {
    Result<LoopSurface> surface = LoopSurface::create(mesh.value());
    if (!surface) return of_organ(surface.failure(), definition);
    Result<std::vector<Vec3>> fitted = fit_to_limit(surface.value(), mesh->points);
    if (!fitted) return of_organ(fitted.failure(), definition);
    mesh->points = fitted.value();
  }
  const Pose frame = organ_frame(definition);
  for (Vec3& p : mesh->points) p = frame * p;
  return mesh;
}

ShellMaterial wall_material(const OrganDefinition& definition) {
  const WallDefinition& wall = definition.wall;
  ShellMaterial material;
  material.membrane = {wall.shear_modulus, wall.thickness, wall.stiffening};
  material.bending = {wall.shear_modulus, wall.thickness};
  if (wall.fibres) {
    const FibreFamily family{wall.fibres->stiffness, wall.fibres->stiffening, wall.thickness};
    material.fibres = FibreLayout{family, wall.fibres->angle, definition.fundus - definition.neck};
  }
  return material;
}

/// Of a shape from a file, a landmark's place on the wall: at the ends of the organ's axis (unit) the wall's last point
/// that way, else the one nearest to where the landmark is in the box around it.
Vec3 on_wall(const Landmark& row, const Vec3& in_box, const Vec3& axis, const std::vector<Vec3>& wall) {
  const auto rank = [&](const Vec3& p) {
    if (row.side != 0 || (row.along > 0 && row.along < 1)) return (p - in_box).squaredNorm();
    return row.along > 0 ? -p.dot(axis) : p.dot(axis);
  };
  return *std::min_element(wall.begin(), wall.end(),
                           [&](const Vec3& a, const Vec3& b) { return rank(a) < rank(b); });
}

/// Where the analytic landmarks lie, m, world.
std::map<std::string, Vec3> landmark_places(const OrganDefinition& definition,
                                            const std::vector<Vec3>& skin) {
  const Pose frame = organ_frame(definition);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : skin) box.extend(frame.inverse() * p);
  std::map<std::string, Vec3> places;
  if (const auto* swept = std::get_if<SweptShape>(&definition.shape)) {
    const SweptForm form(swept->along, definition.liver_side);
    for (const Landmark& row : landmark_rows())
      if (has_landmark(definition.shape, row)) {
        const double z = row.along * form.length();
        places[row.name] = form.bent({row.side * form.radius(z), 0, z});
      }
    return places;
  }
  const bool file = std::holds_alternative<MeshFile>(definition.shape);
  for (const Landmark& row : landmark_rows()) {
    if (!has_landmark(definition.shape, row)) continue;
    const Vec3 share(0.5 * (1 + row.side), 0.5, row.along);
    places[row.name] =
        frame * Vec3(share.cwiseProduct(box.max()) + (Vec3::Ones() - share).cwiseProduct(box.min()));
    if (file) places[row.name] = on_wall(row, places[row.name], frame.linear().col(2), skin);
  }
  return places;
}

/// No tool has moved yet: the advice is about the organ.
Failure fill_failure(const NewtonResult& result, const std::string& organ, const FillingLimits* limits) {
  if (result.status == NewtonStatus::stopped && limits->node_iterations > 0)
    return fail(FailureKind::interrupted, fmt::format("interrupted while organ '{}' was filled", organ));
  if (result.status == NewtonStatus::stopped)
    return fail(
        FailureKind::resource,
        fmt::format("organ '{}' takes too long to fill: more Newton iterations than fit half a minute",
                    organ),
        "give it fewer nodes, or a volume or pressure nearer to what it holds unstressed", {"", 0, ".bile"});
  Failure failure = no_rest_failure(result, organ, "while it was filled");
  Problem& problem = failure.problems.front();
  if (limits != nullptr && limits->sinks)
    problem.hint =
        "let something hold or support it so that it neither falls nor slides for good, fill it less (bile), "
        "or give it a thicker or stiffer wall, or more nodes";
  else if (result.status != NewtonStatus::mechanism)
    problem.hint = "fill it less (bile), or give it a thicker or stiffer wall, or more nodes";
  problem.place.path = ".bile";
  return failure;
}

/// A rest of the organ as it is filled now.
NewtonResult rest(const Member& member, const NewtonSettings& settings, NewtonWorkspace& work,
                  const SettleOptions& options, const FillingLimits* limits) {
  const BodyState before = member.state;
  const NewtonResult result = settle(member, settings, work, options);
  if (result.converged() || result.status == NewtonStatus::stopped || limits == nullptr || !limits->sinks)
    return result;
  member.state = before;
  return sink(member, settings, work, options);
}

/// Volume and pressure that the author asked for, by small steps from the unstressed shape.
Result<bool> fill(RestedOrgan& filled, const ContactLoads& loads, const NewtonSettings& settings,
                  const FillingLimits* limits) {
  Organ& organ = filled.organ;
  const BileDefinition& bile = organ.definition.bile;
  const Bile& liquid = *organ.body->as_shell()->bile();
  const Member member{*organ.body, loads, organ.search, organ.state};
  const double unstressed = liquid.volume(organ.state.x);
  if (bile.fill_pressure) {
    // The pressure at the highest point depends on where that point settles: a fixed point of few rounds.
    double aim = 0;
    bool settled = false;
    for (int round = 0; round < 40 && !settled; ++round) {
      const double ramp = std::min(1.0, 0.25 * (round + 1));
      const double offset = liquid.pressure_at_top(organ.state.x, 0.0);
      const double next = ramp * *bile.fill_pressure - offset;
      organ.state.datum_pressure = next;
      const NewtonResult result = rest(member, settings, filled.work, {.fixed_pressures = true}, limits);
      if (!result.converged()) return fill_failure(result, organ.definition.name, limits);
      settled = ramp == 1.0 && std::abs(next - aim) <= 1e-9 * std::abs(next);
      aim = next;
    }
    if (!settled)
      return fail(FailureKind::simulation,
                  fmt::format("the pressure at the top of organ '{}' does not settle", organ.definition.name),
                  "give fill_volume instead of fill_pressure, or a thicker or stiffer wall",
                  {"", 0, ".bile.fill_pressure"});
    organ.state.volume = liquid.volume(organ.state.x);
  } else {
    const double target = bile.fill_volume.value_or(unstressed);
    if (target > 8 * unstressed || target < 0.2 * unstressed)
      return fail(FailureKind::scenario,
                  fmt::format("organ '{}' holds {:.3g} mL unstressed and cannot take {:.3g} mL",
                              organ.definition.name, 1e6 * unstressed, 1e6 * target),
                  "give a fill_volume nearer to the shape's own", {"", 0, ".bile.fill_volume"});
    const int steps = 1 + static_cast<int>(std::ceil(std::abs(target - unstressed) / (0.05 * unstressed)));
    for (int k = 1; k <= steps; ++k) {
      organ.state.volume = unstressed + (target - unstressed) * k / steps;
      const NewtonResult result = rest(member, settings, filled.work, {}, limits);
      if (!result.converged()) return fill_failure(result, organ.definition.name, limits);
    }
  }
  return true;
}

/// Whether filling blows up a shape of ours, which brings no wall nearer to another: then there is nothing to look for
/// on the long steps of filling.
bool swells(const Organ& organ) {
  const BileDefinition& bile = organ.definition.bile;
  if (std::holds_alternative<MeshFile>(organ.definition.shape)) return false;
  return bile.fill_pressure ? *bile.fill_pressure >= 0
                            : bile.fill_volume.value_or(organ.state.volume) >= organ.state.volume;
}

using Places = std::map<std::string, Vec3>;  ///< m, of the landmarks

Result<Places> places_on(const OrganDefinition& definition, const TriMesh& control) {
  const Result<LoopSurface> surface = LoopSurface::create(control);
  if (!surface) return surface.failure();
  const Tessellation corners = surface->tessellate(1);
  return landmark_places(definition,
                         blend_all(corners.stencils, corners.stencils.value, to_coordinates(control.points)));
}

/// N/m per m^2, at a place of the wall.
std::function<double(const Vec3& x)> foundation_of(const std::vector<HeldRegion>& held,
                                                   const Places& places) {
  return [held, places](const Vec3& x) {
    double stiffness = 0;
    for (const HeldRegion& region : held)
      if ((x - places.at(region.landmark)).norm() < region.radius) stiffness += region.stiffness;
    return stiffness;
  };
}

/// The organ's wall and bile over its control mesh; `places`: of its landmarks, where it may be held.
ShellBody::Setup shell_setup(const OrganDefinition& definition, const OrganSetting& setting,
                             const TriMesh& control, const Places& places) {
  ShellBody::Setup setup;
  setup.name = definition.name;
  setup.control = control;
  setup.material = wall_material(definition);
  setup.bile = definition.bile;
  setup.up = setting.up;
  setup.levels = setting.levels;
  setup.wall_density = definition.wall.density;
  setup.foundation = foundation_of(definition.held, places);
  setup.landmarks = [definition](const std::vector<Vec3>& skin) { return landmark_places(definition, skin); };
  return setup;
}

/// Fails (scenario) where a region that is held has no point of the wall in it; `wall`: the points, m.
std::optional<Failure> check_held_regions(const OrganDefinition& definition, const Places& places,
                                          const std::vector<Vec3>& wall) {
  for (const HeldRegion& region : definition.held)
    if (std::none_of(wall.begin(), wall.end(),
                     [&](const Vec3& x) { return (x - places.at(region.landmark)).norm() < region.radius; }))
      return fail(FailureKind::scenario,
                  fmt::format("held region '{}' of organ '{}' is too small to catch any of its wall",
                              region.name, definition.name),
                  "give it a larger radius, or the organ more nodes",
                  {"", 0, fmt::format(".held[{}].radius", &region - definition.held.data() + 1)});
  return std::nullopt;
}

/// Contact is felt at skin points: they must stand closer than half a jaw is wide, or it would slip in
/// between.
std::optional<Failure> check_skin_spacing(const ShellBody& body) {
  const double limit = 0.5 * InstrumentGeometry{}.jaw_width;
  const double widest = body.widest_skin_gap();
  if (widest <= limit) return std::nullopt;
  return fail(
      FailureKind::scenario,
      fmt::format(
          "the skin of organ '{}' has points {:.1f} mm apart, more than half a jaw is wide ({:.1f} mm)",
          body.name(), 1e3 * widest, 1e3 * limit),
      "give the organ more nodes", {"", 0, ".nodes"});
}

/// Settings of the solves that fill an organ with `nodes` control nodes: each iteration takes `nodes` off the limits of
/// the filling, and a solve stops where nothing is left of them.
NewtonSettings filling_settings(const OrganSetting& setting, std::size_t nodes) {
  NewtonSettings out;
  out.tolerance = setting.tolerance;
  if (setting.limits != nullptr)
    out.stop = [limits = setting.limits, nodes = static_cast<std::int64_t>(nodes)] {
      if (limits->stop != nullptr && *limits->stop) return true;
      limits->node_iterations -= nodes;
      return limits->node_iterations <= 0;
    };
  return out;
}

}  // namespace

std::vector<Problem> mesh_problems(const SceneDefinition& scene) {
  std::vector<Problem> problems;
  std::size_t nodes = 0, extended = 0;
  for (std::size_t i = 0; i < scene.anatomy.organs.size() && i < most_organs; ++i) {
    const OrganDefinition& organ = scene.anatomy.organs[i];
    const bool file = std::holds_alternative<MeshFile>(organ.shape);
    const auto count = [&](std::size_t more) {
      nodes += more;
      if (organ.extensions) extended += more;
    };
    if (const auto* rigid = std::get_if<RigidShape>(&organ.shape); rigid && !rigid->path.empty())
      if (const Result<TriMesh> mesh = rigid_surface(organ); !mesh)
        for (Problem& problem : at_organ(mesh.failure(), i).problems) problems.push_back(std::move(problem));
    if (!is_hollow(organ.shape)) continue;
    if (!file) count(static_cast<std::size_t>(std::clamp(organ.nodes, 0, most_nodes)));
    if (!file) continue;
    const Result<TriMesh> mesh = sound_mesh(organ);
    if (mesh) count(mesh->points.size());
    if (mesh && nodes > static_cast<std::size_t>(most_nodes))
      problems.push_back(
          {{"", 0, fmt::format("scene.anatomy.organs[{}].shape", i + 1)},
           fmt::format("with organ '{}' the organs have {} control nodes together", organ.name, nodes),
           fmt::format("simplify the meshes to at most {}", most_nodes)});
    if (mesh) continue;
    for (Problem& problem : at_organ(mesh.failure(), i).problems) problems.push_back(std::move(problem));
  }
  const int levels = std::clamp(scene.solver.extension_levels, 0, most_extension_levels);
  if (extended << (2 * levels) > most_finest_nodes)
    problems.push_back({{"", 0, "scene.solver.extensions.levels"},
                        fmt::format("{} levels of the organs' {} nodes are {} nodes, more than {}", levels,
                                    extended, extended << (2 * levels), most_finest_nodes),
                        "give fewer levels, or the organs fewer nodes"});
  return problems;
}

Result<RestedOrgan> make_hollow_organ(const OrganDefinition& definition, const OrganSetting& setting) {
  Result<TriMesh> control = control_mesh(definition);
  if (!control) return control.failure();
  const Result<Places> places = places_on(definition, control.value());
  if (!places) return of_organ(places.failure(), definition);
  Result<ShellBody> body =
      ShellBody::create(shell_setup(definition, setting, control.value(), places.value()));
  if (!body) return of_organ(body.failure(), definition);
  if (std::optional<Failure> failure =
          check_held_regions(definition, places.value(), body->foundation().target))
    return *failure;
  if (std::optional<Failure> failure = check_skin_spacing(body.value())) return *failure;
  NewtonWorkspace work(body->pattern());
  const auto shell = std::make_shared<ShellBody>(std::move(body).value());
  RestedOrgan made{Organ(definition, shell), std::move(work)};
  Organ& organ = made.organ;
  organ.state.volume = shell->bile()->volume(organ.state.x);
  if (setting.only_drawn) return made;
  if (std::optional<Failure> failure = check_clear_of_ground(*shell, setting.loads)) return *failure;
  organ.search.own.active = !swells(organ);
  const NewtonSettings settings = filling_settings(setting, control->points.size());
  Result<bool> filled = fill(made, setting.loads, settings, setting.limits);
  organ.search.own.active = true;
  if (!filled) return filled.failure();
  shell->keep_in_equilibrium(organ.state);
  return made;
}

Result<BodyPointer> released_hollow_organ(const Organ& organ, const std::vector<HeldRegion>& left,
                                          std::size_t /*released*/) {
  const ShellBody& shell = *organ.body->as_shell();
  const Result<Places> places = places_on(organ.definition, shell.control());
  if (!places) return places.failure();
  Result<ShellBody> released = shell.with_foundation(foundation_of(left, places.value()));
  if (!released) return released.failure();
  return BodyPointer(std::make_shared<const ShellBody>(std::move(released).value()));
}

Result<bool> release_filled(Organ& organ) {
  std::vector<HeldRegion> left = organ.definition.held;
  if (std::erase_if(left, [](const HeldRegion& region) { return region.while_filled; }) == 0) return false;
  Result<BodyPointer> released = released_hollow_organ(organ, left, 0);
  if (!released) return released.failure();
  organ.body = std::move(released).value();
  organ.definition.held = std::move(left);
  return true;
}

}  // namespace calot
