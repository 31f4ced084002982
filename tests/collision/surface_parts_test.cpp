// A potential of the distances from a triangulation: what is summed, and how smooth that is.

#include "collision/surface_parts.h"

#include <gtest/gtest.h>

#include "collision/barrier.h"
#include "collision/simplex_distance.h"
#include "support/bodies.h"

namespace calot {
namespace {

constexpr double range = 0.4e-3, gap = 1e-3;

/// A square net of triangles with corners `gap` apart, `height` above z = 0.
struct Net {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;

  template <class Height>
  Net(int across, const Height& height) {
    for (int i = 0; i <= across; ++i)
      for (int j = 0; j <= across; ++j) points.emplace_back(gap * i, gap * j, height(i, j));
    for (int i = 0; i < across; ++i) {
      for (int j = 0; j < across; ++j) {
        const int a = i * (across + 1) + j, b = a + across + 1;
        triangles.push_back({a, a + 1, b});
        triangles.push_back({a + 1, b, b + 1});
      }
    }
  }
  double potential(const Vec3& p, Vec3& gradient, bool triangles_alone = false) const {
    std::vector<Triangle> faces;
    for (const Triangle& t : triangles) {
      const std::array<Vec3, 3> corners{points[t[0]], points[t[1]], points[t[2]]};
      if (nearest_point(p, corners).distance < range) faces.push_back(t);
    }
    double sum = 0;
    gradient.setZero();
    const auto add = [&](const Vec3& from, int times) {
      const BarrierSample b = Barrier{range}.sample((p - from).norm());
      sum += times * b.energy;
      gradient += times * b.derivative * (p - from).normalized();
    };
    if (triangles_alone) {
      for (const Triangle& t : faces) {
        const std::array<Vec3, 3> corners{points[t[0]], points[t[1]], points[t[2]]};
        const NearestPoint nearest = nearest_point(p, corners);
        Vec3 at = Vec3::Zero();
        for (int k = 0; k < 3; ++k) at += nearest.weight[k] * corners[k];
        add(at, 1);
      }
      return sum;
    }
    for (const SurfacePart& part : surface_parts(p, faces, points, range)) {
      std::array<Vec3, 3> corners;
      for (int k = 0; k < part.corners; ++k) corners[k] = points[part.corner[k]];
      const FlatSample s = sample_flat(p, {corners.data(), static_cast<std::size_t>(part.corners)});
      add(p - s.distance * s.normal, part.times);
    }
    return sum;
  }
};

TEST(SurfaceParts, AboveAFlatThePotentialDoesNotDependOnTheTriangles) {
  const Net flat(6, [](int, int) { return 0.0; });
  const double height = 0.2e-3, expected = Barrier{range}.sample(height).energy;
  Rng rng(1);
  double alone = 0;
  Vec3 ignored;
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 p(rng.uniform(2, 4) * gap, rng.uniform(2, 4) * gap, height);
    EXPECT_NEAR(flat.potential(p, ignored), expected, 1e-9 * expected);
    alone = std::max(alone, flat.potential(p, ignored, true));
  }
  EXPECT_GT(alone, 2 * expected);
}

TEST(SurfaceParts, ThePotentialHasNoKinkOverRidgesAndValleys) {
  Rng rng(2);
  std::vector<double> heights(49);
  for (double& h : heights) h = rng.uniform(-0.15, 0.15) * gap;
  const Net bumpy(6, [&](int i, int j) { return heights[7 * i + j]; });
  double largest = 0, rise = 0, fall = 0;
  for (int way = 0; way < 5; ++way) {
    // On the way the potential is the integral of its slope: a kink or a jump would break that.
    const Vec3 from(rng.uniform(2, 4) * gap, rng.uniform(2, 4) * gap, 0.3 * gap);
    const Vec3 to(rng.uniform(2, 4) * gap, rng.uniform(2, 4) * gap, 0.3 * gap);
    constexpr int steps = 4000;
    Vec3 gradient, before;
    double value = bumpy.potential(from, before);
    for (int k = 1; k <= steps; ++k) {
      const double next = bumpy.potential(from + (to - from) * k / steps, gradient);
      const Vec3 step = (to - from) / steps;
      const double by_slope = 0.5 * (gradient + before).dot(step);
      // The trapezium errs by the square of the step, a jump of the slope by as much as the slope jumps.
      EXPECT_NEAR(next - value, by_slope, 5e-3 * (std::abs(by_slope) + 1e-3));
      largest = std::max(largest, next);
      (next > value ? rise : fall) += std::abs(next - value);
      value = next;
      before = gradient;
    }
  }
  EXPECT_GT(largest, 0.05);
  EXPECT_GT(rise, 0.1);
  EXPECT_GT(fall, 0.1);
}

}  // namespace
}  // namespace calot
