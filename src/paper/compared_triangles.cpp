#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/radial_view.h"
#include "geometry/shapes.h"
#include "paper/compared_body.h"
#include "paper/star_structure.h"

namespace calot {
namespace {

/// One of the paper's structures, made anew for each run.
class ComparedTriangles : public ComparedBody {
 public:
  /// `split`: extensions, else one system of `mesh`.
  ComparedTriangles(const ComparedSurface& surface, TriMesh mesh, std::optional<StarMesh> split,
                    bool two_stages)
      : surface_(surface), mesh_(std::move(mesh)), split_(std::move(split)), two_stages_(two_stages) {
    points_ = RadialView(mesh_).points(surface.rest);
    if (split_) split_points_ = RadialView(split_->mesh).points(surface.rest);
  }

  Result<bool> make(std::optional<FactorKind> solver) {
    PaperSetup setup;
    setup.fill = compared_fill;
    setup.solver = solver;
    Result<PaperBody> made = two_stages_
                                 ? PaperBody::two_stages(mesh_, points_, *split_, split_points_, setup)
                             : split_ ? PaperBody::one_system(split_->mesh, split_points_, setup)
                                      : PaperBody::one_system(mesh_, points_, setup);
    if (!made) return made.failure();
    body_.emplace(std::move(made).value());
    return true;
  }

  NewtonResult begin(const ComparedLoad& load, FactorKind solver) override {
    NewtonResult result;
    if (!make(solver)) {  // what could be made once can be made again, unless memory is out
      result.status = NewtonStatus::out_of_memory;
      return result;
    }
    body_->bind(bed(), Vec3::Zero());
    result = body_->settle(0);
    for (const LoadedPlace& place : load.places)
      body_->bind(surface_.springs(place.direction), place.travel * place.direction);
    return result;
  }
  NewtonResult step(double share) override { return body_->settle(share); }
  std::vector<Vec3> surface() const override { return body_->surface(); }
  int nodes() const override { return static_cast<int>((split_ ? split_->mesh : mesh_).points.size()); }
  std::vector<const NewtonWorkspace*> systems() const override { return body_->systems(); }

 private:
  /// The foundation's stiffness on the shared points, each of which stands for the same area, N/m.
  std::vector<double> bed() const {
    const double area =
        4 * std::numbers::pi * surface_.radius * surface_.radius / static_cast<double>(surface_.rest.size());
    std::vector<double> out;
    for (const Vec3& p : surface_.rest) {
      const double far = (p + surface_.radius * Vec3::UnitZ()).norm() / bed_spread;
      out.push_back(bed_stiffness * area * std::exp(-0.5 * far * far));
    }
    return out;
  }

  const ComparedSurface& surface_;
  TriMesh mesh_;
  std::optional<StarMesh> split_;
  bool two_stages_;
  std::vector<FacePoint> points_, split_points_;
  std::optional<PaperBody> body_;
};

/// A sphere of flat triangles and of the round one's volume, its edges halved `level` times.
Result<TriMesh> flat_sphere(const ComparedSurface& surface, int level) {
  Result<TriMesh> coarse =
      revolve(sphere_profile(surface.radius), static_cast<int>(surface.control.points.size()));
  if (!coarse) return coarse;
  TriMesh mesh = std::move(coarse).value();
  for (int k = 0; k < level; ++k) mesh = split_edges(mesh);
  for (Vec3& p : mesh.points) p = surface.radius * p.normalized();
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(surface.radius, 3);
  const double scale = std::cbrt(volume / enclosed_volume(mesh));
  for (Vec3& p : mesh.points) p *= scale;
  return mesh;
}

Result<std::unique_ptr<ComparedBody>> checked(std::unique_ptr<ComparedTriangles> body) {
  if (Result<bool> made = body->make(std::nullopt); !made) return made.failure();
  return std::unique_ptr<ComparedBody>(std::move(body));
}

}  // namespace

Result<std::unique_ptr<ComparedBody>> uniform_triangles(const ComparedSurface& surface, int uniform) {
  Result<TriMesh> mesh = flat_sphere(surface, uniform);
  if (!mesh) return mesh.failure();
  return checked(std::make_unique<ComparedTriangles>(surface, std::move(mesh).value(), std::nullopt, false));
}

Result<std::unique_ptr<ComparedBody>> extended_triangles(const ComparedSurface& surface,
                                                         const std::vector<Vec3>& places, int levels,
                                                         bool two_stages) {
  Result<TriMesh> mesh = flat_sphere(surface, 0);
  if (!mesh) return mesh.failure();
  const std::vector<FacePoint> contacts = RadialView(mesh.value()).points(places);
  Result<StarMesh> split = star_split(mesh.value(), contacts, levels);
  if (!split) return split.failure();
  return checked(std::make_unique<ComparedTriangles>(surface, std::move(mesh).value(),
                                                     std::move(split).value(), two_stages));
}

}  // namespace calot
