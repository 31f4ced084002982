// Distance of a point from simplices that move: against search, differences and the way of a motion.

#include "collision/simplex_distance.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace {

using Corners = std::array<Vec3, 3>;

std::span<const Vec3> first(const Corners& corners, int count) {
  return {corners.data(), static_cast<std::size_t>(count)};
}

/// A triangle and a point at random, 1 apart or so.
struct Places {
  Vec3 p;
  Corners corners;
  explicit Places(Rng& rng) : p(test::random_vector(rng, 1.0)) {
    for (Vec3& q : corners) q = test::random_vector(rng, 1.0);
  }
};

int corners_used(const NearestPoint& nearest) {
  return static_cast<int>(
      std::count_if(nearest.weight.begin(), nearest.weight.end(), [](double w) { return w > 0; }));
}

TEST(SimplexDistance, NoPointOfATriangleIsNearerThanTheNearest) {
  Rng rng(1);
  std::array<int, 4> seen{};
  for (int trial = 0; trial < 300; ++trial) {
    const Places at(rng);
    const NearestPoint nearest = nearest_point(at.p, at.corners);
    ++seen[corners_used(nearest)];
    Vec3 place = Vec3::Zero();
    for (int k = 0; k < 3; ++k) place += nearest.weight[k] * at.corners[k];
    EXPECT_NEAR((at.p - place).norm(), nearest.distance, 1e-14);
    // Rounding of the squares compared.
    constexpr int parts = 12;
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) {
        const Vec3 other = (i * at.corners[0] + j * at.corners[1] + (parts - i - j) * at.corners[2]) / parts;
        EXPECT_GE((at.p - other).norm(), nearest.distance - 1e-14);
      }
  }
  for (int used = 1; used <= 3; ++used) EXPECT_GT(seen[used], 20) << used;
}

TEST(SimplexDistance, ATriangleWithoutAreaCountsAsItsEdges) {
  const Corners line{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)},
      point{Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)};
  EXPECT_DOUBLE_EQ(nearest_point(Vec3(1.5, 2, 0), line).distance, 2);
  EXPECT_DOUBLE_EQ(nearest_point(Vec3(1, 1, 4), point).distance, 3);
}

TEST(SimplexDistance, GradientAndHessianAreSlopes) {
  Rng rng(2);
  for (int count = 1; count <= 3; ++count) {
    for (int trial = 0; trial < 5; ++trial) {
      const Places at(rng);
      const int size = 3 * (count + 1);
      VecX x(size);
      x.head<3>() = at.p;
      for (int k = 0; k < count; ++k) x.segment<3>(3 * (k + 1)) = at.corners[k];
      const auto corners_of = [&](const VecX& y) {
        Corners out;
        for (int k = 0; k < count; ++k) out[k] = y.segment<3>(3 * (k + 1));
        return out;
      };
      const auto value = [&](const VecX& y) {
        return sample_flat(y.head<3>(), first(corners_of(y), count)).distance;
      };
      const auto gradient = [&](const VecX& y) {
        const FlatSample s = sample_flat(y.head<3>(), first(corners_of(y), count));
        VecX out(size);
        for (int k = 0; k <= count; ++k) out.segment<3>(3 * k) = s.weight[k] * s.normal;
        return out;
      };
      // Third derivatives grow with the inverse square of the distance and of the triangle's height.
      const double h = 1e-5, bound = 1e-5;
      EXPECT_LT((gradient(x) - test::difference_gradient(value, x, h)).norm(), bound);
      const FlatSample s = sample_flat(at.p, first(at.corners, count));
      const Eigen::MatrixXd hessian = flat_hessian(first(at.corners, count), s).topLeftCorner(size, size);
      EXPECT_LT((hessian - test::difference_hessian(gradient, x, h)).norm(), bound * (1 + hessian.norm()));
      EXPECT_GT(gradient(x).norm(), 0.9);
      EXPECT_GT(hessian.norm(), 0.1);
    }
  }
}

/// Across the borders of the regions the distance from the triangle, made of flats, has no kink.
TEST(SimplexDistance, TheGradientIsContinuousWhereTheNearestPointPassesACorner) {
  const Corners t{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const auto normal_at = [&](const Vec3& p) {
    const NearestPoint n = nearest_point(p, t);
    Vec3 arm = p;
    for (int k = 0; k < 3; ++k) arm -= n.weight[k] * t[k];
    return Vec3(arm / n.distance);
  };
  Vec3 before = normal_at(Vec3(-1, 0.3, 0.2));
  constexpr int steps = 4000;
  for (int k = 1; k <= steps; ++k) {
    const Vec3 now = normal_at(Vec3(-1 + 3.0 * k / steps, 0.3 - 0.2 * k / steps, 0.2));
    EXPECT_LT((now - before).norm(), 2 * 3.1 / steps / 0.2);
    before = now;
  }
}

TEST(SimplexDistance, ASafeShareKeepsItsPartOfTheDistanceAndIsTheLargest) {
  constexpr double kept = 0.2;
  Rng rng(3);
  int cut = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Places at(rng), to(rng);
    const Vec3 motion = to.p - at.p;
    Corners motions;
    for (int k = 0; k < 3; ++k) motions[k] = to.corners[k] - at.corners[k];
    const auto distance = [&](double share) {
      Corners now;
      for (int k = 0; k < 3; ++k) now[k] = at.corners[k] + share * motions[k];
      return nearest_point(at.p + share * motion, now).distance;
    };
    const double share = safe_share(at.p, motion, at.corners, motions, kept), start = distance(0);
    for (int k = 0; k <= 200; ++k) EXPECT_GE(distance(share * k / 200), kept * start - 1e-12);
    if (share == 1.0) continue;
    ++cut;
    EXPECT_LT(distance(share + 1e-4), kept * start + 1e-3);
  }
  EXPECT_GT(cut, 50);
}

TEST(SimplexDistance, WhatTouchesOrIsNoPlaceMayNotMove) {
  const Corners t{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)},
      still{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  EXPECT_EQ(safe_share(Vec3(0.2, 0.2, 0), Vec3(0, 0, 1), t, still, 0.2), 0.0);
  EXPECT_EQ(safe_share(Vec3(0.2, 0.2, std::nan("")), Vec3(0, 0, 1), t, still, 0.2), 0.0);
  EXPECT_EQ(safe_share(Vec3(0.2, 0.2, 1), Vec3(0, 0, std::nan("")), t, still, 0.2), 0.0);
}

}  // namespace
}  // namespace calot
