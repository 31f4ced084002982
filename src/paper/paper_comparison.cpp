#include "paper/paper_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/radial_view.h"
#include "geometry/shapes.h"
#include "paper/displacement_errors.h"

namespace calot {
namespace {

/// Directions in which all structures are loaded and measured: the nodes of a finer sphere than any of them.
std::vector<Vec3> sample_directions(TriMesh mesh) {
  constexpr int splits = 3;
  for (int k = 0; k < splits; ++k) mesh = split_edges(mesh);
  for (Vec3& p : mesh.points) p.normalize();
  return mesh.points;
}

class Comparison {
 public:
  Comparison(const PaperCase& given, std::vector<TriMesh> meshes)
      : given_(given), meshes_(std::move(meshes)) {
    directions_ = sample_directions(meshes_.front());
    along_ = given_.contact.normalized();
    to_base_ = gaussian(-given_.setup.up, given_.base_stiffness, given_.base_spread);
    to_contact_ = gaussian(along_, given_.contact_stiffness, given_.contact_spread);
  }

  Result<std::vector<PaperRow>> run() {
    for (const TriMesh& mesh : meshes_)
      add("uniform", 0, 0, PaperBody::one_system(mesh, RadialView(mesh).points(directions_), given_.setup));
    const TriMesh& coarse = meshes_.front();
    const RadialView view(coarse);
    const std::vector<FacePoint> contacts = view.nearest(along_, given_.extensions);
    const std::vector<FacePoint> points = view.points(directions_);
    for (int levels : given_.levels) {
      const Result<StarMesh> split = star_split(coarse, contacts, levels);
      if (!split) return split.failure();
      const std::vector<FacePoint> split_points = RadialView(split->mesh).points(directions_);
      add("extended, one system", given_.extensions, levels,
          PaperBody::one_system(split->mesh, split_points, given_.setup));
      add("extended, two stages", given_.extensions, levels,
          PaperBody::two_stages(coarse, points, split.value(), split_points, given_.setup));
    }
    if (failure_) return *failure_;
    measure();
    return rows_;
  }

 private:
  /// Springs' stiffness at each point: a Gaussian on the sphere, of the area a point stands for.
  std::vector<double> gaussian(const Vec3& centre, double stiffness, double spread) const {
    const double area =
        4 * std::numbers::pi * given_.radius * given_.radius / static_cast<double>(directions_.size());
    std::vector<double> out;
    for (const Vec3& d : directions_) {
      const double far = given_.radius * (d - centre).norm() / spread;
      constexpr double reach = 4;
      out.push_back(far < reach ? stiffness * area * std::exp(-0.5 * far * far) : 0.0);
    }
    return out;
  }

  void add(const std::string& formulation, int extensions, int levels, Result<PaperBody> body) {
    if (failure_) return;
    if (!body) {
      failure_ = body.failure();
      return;
    }
    body->bind(to_base_, Vec3::Zero());
    if (!settled(formulation, body->settle(0))) return;
    const std::vector<Vec3> filled = body->surface();
    body->bind(to_contact_, given_.outward * along_);
    for (int k = 1; k <= given_.steps; ++k)
      if (!settled(formulation, body->settle(static_cast<double>(k) / given_.steps))) return;
    std::vector<Vec3> moved = body->surface();
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] -= filled[i];
    displacements_.push_back(std::move(moved));
    const PaperBody::Cost cost = body->cost();
    rows_.push_back({formulation, cost.nodes, extensions, levels, cost.unknowns, cost.iterations,
                     cost.factor_flops, cost.flops, cost.memory, 0, 0, 0, cost.condition, cost.seconds, 0});
  }

  bool settled(const std::string& formulation, const NewtonResult& result) {
    if (!result.converged())
      failure_ = fail(FailureKind::simulation,
                      fmt::format("structure {} ({}) found no equilibrium: {}", rows_.size(), formulation,
                                  to_text(result.status)),
                      "take more steps or a smaller motion");
    return result.converged();
  }

  /// Errors against the finest uniform structure.
  void measure() {
    std::vector<bool> near;
    for (const Vec3& d : directions_) near.push_back(given_.radius * (d - along_).norm() <= near_contact);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const DisplacementErrors errors =
          displacement_errors(displacements_[k], displacements_[meshes_.size() - 1], near);
      rows_[k].mean_error_pct = errors.mean_pct;
      rows_[k].contact_error_pct = errors.contact_pct;
      rows_[k].max_error_pct = errors.max_pct;
      rows_[k].largest_m = largest_of(displacements_[k]);
    }
  }

  const PaperCase& given_;
  std::vector<TriMesh> meshes_;
  std::vector<Vec3> directions_;  ///< of the surface points
  Vec3 along_;
  std::vector<double> to_base_, to_contact_;
  std::vector<PaperRow> rows_;
  std::vector<std::vector<Vec3>> displacements_;  ///< of each row
  std::optional<Failure> failure_;
};

}  // namespace

Result<std::vector<TriMesh>> flat_spheres(double radius, int nodes, int refinements) {
  Result<TriMesh> coarsest = revolve(sphere_profile(radius), nodes);
  if (!coarsest) return coarsest.failure();
  std::vector<TriMesh> out = {coarsest.value()};
  for (int k = 0; k < refinements; ++k) out.push_back(split_edges(out.back()));
  for (TriMesh& mesh : out) {
    for (Vec3& p : mesh.points) p = radius * p.normalized();
    const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
    const double scale = std::cbrt(volume / enclosed_volume(mesh));
    for (Vec3& p : mesh.points) p *= scale;
  }
  return out;
}

Result<std::vector<PaperRow>> compare_paper(const PaperCase& given) {
  const int coarse_faces = 2 * given.nodes - 4;
  const bool lengths = given.radius > 0 && given.base_spread > 0 && given.contact_spread > 0;
  const bool levels = std::all_of(given.levels.begin(), given.levels.end(), [](int l) { return l >= 0; });
  if (!lengths || !levels || !(given.contact.norm() > 0) || given.steps < 1 || given.refinements < 0 ||
      given.extensions < 0 || given.extensions > coarse_faces)
    return fail(FailureKind::usage, "a case of the paper's comparison that makes no sense",
                "lengths and steps above 0, counts not below 0, at most one extension a coarse triangle");
  Result<std::vector<TriMesh>> meshes = flat_spheres(given.radius, given.nodes, given.refinements);
  if (!meshes) return meshes.failure();
  return Comparison(given, std::move(meshes).value()).run();
}

}  // namespace calot
