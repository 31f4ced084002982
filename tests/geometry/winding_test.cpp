// What is inside a closed surface.

#include "geometry/winding.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "support/random.h"

namespace calot {
namespace {

TEST(Winding, IsOneInsideAndNoneOutside) {
  const TriMesh mesh = revolve(sphere_profile(1.0), 61).value();
  double inner = 2;  // m: as far from the middle as its triangles at least
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    inner = std::min(inner, a.dot((b - a).cross(c - a).normalized()));
  }
  Rng rng(1);
  int inside = 0, outside = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 p = test::random_vector(rng, 1.3);
    if (p.norm() >= inner && p.norm() <= 1.001) continue;
    ++(p.norm() < inner ? inside : outside);
    EXPECT_NEAR(winding_number(p, mesh.points, mesh.triangles), p.norm() < inner ? 1 : 0, 1e-12);
  }
  EXPECT_GT(std::min(inside, outside), 40);
}

}  // namespace
}  // namespace calot
