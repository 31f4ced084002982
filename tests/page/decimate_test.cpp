#include "page/decimate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace calot {
namespace {

TEST(Thinning, LosesNoPeakAndNoEnd) {
  PlanePoints points;
  for (int i = 0; i < 10000; ++i) points.push_back({0.02 * i, std::sin(0.01 * i)});
  points[4321][1] = 7;
  points[8765][1] = -7;
  const PlanePoints thin = thinned_over_x(points, 100);
  EXPECT_LE(thin.size(), 202u);
  for (const std::size_t peak : {std::size_t{0}, std::size_t{4321}, std::size_t{8765}, std::size_t{9999}})
    EXPECT_NE(std::find(thin.begin(), thin.end(), points[peak]), thin.end()) << peak;
  for (std::size_t i = 1; i < thin.size(); ++i) EXPECT_GE(thin[i][0], thin[i - 1][0]);
}

TEST(Thinning, LeavesWhatIsShortAsItIs) {
  const PlanePoints points{{0, 1}, {1, 2}, {2, 0}};
  EXPECT_EQ(thinned_over_x(points, 100), points);
  EXPECT_EQ(thinned_way(points, 0.1, 100), points);
  EXPECT_TRUE(thinned_over_x({}, 10).empty());
  EXPECT_TRUE(thinned_way({}, 1, 10).empty());
}

TEST(Thinning, OfAWayKeepsItsEndsAndItsBound) {
  PlanePoints points;
  for (int i = 0; i <= 5000; ++i) points.push_back({100 * std::cos(0.1 * i), 100 * std::sin(0.1 * i)});
  const PlanePoints thin = thinned_way(points, 0.5, 300);
  EXPECT_LE(thin.size(), 300u);
  EXPECT_GT(thin.size(), 100u);
  EXPECT_EQ(thin.front(), points.front());
  EXPECT_EQ(thin.back(), points.back());
}

TEST(Thinning, LeavesOutWhatIsNotFinite) {
  EXPECT_EQ(thinned_over_x({{0, 1}, {1, NAN}, {2, INFINITY}, {3, 2}}, 10), (PlanePoints{{0, 1}, {3, 2}}));
}

}  // namespace
}  // namespace calot
