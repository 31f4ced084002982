// The paper's B-spline skin over a structure with stars (section 5.3), which nothing draws: that the control mesh of
// star_control() carries one.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "geometry/shapes.h"
#include "paper/star_structure.h"
#include "skin/subdivision.h"

namespace calot::star_skin_test {
namespace {

constexpr double radius = 20e-3;

/// The Loop surface controlled by the structure's nodes, but at an extension by P0 and P1', P2', P3' in place of P1, P2,
/// P3; stencils name the structure's nodes.
Tessellation paper_skin(const StarMesh& structure, int parts) {
  const StarControl control = star_control(structure);
  Tessellation skin = LoopSurface::create(control.mesh).value().tessellate(parts);
  for (int& node : skin.stencils.node) node = control.node[node];
  return skin;
}

/// Three stars: the second shares an edge with the first, the third a node of both or of one.
StarMesh structure(int levels) {
  const TriMesh coarse = revolve(sphere_profile(radius), 61).value();
  const Triangle& first = coarse.triangles[0];
  std::vector<FacePoint> contacts = {{0, 0.3, 0.4}};
  for (int corners : {2, 1})
    for (int f = 1; f < static_cast<int>(coarse.triangles.size()); ++f) {
      int shared = 0;
      for (int node : coarse.triangles[f])
        shared += static_cast<int>(std::count(first.begin(), first.end(), node));
      if (shared != corners) continue;
      contacts.push_back({f, 0.05, 0.3});  // near an edge
      break;
    }
  EXPECT_EQ(contacts.size(), 3U);
  return star_split(coarse, contacts, levels).value();
}

TEST(PaperSkin, ExtensionsControlItAndTheCornersOfTheTouchedTrianglesDoNot) {
  for (int levels : {0, 1}) {
    const StarMesh split = structure(levels);
    const StencilTable table = paper_skin(split, 4).stencils;
    std::set<int> corners, controlling(table.node.begin(), table.node.end());
    for (const Star& star : split.stars) {
      corners.insert(star.corners.begin(), star.corners.end());
      EXPECT_EQ(controlling.count(star.centre), 1U);
      for (int node : star.inner) EXPECT_EQ(controlling.count(node), 1U);
    }
    for (int node : corners) EXPECT_EQ(controlling.count(node), 0U) << node;
    EXPECT_EQ(controlling.size() + corners.size(), split.mesh.points.size());
  }
}

TEST(PaperSkin, IsClosedOutwardAndNearTheStructure) {
  for (int levels : {0, 1}) {
    const StarMesh split = structure(levels);
    const Tessellation skin = paper_skin(split, 4);
    const TriMesh mesh{blend_all(skin.stencils, skin.stencils.value, to_coordinates(split.mesh.points)),
                       skin.triangles};
    for (const Problem& problem : check(mesh)) ADD_FAILURE() << to_text(problem);
    // A limit surface stays within its control points and rounds their 10 mm edges off.
    EXPECT_LT(enclosed_volume(mesh), enclosed_volume(split.mesh));
    EXPECT_GT(enclosed_volume(mesh), 0.7 * enclosed_volume(split.mesh));
    for (const Vec3& p : mesh.points) EXPECT_LT(p.norm(), radius);
  }
}

TEST(PaperSkin, FollowsRigidMotionsOfTheNodes) {
  const StarMesh split = structure(0);
  const StencilTable table = paper_skin(split, 3).stencils;
  const Pose motion = Eigen::Translation3d(0.1, -0.2, 0.05) * Eigen::AngleAxisd(1.0, Vec3(1, 2, 2) / 3);
  VecX there = to_coordinates(split.mesh.points);
  const std::vector<Vec3> rest = blend_all(table, table.value, there);
  for (int i = 0; i < there.size(); i += 3) there.segment<3>(i) = (motion * Vec3(there.segment<3>(i))).eval();
  const std::vector<Vec3> moved = blend_all(table, table.value, there);
  for (std::size_t r = 0; r < rest.size(); ++r) EXPECT_LT((moved[r] - motion * rest[r]).norm(), 1e-15);
}

TEST(PaperSkin, OfABodyPulledAtItsExtensionsDoesNotFold) {
  const TriMesh coarse = revolve(sphere_profile(radius), 61).value();
  const StarMesh split = structure(0);
  // A point in the middle of each triangle; those of the extensions are pulled, those far away held.
  std::vector<FacePoint> points;
  std::vector<double> base, contact;
  const Vec3 at = split.mesh.points[split.stars[0].centre], pull = 8e-3 * at.normalized();
  for (int t = 0; t < static_cast<int>(split.mesh.triangles.size()); ++t) {
    points.push_back({t, 1.0 / 3, 1.0 / 3});
    const double far = (split.mesh.points[split.mesh.triangles[t][0]] - at).norm();
    base.push_back(far > 1.7 * radius ? 400.0 : 0.0);
    contact.push_back(split.extended[t] ? 100.0 : 0.0);
  }
  PaperBody body = PaperBody::one_system(split.mesh, points, {}).value();
  body.bind(base, Vec3::Zero());
  ASSERT_TRUE(body.settle(0).converged());
  body.bind(contact, pull);
  for (int k = 1; k <= 4; ++k) ASSERT_TRUE(body.settle(k / 4.0).converged());
  const Tessellation skin = paper_skin(split, 4);
  const TriMesh mesh{blend_all(skin.stencils, skin.stencils.value, body.nodes()), skin.triangles};
  for (const Problem& problem : check(mesh)) ADD_FAILURE() << to_text(problem);
  EXPECT_GT((Vec3(body.nodes().segment<3>(3 * split.stars[0].centre)) - at).dot(at.normalized()), 6e-3);
}

TEST(PaperSkin, MovingPZeroMovesTheSkinAroundItOnly) {
  const StarMesh split = structure(0);
  const Tessellation skin = paper_skin(split, 4);
  VecX x = to_coordinates(split.mesh.points);
  const std::vector<Vec3> rest = blend_all(skin.stencils, skin.stencils.value, x);
  const int centre = split.stars[0].centre;
  const Vec3 pull = 5e-3 * split.mesh.points[centre].normalized();
  x.segment<3>(3 * centre) += pull;
  const std::vector<Vec3> moved = blend_all(skin.stencils, skin.stencils.value, x);
  double largest = 0;
  for (std::size_t r = 0; r < rest.size(); ++r) {
    const double by = (moved[r] - rest[r]).norm();
    largest = std::max(largest, by);
    if ((rest[r] - split.mesh.points[centre]).norm() > radius) {
      EXPECT_LT(by, 1e-15);
    }
  }
  // A Loop node in three triangles keeps 1 - 3 / (3 / (8 * 3 / 16) + 3) = 0.4 of its motion.
  EXPECT_NEAR(largest, 0.4 * pull.norm(), 1e-9);
}

}  // namespace
}  // namespace calot::star_skin_test
