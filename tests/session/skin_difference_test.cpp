// How differently two skins have moved, against closed forms.

#include "session/skin_difference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/shapes.h"
#include "geometry/tri_mesh.h"

namespace calot::skin_difference_test {
namespace {

/// A ball of `nodes` points that each stand for as much, moved by `motion`.
template <typename Motion>
MovedSkin ball(int nodes, const Motion& motion) {
  TriMesh mesh = revolve(sphere_profile(1), nodes).value();
  MovedSkin out{mesh.points, {}, std::vector<double>(mesh.points.size(), 1.0), mesh.triangles};
  for (const Vec3& p : out.rest) out.motion.push_back(motion(p));
  return out;
}

TEST(SkinDifference, ConstantDifferencesAreFoundWhateverTheMeshes) {
  const Vec3 a(3, 0, 4), b(3, 1, 4);
  const auto found =
      skin_difference(ball(61, [&](const Vec3&) { return b; }), ball(245, [&](const Vec3&) { return a; }));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->mean_pct, 100.0 / 5, 1e-9);  // rounding
  EXPECT_NEAR(found->largest_pct, 100.0 / 5, 1e-9);
}

TEST(SkinDifference, TheSameLinearMotionDiffersAsFarAsTheSurfacesDo) {
  const auto linear = [](const Vec3& p) { return Vec3(0.3 * p.y(), -0.2 * p.z(), 0.5 * p.x()); };
  const MovedSkin coarse = ball(100, linear), fine = ball(400, linear);
  const auto itself = skin_difference(fine, fine), other = skin_difference(coarse, fine);
  ASSERT_TRUE(itself && other);
  EXPECT_LT(itself->largest_pct, 1e-9);  // rounding
  // Chords of 100 points are e = 0.38 long and within e^2 / 6 = 2.4 % of the ball; half an edge aside of the nearest
  // place would be 19 %.
  EXPECT_GT(other->mean_pct, 0);
  EXPECT_LT(other->largest_pct, 3);
}

TEST(SkinDifference, ItIsOverTheReferencesAreaAndLargestMotion) {
  const auto still = [](const Vec3&) { return Vec3(0, 0, 0); };
  const auto top = [](const Vec3& p) { return p.z() > 0 ? Vec3(0, 0, 2) : Vec3(0, 0, 0); };
  MovedSkin reference = ball(245, top);
  double upper = 0, all = 0;
  for (std::size_t i = 0; i < reference.rest.size(); ++i) {
    reference.areas[i] = reference.rest[i].z() > 0 ? 3 : 1;
    all += reference.areas[i];
    if (reference.rest[i].z() > 0) upper += reference.areas[i];
  }
  const auto found = skin_difference(ball(61, still), reference);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->mean_pct, 100 * upper / all, 1e-9);  // rounding
  EXPECT_NEAR(found->largest_pct, 100, 1e-9);
  EXPECT_FALSE(skin_difference(reference, ball(61, still))) << "a share of no motion";
}

}  // namespace
}  // namespace calot::skin_difference_test
