// The search for pairs of two skins against looking at all of them.

#include <gtest/gtest.h>

#include "collision/skin_contact.h"
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

}  // namespace
}  // namespace skin_search_test
}  // namespace calot
