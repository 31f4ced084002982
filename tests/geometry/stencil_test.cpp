#include "geometry/stencil.h"

#include <gtest/gtest.h>

namespace calot::test {
namespace {

/// Two rows over three points.
StencilTable two_rows() {
  StencilTable table;
  table.begin = {0, 2, 5};
  table.node = {0, 2, 0, 1, 2};
  table.value = {0.25, 0.75, 0.5, 0.2, 0.3};
  return table;
}

TEST(Stencil, SpreadIsTheTransposeOfBlend) {
  const StencilTable table = two_rows();
  const std::vector<Vec3> points = {{1, 2, 3}, {-4, 5, 6}, {7, -8, 9}};
  const std::vector<Vec3> forces = {{0.3, -0.1, 2}, {1, 4, -2}};
  VecX nodal = VecX::Zero(9);
  spread(table, forces, nodal);
  const std::vector<Vec3> blended = blend_all(table, table.value, to_coordinates(points));
  const double work = forces[0].dot(blended[0]) + forces[1].dot(blended[1]);
  EXPECT_NEAR(nodal.dot(to_coordinates(points)), work, 1e-13);  // the same virtual work either way
}

TEST(Stencil, CoordinatesHoldThePointsOneAfterTheOther) {
  VecX wanted(6);
  wanted << 1, 2, 3, -4, 5, 6;
  EXPECT_EQ(to_coordinates({{1, 2, 3}, {-4, 5, 6}}), wanted);
}

}  // namespace
}  // namespace calot::test
