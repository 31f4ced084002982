// Surfaces of rigid things: closed, of the size that they say, and with points that stand close enough.

#include "geometry/solid_surface.h"

#include <gtest/gtest.h>

#include <numbers>

#include "geometry/solid_moments.h"

namespace calot {
namespace {

using std::numbers::pi;

double longest_edge(const TriMesh& mesh) {
  double longest = 0;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (mesh.points[t[(k + 1) % 3]] - mesh.points[t[k]]).norm());
  return longest;
}

TEST(SolidSurface, ARingIsClosedAndComesNearToATorusAsTheSquareOfItsSpacing) {
  const double radius = 9e-3, rod = 2e-3, volume = 2 * pi * pi * radius * rod * rod;
  std::vector<double> missed;
  for (const double spacing : {0.4e-3, 0.2e-3}) {
    const TriMesh ring = ring_surface(radius, rod, spacing);
    EXPECT_TRUE(check(ring).empty()) << to_text(Failure{FailureKind::scenario, check(ring)});
    EXPECT_LT(longest_edge(ring), 1.5 * spacing);
    const SolidMoments moments = mesh_moments(ring);
    EXPECT_LT(moments.centroid.norm(), 1e-12);
    // Of a torus about z: the integral of z^2 is volume * rod^2 / 4.
    EXPECT_NEAR(moments.second(2, 2) / (0.25 * volume * rod * rod), 1, 0.1);
    missed.push_back(1 - moments.volume / volume);
  }
  EXPECT_GT(missed[0], 0) << "its points lie on the torus, its triangles inside";
  EXPECT_NEAR(missed[0] / missed[1], 4, 0.3);
}

TEST(SolidSurface, ARingBeginsInItsHole) {
  const TriMesh ring = ring_surface(9e-3, 2e-3, 1.5e-3);
  EXPECT_LT((ring.points[0] - Vec3(7e-3, 0, 0)).norm(), 1e-12);
}

TEST(SolidSurface, ShortEdgesLeaveASurfaceWhereItIsAndClosed) {
  // A flat, long box: its edges are from 1 to 30 mm long.
  TriMesh box = rounded_box(Vec3(30e-3, 6e-3, 1e-3), 0.5e-3, Vec3(1e-3, 2e-3, 3e-3), 20e-3);
  const SolidMoments before = mesh_moments(box);
  ASSERT_GT(longest_edge(box), 5e-3);
  const std::vector<Vec3> points = box.points;
  const TriMesh fine = with_short_edges(std::move(box), 2e-3, 100000);
  EXPECT_LE(longest_edge(fine), 2e-3);
  EXPECT_TRUE(check(fine).empty()) << to_text(Failure{FailureKind::scenario, check(fine)});
  const SolidMoments after = mesh_moments(fine);
  EXPECT_NEAR(after.volume, before.volume, 1e-12 * before.volume);
  EXPECT_LT((after.second - before.second).norm(), 1e-12 * before.second.norm());
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_EQ(fine.points[k], points[k]) << "points stay first";
}

TEST(SolidSurface, ShortEdgesStopWhereTheyWouldBeTooMany) {
  const TriMesh box = rounded_box(Vec3(30e-3, 6e-3, 1e-3), 0.5e-3, Vec3::Zero(), 20e-3);
  const TriMesh stopped = with_short_edges(box, 0.1e-3, 1000);
  EXPECT_GT(stopped.triangles.size(), 1000u) << "who asks sees that it did not end";
  EXPECT_GT(longest_edge(stopped), 0.1e-3);
}

}  // namespace
}  // namespace calot
