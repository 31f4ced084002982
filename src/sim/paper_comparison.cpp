#include "sim/paper_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "geometry/shapes.h"

namespace calot {
namespace {

constexpr double near_contact = 10e-3;  // m

/// Each structure twice as fine as the one before it, all of the sphere's volume.
Result<std::vector<TriMesh>> nested_spheres(const PaperCase& given) {
  Result<TriMesh> coarsest = revolve(sphere_profile(given.radius), given.nodes);
  if (!coarsest) return coarsest.failure();
  std::vector<TriMesh> out = {coarsest.value()};
  for (int k = 0; k < given.refinements; ++k) out.push_back(split_edges(out.back()));
  for (TriMesh& mesh : out) {
    for (Vec3& p : mesh.points) p = given.radius * p.normalized();
    const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(given.radius, 3);
    const double scale = std::cbrt(volume / enclosed_volume(mesh));
    for (Vec3& p : mesh.points) p *= scale;
  }
  return out;
}

/// Directions in which all structures are loaded and measured: the nodes of a finer sphere than any of them.
std::vector<Vec3> sample_directions(TriMesh mesh) {
  constexpr int splits = 3;
  for (int k = 0; k < splits; ++k) mesh = split_edges(mesh);
  for (Vec3& p : mesh.points) p.normalize();
  return mesh.points;
}

/// Where rays from the origin meet a mesh around it.
class View {
 public:
  explicit View(const TriMesh& mesh) {
    for (const Triangle& t : mesh.triangles) {
      Mat3 corners;
      corners << mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]];
      inverses_.push_back(corners.inverse());
    }
  }

  FacePoint point(const Vec3& direction) const {
    int best = 0;
    for (int f = 1; f < faces(); ++f)
      if (depth(f, direction) > depth(best, direction)) best = f;
    return on_plane(best, direction);
  }
  std::vector<FacePoint> points(const std::vector<Vec3>& directions) const {
    std::vector<FacePoint> out;
    for (const Vec3& d : directions) out.push_back(point(d));
    return out;
  }
  /// A point on each of the faces' planes; the nearer the ray passes to a face the earlier it comes.
  std::vector<FacePoint> nearest(const Vec3& direction, int count) const {
    std::vector<int> order(inverses_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return depth(a, direction) > depth(b, direction); });
    std::vector<FacePoint> out;
    for (int k = 0; k < count; ++k) out.push_back(on_plane(order[k], direction));
    return out;
  }

 private:
  int faces() const { return static_cast<int>(inverses_.size()); }
  FacePoint on_plane(int face, const Vec3& direction) const {
    const Vec3 w = inverses_[face] * direction;
    return {face, w[1] / w.sum(), w[2] / w.sum()};
  }
  /// The smallest barycentric weight of where the ray meets the face's plane.
  double depth(int face, const Vec3& direction) const {
    const Vec3 w = inverses_[face] * direction;
    return w.sum() > 0 ? w.minCoeff() / w.sum() : -std::numeric_limits<double>::infinity();
  }

  std::vector<Mat3> inverses_;
};

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
      add("uniform", 0, 0, PaperBody::one_system(mesh, View(mesh).points(directions_), given_.setup));
    const TriMesh& coarse = meshes_.front();
    const View view(coarse);
    const std::vector<FacePoint> contacts = view.nearest(along_, given_.extensions);
    const std::vector<FacePoint> points = view.points(directions_);
    for (int levels : given_.levels) {
      const Result<StarMesh> split = star_split(coarse, contacts, levels);
      if (!split) return split.failure();
      const std::vector<FacePoint> split_points = View(split->mesh).points(directions_);
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
    body->bind(to_base_, false);
    if (!settled(formulation, body->settle(Vec3::Zero()))) return;
    const std::vector<Vec3> filled = body->surface();
    body->bind(to_contact_, true);
    for (int k = 1; k <= given_.steps; ++k)
      if (!settled(formulation, body->settle(k * given_.outward / given_.steps * along_))) return;
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
    const std::vector<Vec3>& reference = displacements_[meshes_.size() - 1];
    const auto largest = [](const std::vector<Vec3>& v) {
      double out = 0;
      for (const Vec3& d : v) out = std::max(out, d.norm());
      return out;
    };
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      PaperRow& row = rows_[k];
      row.largest_m = largest(displacements_[k]);
      int near = 0;
      for (std::size_t i = 0; i < reference.size(); ++i) {
        const double error = 100 * (displacements_[k][i] - reference[i]).norm() / largest(reference);
        row.mean_error_pct += error / static_cast<double>(reference.size());
        row.max_error_pct = std::max(row.max_error_pct, error);
        if (given_.radius * (directions_[i] - along_).norm() > near_contact) continue;
        row.contact_error_pct += error;
        ++near;
      }
      if (near > 0) row.contact_error_pct /= near;
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

Result<std::vector<PaperRow>> compare_paper(const PaperCase& given) {
  const int coarse_faces = 2 * given.nodes - 4;
  const bool lengths = given.radius > 0 && given.base_spread > 0 && given.contact_spread > 0;
  const bool levels = std::all_of(given.levels.begin(), given.levels.end(), [](int l) { return l >= 0; });
  if (!lengths || !levels || !(given.contact.norm() > 0) || given.steps < 1 || given.refinements < 0 ||
      given.extensions < 0 || given.extensions > coarse_faces)
    return fail(FailureKind::usage, "a case of the paper's comparison that makes no sense",
                "lengths and steps above 0, counts not below 0, at most one extension a coarse triangle");
  Result<std::vector<TriMesh>> meshes = nested_spheres(given);
  if (!meshes) return meshes.failure();
  return Comparison(given, std::move(meshes).value()).run();
}

}  // namespace calot
