#include "geometry/edge_flips.h"

#include <gmock/gmock.h>

#include <numbers>

#include "geometry/shapes.h"

namespace calot::test {
namespace {

std::vector<int> valences(const TriMesh& mesh) {
  std::vector<int> count(mesh.points.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (int node : t) ++count[node];
  return count;
}

/// Flips the edge between the two first triangles that share one and leave a node with four.
TriMesh with_a_four() {
  TriMesh mesh = revolve(sphere_profile(1), 61).value();
  const std::vector<int> count = valences(mesh);
  for (Triangle& t : mesh.triangles)
    for (Triangle& other : mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
        if (count[a] != 5) continue;
        for (int j = 0; j < 3; ++j)
          if (other[j] == b && other[(j + 1) % 3] == a) {
            const int d = other[(j + 2) % 3];
            t = {c, d, b};
            other = {d, c, a};
            return mesh;
          }
      }
  return mesh;
}

TEST(EvenValences, TakesAFourAwayAndLeavesASoundMesh) {
  TriMesh mesh = with_a_four();
  ASSERT_THAT(check(mesh), ::testing::IsEmpty());
  ASSERT_THAT(valences(mesh), ::testing::Contains(4));
  even_valences(mesh, 0.4);
  EXPECT_THAT(check(mesh), ::testing::IsEmpty());
  EXPECT_THAT(valences(mesh), ::testing::Each(::testing::AllOf(::testing::Ge(5), ::testing::Le(7))));
}

TEST(EvenValences, FlipsNothingWhereAnglesWouldFallBelowTheLeast) {
  TriMesh mesh = with_a_four();
  const std::vector<Triangle> before = mesh.triangles;
  even_valences(mesh, std::numbers::pi / 3);  // no flip leaves only angles of sixty degrees and more
  EXPECT_EQ(mesh.triangles, before);
}

}  // namespace
}  // namespace calot::test
