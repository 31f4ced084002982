#include "render/scene_arrays.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace calot {
namespace {

/// Why a mesh cannot be drawn; empty when it can.
std::string mesh_problem(const SceneMesh& mesh) {
  const std::size_t n = mesh.positions.size();
  if (mesh.normals.size() != n || mesh.rest_positions.size() != n)
    return fmt::format("{} positions, {} normals and {} rest positions", n, mesh.normals.size(),
                       mesh.rest_positions.size());
  if (!mesh.burnt.empty() && mesh.burnt.size() != n)
    return fmt::format("{} positions and {} shares burnt", n, mesh.burnt.size());
  for (const double share : mesh.burnt)
    if (!(share >= 0 && share <= 1)) return fmt::format("a share burnt of {}", share);
  for (std::size_t i = 0; i < n; ++i)
    if (!mesh.positions[i].allFinite() || !mesh.normals[i].allFinite() || !mesh.rest_positions[i].allFinite())
      return fmt::format("point {} is not finite", i);
  if (mesh.vessels && mesh.vessels->share.size() != static_cast<std::size_t>(mesh.vessels->size[0]) *
                                                        mesh.vessels->size[1] * mesh.vessels->size[2])
    return "the vessel map's size does not fit its voxels";
  for (const Triangle& t : mesh.triangles)
    for (const int corner : t)
      if (corner < 0 || corner >= static_cast<int>(n))
        return fmt::format("a triangle names point {} of {}", corner, n);
  return {};
}

void add_vertex(std::vector<float>& vertices, const Vec3& place, const Vec3& normal, const Vec3& rest,
                double burnt = 0) {
  for (const Vec3& v : {place, normal, rest})
    for (int c = 0; c < 3; ++c) vertices.push_back(static_cast<float>(v[c]));
  vertices.push_back(static_cast<float>(burnt));
}

void add_mask(SceneArrays& arrays, const Vec2& extent) {
  constexpr int corners = 64;
  constexpr double pi = std::numbers::pi;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * pi * i / corners;
    for (const double radius : {1.01 / std::cos(pi / corners), 3.0}) {
      const Vec2 ring = radius * Vec2(std::cos(angle), std::sin(angle)).cwiseQuotient(extent);
      add_vertex(arrays.vertices, Vec3(ring.x(), ring.y(), -0.999), Vec3::Zero(), Vec3::Zero());
    }
    const auto a = static_cast<std::uint32_t>(2 * i), b = static_cast<std::uint32_t>(2 * ((i + 1) % corners));
    for (const std::uint32_t corner : {a, a + 1, b + 1, a, b + 1, b}) arrays.indices.push_back(corner);
  }
  arrays.mask.count = arrays.indices.size();
}

}  // namespace

std::string scene_problem(const Scene& scene) {
  const SceneCamera& camera = scene.camera;
  if (!camera.position.allFinite() || !camera_axes(camera).allFinite() || !camera.light_offset.allFinite() ||
      !(camera.light_intensity >= 0) || !(camera.field_of_view > 0) || !(camera.field_of_view < 3))
    return "its camera has no view (direction, up, field of view or light)";
  for (std::size_t i = 0; i < scene.meshes.size(); ++i)
    if (const std::string problem = mesh_problem(scene.meshes[i]); !problem.empty())
      return fmt::format("mesh {}: {}", i, problem);
  return {};
}

SceneArrays scene_arrays(const Scene& scene, const Lens& lens, int width, int height) {
  SceneArrays arrays;
  add_mask(arrays, lens.inner_extent(width, height));
  for (const SceneMesh& mesh : scene.meshes) {
    const auto base = static_cast<std::uint32_t>(arrays.vertices.size() / floats_each);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      add_vertex(arrays.vertices, mesh.positions[i] - scene.camera.position, mesh.normals[i],
                 mesh.rest_positions[i], mesh.burnt.empty() ? 0.0 : mesh.burnt[i]);
    arrays.parts.push_back({mesh.material, arrays.indices.size(), 3 * mesh.triangles.size(), mesh.vessels});
    for (const Triangle& t : mesh.triangles)
      for (const int corner : t) arrays.indices.push_back(base + static_cast<std::uint32_t>(corner));
  }
  return arrays;
}

}  // namespace calot
