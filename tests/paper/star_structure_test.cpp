#include "paper/star_structure.h"

#include <gtest/gtest.h>

#include "base/units.h"
#include "geometry/shapes.h"
#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot::star_structure_test {
namespace {

constexpr double radius = 20e-3;

/// A coarse sphere with two stars that share an edge; a material point in each coarse face and a few in the
/// stars' faces, the same in both meshes.
struct Rig {
  TriMesh coarse = revolve(sphere_profile(radius), 20).value();
  StarMesh split;
  std::vector<FacePoint> points, split_points;
  std::vector<double> base, contact;

  Rig() {
    const Triangle& first = coarse.triangles[0];
    std::vector<FacePoint> contacts = {{0, 0.3, 0.3}};
    for (int f = 1; contacts.size() < 2; ++f)
      if (std::count(coarse.triangles[f].begin(), coarse.triangles[f].end(), first[0]) +
              std::count(coarse.triangles[f].begin(), coarse.triangles[f].end(), first[1]) ==
          2)
        contacts.push_back({f, 0.4, 0.3});
    split = star_split(coarse, contacts, 0).value();
    const Vec3 top = coarse.points[first[0]];
    for (int t = 0; t < static_cast<int>(split.mesh.triangles.size()); ++t) {
      split_points.push_back({t, 0.3, 0.4});
      points.push_back(in_parent(split_points.back()));
      const double far = (position(split_points.back()) - top).norm() / radius;
      base.push_back(far > 1.7 ? 400.0 : 0.0);
      contact.push_back(split.extended[t] ? 100.0 : 0.0);
    }
  }

  Vec3 position(const FacePoint& p) const {
    const StencilTable row = linear_stencils(split.mesh.triangles, std::vector<FacePoint>{p});
    return blend(row, row.value, 0, to_coordinates(split.mesh.points));
  }
  FacePoint in_parent(const FacePoint& p) const {
    const Triangle& t = coarse.triangles[split.parent[p.face]];
    Mat3 corners;
    corners << coarse.points[t[0]], coarse.points[t[1]], coarse.points[t[2]];
    const Vec3 w = corners.inverse() * position(p);
    return {split.parent[p.face], w[1], w[2]};
  }
};

PaperSetup setup() {
  PaperSetup out;
  out.fill = 1.05;
  out.newton.tolerance = 1e-10;
  return out;
}

const Vec3 pull(1e-3, 2e-3, 5e-3);

void load(PaperBody& body, const Rig& rig) {
  body.bind(rig.base, Vec3::Zero());
  ASSERT_TRUE(body.settle(0).converged());
  body.bind(rig.contact, pull);
  for (double share : {0.5, 1.0}) ASSERT_TRUE(body.settle(share).converged());
}

TEST(PaperStructure, GradientAndHessianAreTheDerivativesWhicheverNodesAreHeld) {
  const Rig rig;
  Rng rng(1);
  const PaperElements elements = PaperElements::create(rig.split.mesh, {}, setup()).value();
  const StencilTable points = linear_stencils(rig.split.mesh.triangles, rig.split_points);
  PaperSprings bound;
  Links& springs = bound.links;
  for (int p = 0; p < points.rows(); ++p) {
    springs.row.push_back(p);
    springs.target.push_back(rig.position(rig.split_points[p]) + test::random_vector(rng, 3e-3));
    springs.stiffness.push_back(rng.uniform(50, 500));
  }
  const VecX nodes =
      elements.rest + test::random_coordinates(rng, static_cast<int>(elements.rest.size()), 0.3e-3);
  const double volume = elements.bile.volume(elements.rest), datum_pressure = 800;
  for (int first : {0, 20}) {
    // With nodes held the pressure is given; without, the volume is, and the Hessian is the Lagrangian's.
    const std::optional<double> kept = first == 0 ? std::optional(volume) : std::nullopt;
    bound.find_hessian(elements, points, first);
    const PaperProblem problem(elements, points, bound, kept, datum_pressure, nodes, first);
    const auto gradient = [&](const VecX& y) {
      VecX g, by_volume;
      double largest = 0;
      problem.gradient(y, g, largest);
      if (!kept) return g;
      problem.constraint(y, by_volume);
      return VecX(g - datum_pressure * by_volume);
    };
    const auto value = [&](const VecX& y) {
      return problem.value(y) - (kept ? datum_pressure * problem.constraint_value(y) : 0.0);
    };
    const VecX x = nodes.tail(nodes.size() - 3 * first);
    EXPECT_GT(gradient(x).norm(), 1e-2);
    // The smallest edges are 2 mm: relative error (1e-7 / 2e-3)^2 and rounding / 1e-7.
    EXPECT_LT(test::relative_error(gradient(x), test::difference_gradient(value, x, 1e-7)), 1e-6);
    BlockMatrix matrix = PaperProblem::pattern(elements, first);
    problem.hessian(x, datum_pressure, matrix);
    EXPECT_GT(test::stored(matrix).norm(), 0);
    EXPECT_LT(test::relative_error(test::dense(matrix), test::difference_hessian(gradient, x, 1e-7)), 1e-6);
  }
}

TEST(PaperStructure, FillingKeepsTheVolumeAndTheBaseCarriesTheBile) {
  const Rig rig;
  PaperBody body = PaperBody::one_system(rig.split.mesh, rig.split_points, setup()).value();
  body.bind(rig.base, Vec3::Zero());
  const std::vector<Vec3> rest = body.surface();
  ASSERT_TRUE(body.settle(0).converged());
  const double volume = 1.05 * enclosed_volume(rig.split.mesh);
  EXPECT_NEAR(body.volume(), volume, 1e-10 * volume);
  EXPECT_GT(body.pressure(), 0);
  Vec3 force = Vec3::Zero();
  for (std::size_t p = 0; p < rest.size(); ++p) force += rig.base[p] * (rest[p] - body.surface()[p]);
  const double weight = 1020 * units::standard_gravity * volume;
  EXPECT_LT((force - weight * Vec3::UnitZ()).norm(), 1e-6 * weight);
}

TEST(PaperStructure, TheFirstStageIsTheCoarseStructureAlone) {
  const Rig rig;
  PaperBody coarse = PaperBody::one_system(rig.coarse, rig.points, setup()).value();
  PaperBody staged =
      PaperBody::two_stages(rig.coarse, rig.points, rig.split, rig.split_points, setup()).value();
  load(coarse, rig);
  load(staged, rig);
  ASSERT_EQ(staged.nodes().size(), static_cast<int>(3 * rig.split.mesh.points.size()));
  EXPECT_EQ(VecX(staged.nodes().head(coarse.nodes().size())), coarse.nodes());
  EXPECT_EQ(staged.pressure(), coarse.pressure());
}

TEST(PaperStructure, TheSecondStageBringsTheExtensionsNodesIntoBalance) {
  const Rig rig;
  PaperBody staged =
      PaperBody::two_stages(rig.coarse, rig.points, rig.split, rig.split_points, setup()).value();
  PaperBody free =
      PaperBody::two_stages(rig.coarse, rig.points, rig.split, rig.split_points, setup()).value();
  free.bind(rig.base, Vec3::Zero());
  ASSERT_TRUE(free.settle(0).converged());
  const std::vector<Vec3> filled = free.surface();
  load(staged, rig);
  // The whole of it as one system, at the same pressure: only the coarse nodes are out of balance.
  const PaperElements elements = PaperElements::create(rig.split.mesh, {}, setup()).value();
  const StencilTable points = linear_stencils(rig.split.mesh.triangles, rig.split_points);
  PaperSprings bound;
  Links& springs = bound.links;
  for (int p = 0; p < points.rows(); ++p) {
    if (!rig.split.extended[rig.split_points[p].face]) continue;
    springs.row.push_back(p);
    springs.target.push_back(filled[p] + pull);
    springs.stiffness.push_back(rig.contact[p]);
  }
  const PaperProblem problem(elements, points, bound, std::nullopt, staged.pressure(), staged.nodes(), 0);
  VecX g;
  double largest = 0;
  problem.gradient(staged.nodes(), g, largest);
  const int unknowns = static_cast<int>(g.size()) - 60;
  EXPECT_LT(largest_node(g.tail(unknowns)), 1e-8 * largest);
  EXPECT_GT(largest_node(g.head(60)), 1e-3 * largest);
}

}  // namespace
}  // namespace calot::star_structure_test
