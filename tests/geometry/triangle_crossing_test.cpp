#include "geometry/triangle_crossing.h"

#include <gtest/gtest.h>

namespace calot {
namespace {

const std::array<Vec3, 3> triangle{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};

TEST(TriangleCrossing, IsMeasuredInWaysFromEitherSide) {
  const Vec3 above(0.2, 0.3, 2), below(0.2, 0.3, -2);
  EXPECT_DOUBLE_EQ(met_at(triangle, above, {0, 0, -1}).value(), 2);
  EXPECT_DOUBLE_EQ(met_at(triangle, above, {0, 0, -4}).value(), 0.5);
  EXPECT_DOUBLE_EQ(met_at(triangle, below, {0, 0, 1}).value(), 2);
  EXPECT_DOUBLE_EQ(met_at(triangle, above, {0, 0, 1}).value(), -2) << "it lies behind";
  EXPECT_DOUBLE_EQ(met_at(triangle, {0.2, -1.7, 2}, {0, 1, -1}).value(), 2) << "aslant";
}

TEST(TriangleCrossing, IsNoneBesideItOrInItsPlane) {
  for (const Vec3& past : {Vec3(0.6, 0.6, 2), Vec3(-0.1, 0.5, 2), Vec3(0.5, -0.1, 2)})
    EXPECT_FALSE(met_at(triangle, past, {0, 0, -1})) << past.transpose();
  EXPECT_FALSE(met_at(triangle, {-1, 0.2, 0}, {1, 0, 0}));
}

}  // namespace
}  // namespace calot
