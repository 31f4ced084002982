// The search for pairs of two skins against looking at all of them.

#include <gtest/gtest.h>

#include "collision/skin_contact.h"
#include "collision/skin_edges.h"
#include "support/random.h"

namespace calot {
namespace skin_search_test {
namespace {

using Points = std::vector<Vec3>;

/// Random triangles or segments of a few millimetres in a cloud of some centimetres, some points without an area.
struct Cloud {
  Points points, motions;
  ContactSkin skin;

  Cloud(Rng& rng, bool surface, double radius, double speed)
      : points(places(rng)),
        skin(points, surface ? triangles(rng) : std::vector<Triangle>(),
             surface ? std::vector<Segment>() : segments(), radius, areas()) {
    const Vec3 drift = test::random_vector(rng, speed);
    for (std::size_t k = 0; k < points.size(); ++k)
      motions.push_back(drift + test::random_vector(rng, 0.1 * speed));
  }
  static constexpr int count = 120;
  static Points places(Rng& rng) {
    Points out;
    const Vec3 middle = test::random_vector(rng, 10e-3);
    for (int k = 0; k < count; ++k) out.push_back(middle + test::random_vector(rng, 12e-3));
    return out;
  }
  static std::vector<Triangle> triangles(Rng& rng) {
    std::vector<Triangle> out;
    for (int k = 0; k + 2 < count; ++k) {
      const int turn = rng.uniform(0, 1) < 0.5 ? 1 : 2;
      out.push_back({k + turn, k, k + 3 - turn});
    }
    return out;
  }
  static std::vector<Segment> segments() {
    std::vector<Segment> out;
    for (int k = 1; k < count; ++k) out.push_back({k, k - 1});
    return out;
  }
  static std::vector<double> areas() {
    std::vector<double> out(count, 1e-6);
    for (int k = 0; k < count; k += 5) out[k] = 0;
    return out;
  }
};

struct Field {
  std::vector<Cloud> clouds;
  explicit Field(Rng& rng, double speed) {
    for (bool surface : {true, false, true, false})
      clouds.emplace_back(rng, surface, surface ? 0 : 0.7e-3, speed);
  }
  std::vector<PlacedSkin> placed(bool moving) const {
    std::vector<PlacedSkin> out;
    for (const Cloud& c : clouds) out.push_back({&c.skin, &c.points, moving ? &c.motions : nullptr});
    return out;
  }
};

std::vector<SkinPair> by_looking_at_all(std::span<const PlacedSkin> skins, const SkinReach& wanted) {
  std::vector<SkinPair> out;
  for (int a = 0; a < static_cast<int>(skins.size()); ++a) {
    for (int p = 0; p < Cloud::count; ++p) {
      for (int b = 0; b < static_cast<int>(skins.size()); ++b) {
        if (a == b || skins[a].skin->area(p) == 0) continue;
        for (int s = 0; s < skins[b].skin->simplices(); ++s) {
          Points corners;
          double motion = 0;
          for (int corner : skins[b].skin->corners(s)) {
            corners.push_back((*skins[b].points)[corner]);
            if (skins[a].motions)
              motion = std::max(motion, ((*skins[a].motions)[p] - (*skins[b].motions)[corner]).norm());
          }
          const double gap = nearest_point((*skins[a].points)[p], corners).distance -
                             skins[a].skin->radius() - skins[b].skin->radius();
          if (gap < std::max(wanted.reach, motion / wanted.lost)) out.push_back({a, p, b, s});
        }
      }
    }
  }
  return out;
}

TEST(SkinSearch, FindsWhatLookingAtAllPairsFindsInThatOrder) {
  Rng rng(1);
  for (double reach : {0.4e-3, 3e-3}) {
    const Field field(rng, 0);
    const std::vector<PlacedSkin> skins = field.placed(false);
    const std::vector<SkinPair> found = skin_pairs(skins, {reach, 1});
    EXPECT_EQ(found, by_looking_at_all(skins, {reach, 1}));
    EXPECT_GT(found.size(), 20u);
    EXPECT_EQ(found, skin_pairs(skins, {reach, 1}));
    Workers workers(3);
    EXPECT_EQ(found, skin_pairs(skins, {reach, 1}, &workers));
  }
}

TEST(SkinSearch, FindsEverythingThatCouldLoseItsShareOnTheWay) {
  Rng rng(2);
  for (double speed : {0.2e-3, 4e-3}) {
    const Field field(rng, speed);
    const std::vector<PlacedSkin> skins = field.placed(true);
    const SkinReach wanted{0.1e-3, 0.8};
    const std::vector<SkinPair> found = skin_pairs(skins, wanted);
    EXPECT_EQ(found, by_looking_at_all(skins, wanted));
    EXPECT_GT(found.size(), skin_pairs(field.placed(false), wanted).size());
  }
}

TEST(SkinSearch, ASkinThatIsCarriedAlongByAllTheOthersFindsNoMore) {
  Rng rng(3);
  Field field(rng, 0);
  for (Cloud& c : field.clouds) c.motions.assign(c.points.size(), Vec3(1, 2, 3));
  EXPECT_EQ(skin_pairs(field.placed(true), {0.4e-3, 0.5}), skin_pairs(field.placed(false), {0.4e-3, 0.5}));
}

TEST(SkinSearch, SkinsWithoutPointsThatActOrWithoutSimplicesMeetNothingOfTheirOwn) {
  Rng rng(4);
  const Cloud cloud(rng, true, 0, 0);
  const ContactSkin corners_only(cloud.points, {}, {}, 0, std::vector<double>(cloud.points.size(), 0.0)),
      nothing({}, {}, {}, 0, {});
  const Points none;
  const std::array<PlacedSkin, 3> skins{PlacedSkin{&cloud.skin, &cloud.points, nullptr},
                                        PlacedSkin{&corners_only, &cloud.points, nullptr},
                                        PlacedSkin{&nothing, &none, nullptr}};
  EXPECT_TRUE(skin_pairs(skins, {1e-3, 1}).empty());
  EXPECT_TRUE(skin_pairs({}, {1e-3, 1}).empty());
}

/// A cloud's edges but for every fifth.
struct EdgeCloud {
  Cloud cloud;
  SurfaceEdges edges;
  ItemTree tree{{}, {}};

  EdgeCloud(Rng& rng, double speed) : cloud(rng, true, 0, speed), edges(cloud.points, Cloud::triangles(rng)) {
    std::vector<int> some;
    for (int e = 0; e < static_cast<int>(edges.ends.size()); ++e)
      if (e % 5 > 0) some.push_back(e);
    tree = ItemTree(edges.middles(cloud.points), some);
  }
  PlacedEdges placed(bool moving) const { return {&edges, &cloud.points, moving ? &cloud.motions : nullptr}; }
};

TEST(SkinSearch, FindsTheEdgesThatAreNear) {
  Rng rng(5);
  const EdgeCloud one(rng, 0), other(rng, 0);
  constexpr double reach = 0.5e-3;
  std::vector<EdgesNear> expected;
  for (int a = 0; a < static_cast<int>(one.edges.ends.size()); ++a)
    for (int b = 0; b < static_cast<int>(other.edges.ends.size()); ++b) {
      if (a % 5 == 0 || b % 5 == 0) continue;
      const double distance =
          nearest_of_edges(places_of(one.placed(false), other.placed(false), {a, b})).distance;
      if (distance < reach) expected.push_back({a, b, distance});
    }
  const std::vector<EdgesNear> found =
      near_edges(one.placed(false), one.tree, other.placed(false), other.tree, {reach, 1});
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_GT(found.size(), 20u);
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(std::pair(found[k].edge, found[k].other), std::pair(expected[k].edge, expected[k].other));
    EXPECT_NEAR(found[k].distance, expected[k].distance, 1e-12);
  }
  Workers workers(3);
  const std::vector<EdgesNear> shared =
      near_edges(one.placed(false), one.tree, other.placed(false), other.tree, {reach, 1}, &workers);
  ASSERT_EQ(shared.size(), found.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    EXPECT_EQ(std::tuple(shared[k].edge, shared[k].other, shared[k].distance),
              std::tuple(found[k].edge, found[k].other, found[k].distance));
}

TEST(SkinSearch, NoEdgeThatIsNotFoundComesAsNearAsIsLookedFor) {
  Rng rng(6);
  constexpr double keep = 0.2, most = 0.1e-3;
  for (const double speed : {0.2e-3, 4e-3}) {
    const EdgeCloud one(rng, speed), other(rng, speed);
    const PlacedEdges a = one.placed(true), b = other.placed(true);
    const std::vector<EdgesNear> found = near_edges(a, one.tree, b, other.tree, {0, 1 - keep, keep * most});
    double share = 1, share_of_all = 1;
    for (const EdgesNear& pair : found) share = safe_share(a, b, pair, keep, share, most);
    std::size_t all = 0;
    for (int e = 0; e < static_cast<int>(one.edges.ends.size()); ++e)
      for (int f = 0; f < static_cast<int>(other.edges.ends.size()); ++f) {
        if (e % 5 == 0 || f % 5 == 0) continue;
        share_of_all = safe_share(a, b, {e, f}, keep, share_of_all, most);
        ++all;
      }
    EXPECT_NEAR(share, share_of_all, 1e-6);  // where several stop it, their order matters by rounding
    EXPECT_LT(share, 1);
    EXPECT_LT(found.size(), all / 4);
  }
}

TEST(SkinSearch, FindsEachTriangleThatAnEdgeGoesThrough) {
  Rng rng(7);
  const EdgeCloud one(rng, 0);
  const Cloud other(rng, true, 0, 0);
  std::vector<std::pair<int, int>> expected, found;
  for (int e = 0; e < static_cast<int>(one.edges.ends.size()); ++e)
    for (int s = 0; s < other.skin.simplices(); ++s) {
      if (e % 5 == 0) continue;
      const auto [from, to] = one.edges.ends[e];
      const Triangle& t = other.skin.triangle(s);
      // from + a (to - from) = corner + b u + c v.
      Mat3 sides;
      sides << one.cloud.points[from] - one.cloud.points[to], other.points[t[1]] - other.points[t[0]],
          other.points[t[2]] - other.points[t[0]];
      const Vec3 at = sides.inverse() * (one.cloud.points[from] - other.points[t[0]]);
      if (at.minCoeff() >= 0 && at.x() <= 1 && at.y() + at.z() <= 1) expected.emplace_back(e, s);
    }
  for (const PiercedTriangle& p :
       pierced_triangles(one.placed(false), one.tree, {&other.skin, &other.points, nullptr})) {
    found.emplace_back(p.edge, p.simplex);
    const auto [from, to] = one.edges.ends[p.edge];
    EXPECT_LT(nearest_point(p.place, std::array{one.cloud.points[from], one.cloud.points[to]}).distance,
              1e-12);
  }
  EXPECT_EQ(found, expected);
  EXPECT_GT(found.size(), 20u);
}

}  // namespace
}  // namespace skin_search_test
}  // namespace calot
