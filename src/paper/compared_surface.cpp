#include <cmath>

#include "geometry/shapes.h"
#include "paper/compared_body.h"

namespace calot {

Result<ComparedSurface> ComparedSurface::create(double radius, int nodes, int finest) {
  constexpr int points_level = 2;
  Result<TriMesh> control = revolve(sphere_profile(radius), nodes);
  if (!control) return control.failure();
  Result<SurfaceLevels> levels = SurfaceLevels::create(control.value(), finest);
  if (!levels) return levels.failure();
  Result<std::vector<Vec3>> fitted = fit_to_limit(levels->surface(), control->points);
  if (!fitted) return fitted.failure();
  control->points = std::move(fitted).value();
  ComparedSurface out{std::move(control).value(), std::move(levels).value(), {}, {}, radius};
  for (int node = 0; node < out.levels.nodes(points_level); ++node)
    out.points.push_back(out.levels.place(node));
  const StencilTable table = out.levels.evaluate(0, out.points, 0);
  out.rest = blend_all(table, table.value, to_coordinates(out.control.points));
  return out;
}

std::vector<double> ComparedSurface::springs(const Vec3& direction) const {
  constexpr double reach = 3;
  std::vector<double> out;
  double sum = 0;
  for (const Vec3& p : rest) {
    const double far = (p - radius * direction).norm() / contact_spread;
    out.push_back(far < reach ? std::exp(-0.5 * far * far) : 0.0);
    sum += out.back();
  }
  for (double& k : out) k *= contact_stiffness / sum;
  return out;
}

Result<TriMesh> ComparedSurface::level_control(int level) const {
  if (level == 0) return control;
  std::vector<FacePoint> places;
  for (int node = 0; node < levels.nodes(level); ++node) places.push_back(levels.place(node));
  const StencilTable table = levels.evaluate(0, places, 0);
  TriMesh out;
  out.triangles = levels.faces(level);
  out.points = blend_all(table, table.value, to_coordinates(control.points));
  // The coarse surface is one of the finer ones: the only one through these places.
  const Result<LoopSurface> finer = LoopSurface::create(out);
  if (!finer) return finer.failure();
  Result<std::vector<Vec3>> fitted = fit_to_limit(finer.value(), out.points);
  if (!fitted) return fitted.failure();
  out.points = std::move(fitted).value();
  return out;
}

}  // namespace calot
