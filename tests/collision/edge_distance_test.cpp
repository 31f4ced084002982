// Distance of two edges that move: against search and differences, and the way of a motion.

#include "collision/edge_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "collision/simplex_distance.h"
#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace {

EdgePair random_edges(Rng& rng, double reach) {
  EdgePair out;
  for (Vec3& end : out) end = test::random_vector(rng, reach);
  return out;
}

EdgePair along(const EdgePair& ends, const EdgePair& motions, double share) {
  EdgePair out;
  for (int k = 0; k < 4; ++k) out[k] = ends[k] + share * motions[k];
  return out;
}

double nearest_end(const EdgePair& e) {
  double out = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 4; ++k)
    out = std::min(out, nearest_point(e[k], {e.data() + (k < 2 ? 2 : 0), 2}).distance);
  return out;
}

/// Random edges, every third with the other nearly parallel to the first, by 1e-1 to 1e-9.
EdgePair edges_of_all_kinds(Rng& rng, int trial) {
  EdgePair e = random_edges(rng, 1.0);
  if (trial % 3 == 0)
    e[3] = e[2] + (e[1] - e[0]) + std::pow(10.0, rng.uniform(-9, -1)) * test::random_vector(rng, 1.0);
  return e;
}

TEST(EdgeDistance, NoPlacesOfTwoEdgesAreNearerThanTheNearest) {
  Rng rng(1);
  std::map<EdgesMeet, int> seen;
  for (int trial = 0; trial < 600; ++trial) {
    const EdgePair e = edges_of_all_kinds(rng, trial);
    const NearestOfEdges nearest = nearest_of_edges(e);
    ++seen[nearest.meet];
    Vec3 arm = Vec3::Zero();
    for (int k = 0; k < 4; ++k) arm += nearest.weight[k] * e[k];
    // Places on nearly parallel edges are as uncertain as rounding is large against their sine, which is above 1e-6.
    EXPECT_LT((arm - nearest.distance * nearest.normal).norm(), 1e-9);
    EXPECT_NEAR(nearest.normal.norm(), 1, 1e-9);
    EXPECT_NEAR(nearest.weight[0] + nearest.weight[1], 1, 1e-15);
    EXPECT_NEAR(nearest.weight[2] + nearest.weight[3], -1, 1e-15);
    for (int k = 0; k < 4; ++k) EXPECT_GE((k < 2 ? 1 : -1) * nearest.weight[k], 0);
    constexpr int parts = 20;
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; j <= parts; ++j) {
        const Vec3 a = e[0] + (e[1] - e[0]) * i / parts, b = e[2] + (e[3] - e[2]) * j / parts;
        EXPECT_GE((a - b).norm(), nearest.distance - 1e-12);
      }
  }
  for (EdgesMeet meet : {EdgesMeet::between_ends, EdgesMeet::at_one_end, EdgesMeet::at_two_ends})
    EXPECT_GT(seen[meet], 50);
}

/// So that a pair of edges and a pair of a point and a triangle never stand for the same nearest places.
TEST(EdgeDistance, TheCheapWayIsTheNearestToo) {
  Rng rng(21);
  for (int trial = 0; trial < 2000; ++trial) {
    EdgePair e = edges_of_all_kinds(rng, trial);
    if (trial % 5 == 0) e[1] = e[0];
    // Edges that run along each other to 1e-9 are as near as that at any place.
    EXPECT_NEAR(between_edges(e).norm(), nearest_of_edges(e).distance, trial % 3 == 0 ? 1e-7 : 1e-12)
        << trial;
    if (trial % 3 == 0) continue;
    const NearestOfEdges nearest = nearest_of_edges(e);
    EXPECT_LT((between_edges(e) - nearest.distance * nearest.normal).norm(), 1e-9) << trial;
  }
}

TEST(EdgeDistance, EdgesMeetBetweenTheirEndsOnlyWhereNoEndIsAsNear) {
  Rng rng(2);
  for (int trial = 0; trial < 600; ++trial) {
    const EdgePair e = edges_of_all_kinds(rng, trial);
    const NearestOfEdges nearest = nearest_of_edges(e);
    const auto ends_used =
        std::count_if(nearest.weight.begin(), nearest.weight.end(), [](double w) { return w != 0; });
    EXPECT_EQ(ends_used, nearest.meet == EdgesMeet::between_ends ? 4
                         : nearest.meet == EdgesMeet::at_one_end ? 3
                                                                 : 2);
    if (nearest.meet == EdgesMeet::between_ends)
      EXPECT_LE(nearest.distance, nearest_end(e) + 1e-12);  // rounding of nearly parallel edges
    else
      EXPECT_EQ(nearest.distance, nearest_end(e));
  }
}

TEST(EdgeDistance, ParallelAndPointlikeEdgesHaveADistance) {
  const Vec3 o = Vec3::Zero(), x = Vec3::UnitX(), y = Vec3::UnitY();
  const NearestOfEdges parallel = nearest_of_edges({o, x, Vec3(0.25, 2, 0), Vec3(0.75, 2, 0)});
  EXPECT_EQ(parallel.distance, 2);
  EXPECT_EQ(parallel.normal, Vec3(-y));
  EXPECT_EQ(parallel.meet, EdgesMeet::at_one_end);
  EXPECT_EQ(nearest_of_edges({o, o, 3 * x, 3 * x}).distance, 3);
  EXPECT_EQ(nearest_of_edges({o, o, 3 * x - y, 3 * x + y}).distance, 3);
  const NearestOfEdges touching = nearest_of_edges({-x, x, -y, y});
  EXPECT_EQ(touching.distance, 0);
  EXPECT_EQ(touching.normal, o);
}

TEST(EdgeDistance, WeightsTimesNormalIsTheSlope) {
  Rng rng(3);
  std::map<EdgesMeet, int> seen;
  for (int trial = 0; trial < 200; ++trial) {
    const EdgePair e = random_edges(rng, 1.0);
    const NearestOfEdges nearest = nearest_of_edges(e);
    if (nearest.distance < 0.05) continue;
    ++seen[nearest.meet];
    VecX x(12), slope(12);
    for (int k = 0; k < 4; ++k) x.segment<3>(3 * k) = e[k];
    for (int k = 0; k < 4; ++k) slope.segment<3>(3 * k) = nearest.weight[k] * nearest.normal;
    const auto value = [](const VecX& at) {
      return nearest_of_edges({at.segment<3>(0), at.segment<3>(3), at.segment<3>(6), at.segment<3>(9)})
          .distance;
    };
    // Differences over 1e-6 across a jump of the second derivative, which is at most 1 / distance and 1 / sine.
    EXPECT_LT((slope - test::difference_gradient(value, x, 1e-6)).norm(), 1e-4);
    EXPECT_GE(slope.norm(), 1 - 1e-12);  // each edge's end is pushed by at least half
  }
  for (EdgesMeet meet : {EdgesMeet::between_ends, EdgesMeet::at_one_end, EdgesMeet::at_two_ends})
    EXPECT_GT(seen[meet], 20);
}

/// Shares at which the four ends lie in one plane: only there may edges pass through each other.
std::vector<double> shares_in_one_plane(const EdgePair& e, const EdgePair& motions, double up_to) {
  const auto volume = [&](double share) {
    const EdgePair at = along(e, motions, share);
    return (at[2] - at[0]).dot((at[1] - at[0]).cross(at[3] - at[2]));
  };
  std::vector<double> out;
  constexpr int parts = 400;
  for (int k = 0; k < parts; ++k) {
    double low = up_to * k / parts, high = up_to * (k + 1) / parts;
    const bool below = volume(low) < 0;
    if (below == (volume(high) < 0)) continue;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      ((volume(middle) < 0) == below ? low : high) = middle;
    }
    out.push_back(high);
  }
  return out;
}

/// Edges of some mm at distances down to a hundredth of a millimetre, each end going its own way at up to 500 mm/s for
/// 20 ms.
TEST(EdgeDistance, NothingPassesOnTheWayOfASafeShareAndItIsTheLargest) {
  constexpr double keep = 0.2, fastest = 0.5 * 20e-3;
  Rng rng(4);
  int cut = 0, would_pass = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    EdgePair e = random_edges(rng, 1e-3), motions = random_edges(rng, fastest / std::sqrt(3.0));
    if (trial % 4 == 1) motions[1] = motions[0], motions[3] = motions[2];
    if (trial % 4 == 2) {  // just apart, over each other's middle
      const NearestOfEdges n = nearest_of_edges(e);
      for (int k : {2, 3}) e[k] += (n.distance - std::pow(10.0, rng.uniform(-5, -4))) * n.normal;
    }
    if (trial % 4 == 3) e[3] = e[2] + (e[1] - e[0]) + 1e-3 * (e[3] - e[2]);
    const double start = nearest_of_edges(e).distance;
    const auto distance = [&](double share) { return nearest_of_edges(along(e, motions, share)).distance; };
    const double share = safe_share(e, motions, keep);
    ASSERT_GT(share, 0);
    for (int k = 0; k <= 100; ++k) EXPECT_GE(distance(share * k / 100), keep * start - 1e-15);
    for (double s : shares_in_one_plane(e, motions, share)) EXPECT_GE(distance(s), keep * start - 1e-15);
    for (double s : shares_in_one_plane(e, motions, 1)) would_pass += distance(s) < 1e-9;
    if (share == 1.0) continue;
    ++cut;
    double fastest_end = 0;
    for (int i : {0, 1})
      for (int k : {2, 3}) fastest_end = std::max(fastest_end, (motions[i] - motions[k]).norm());
    EXPECT_LE(distance(share), keep * start + 1e-9 * fastest_end);
  }
  EXPECT_GT(cut, 500);
  EXPECT_GT(would_pass, 300);
}

TEST(EdgeDistance, WhatPartsOrSlidesIsFree) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), o = Vec3::Zero();
  const EdgePair crossed{-x, x, z - y, z + y};
  EXPECT_EQ(safe_share(crossed, {o, o, z, 5 * z}, 0.2), 1.0);
  EXPECT_EQ(safe_share(crossed, {o, o, x, x + 30 * y}, 0.2), 1.0);
  EXPECT_EQ(safe_share(crossed, {-2 * z, -2 * z, -2 * z, -2 * z}, 0.2), 1.0);
  EXPECT_NEAR(safe_share(crossed, {o, o, -10 * z, -10 * z}, 0.2), 0.08, 1e-15);
}

TEST(EdgeDistance, WhatTouchesOrIsNoPlaceMayNotMove) {
  const double nan = std::nan("");
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), o = Vec3::Zero();
  EXPECT_EQ(safe_share({-x, x, -y, y}, {o, o, z, z}, 0.2), 0.0);
  for (int k = 0; k < 4; ++k) {
    EdgePair bad{-x, x, z - y, z + y}, still{o, o, o, o};
    EXPECT_EQ(safe_share(bad, still, 0.2), 1.0);
    still[k].y() = nan;
    EXPECT_EQ(safe_share(bad, still, 0.2), 0.0);
    bad[k].z() = nan;
    EXPECT_EQ(safe_share(bad, {o, o, o, o}, 0.2), 0.0);
  }
}

}  // namespace
}  // namespace calot
