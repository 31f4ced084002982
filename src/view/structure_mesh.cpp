#include "view/structure_mesh.h"

#include <numbers>

#include "view/surfaces.h"

namespace calot {
namespace {

constexpr double thread = 0.18e-3, bead = 0.55e-3;  // m, radii

SceneMesh tube(Material material, const StructureDrawing::Line& line) {
  const int spans = static_cast<int>(line.points.size()) - 1;
  return sheet(material, spans, 6, [&](double u, double v) {
    const int k = static_cast<int>(std::lround(u * spans));
    const int before = std::max(0, k - 1), after = std::min(spans, k + 1);
    const Vec3 along = (line.points[after] - line.points[before]).normalized();
    const Vec3 side = line.normals[k].cross(along);
    const double angle = 2 * std::numbers::pi * v;
    return Vec3(line.points[k] + thread * (std::sin(angle) * side + std::cos(angle) * line.normals[k]));
  });
}

SceneMesh ball(Material material, const Vec3& at) {
  return sheet(material, 10, 6, [&](double u, double v) {
    const double around = 2 * std::numbers::pi * u, up = std::numbers::pi * (v - 0.5);
    return Vec3(at +
                bead * Vec3(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)));
  });
}

}  // namespace

std::vector<SceneMesh> structure_meshes(const StructureDrawing& structure) {
  SceneMesh coarse, fine;
  coarse.material = Material::insulation;
  fine.material = Material::steel;
  for (const StructureDrawing::Line& line : structure.lines) {
    SceneMesh& mesh = line.level == 0 ? coarse : fine;
    append(mesh, tube(mesh.material, line));
  }
  for (const Vec3& node : structure.coarse_nodes) append(coarse, ball(coarse.material, node));
  for (const Vec3& node : structure.details) append(fine, ball(fine.material, node));
  std::vector<SceneMesh> out;
  if (!coarse.triangles.empty()) out.push_back(std::move(coarse));
  if (!fine.triangles.empty()) out.push_back(std::move(fine));
  return out;
}

}  // namespace calot
