#include "geometry/sphere_hull.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace calot::test {
namespace {

std::vector<Vec3> random_points(int count) {
  Rng rng(5);
  std::vector<Vec3> points;
  while (static_cast<int>(points.size()) < count) {
    const Vec3 p(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    if (p.norm() > 0.1 && p.norm() < 1) points.push_back(p.normalized());
  }
  return points;
}

TEST(SphereHull, NoPointLiesOutsideAnyFace) {
  const std::vector<Vec3> points = random_points(300);
  const auto faces = sphere_hull(points);
  ASSERT_TRUE(faces);
  EXPECT_EQ(faces->size(), 2 * points.size() - 4);
  for (const auto& [a, b, c] : faces.value()) {
    const Vec3 normal = (points[b] - points[a]).cross(points[c] - points[a]);
    for (const Vec3& p : points) EXPECT_LE(normal.dot(p - points[a]), 1e-15);  // rounding of unit coordinates
  }
}

TEST(SphereHull, CutsSquareFacesInTwo) {
  std::vector<Vec3> cube;
  for (int i = 0; i < 8; ++i)
    cube.push_back(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).normalized());
  const auto faces = sphere_hull(cube);
  ASSERT_TRUE(faces);
  EXPECT_EQ(faces->size(), 12u);
}

TEST(SphereHull, RefusesPointsThatCoincideOrLieInOnePlane) {
  std::vector<Vec3> points = random_points(20);
  points.push_back(points[3]);
  EXPECT_FALSE(sphere_hull(points));
  EXPECT_FALSE(sphere_hull(std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}));
  EXPECT_FALSE(sphere_hull({}));
}

}  // namespace
}  // namespace calot::test
