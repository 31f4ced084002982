// What each criterion of the critical view of safety measures, and that it measures nothing else.

#include "world/critical_view.h"

#include <gtest/gtest.h>

#include "field/field_state.h"
#include "organs/strand_places.h"
#include "triangle_rig.h"
#include "world/sight.h"

namespace calot {
namespace {

using test::ball_neck;
using test::beside_neck;
using test::triangle_scene;

struct Judged : ::testing::Test {
  static World& world() {
    static World made = [] {
      Result<World> world = World::create(triangle_scene());
      EXPECT_TRUE(world) << to_text(world.failure());
      return std::move(world).value();
    }();
    return made;
  }
  static void SetUpTestSuite() { untouched() = world().state(); }
  static FieldState& untouched() {
    static FieldState state;
    return state;
  }
  void TearDown() override { ASSERT_TRUE(world().restore(untouched())); }

  static constexpr int plate = 0, fat = 1;
  /// Tears the strands of a tissue for which `which(share of its way, place)` holds.
  template <class Which>
  static void tear(int tissue_index, const Which& which) {
    FieldState state = world().state();
    const Field& field = world().field();
    const Tissue& tissue = field.tissues[tissue_index];
    const Organ& from = field.organs[tissue.strands->bodies()[0]];
    const std::vector<StrandLine> lines = strand_lines(tissue, field.organs);
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (which(share_along(from, tissue.strands->strands()[i].one), lines[i].from))
        state.group.tissues[tissue_index].opened[i] = 1e3;
    ASSERT_TRUE(world().restore(state));
  }
  static constexpr double lower = 1.0 / 3;
  static CriticalView judge(const Vec3& eye = beside_neck(22, -100, 0),
                            const CriticalViewQuestion& question = {}) {
    return critical_view(world().field(),
                         {beside_neck(2, 0, -3), beside_neck(37, 0, -19), beside_neck(37, 0, -3)},
                         Sight(world().field(), eye), question);
  }
};
constexpr auto everywhere = [](double, const Vec3&) { return true; };

TEST_F(Judged, TissueBetweenTheDuctsHidesTheTriangleUntilItIsTornAndChangesNothingElse) {
  const CriticalView before = judge();
  EXPECT_GT(before.front.open, 0.5);
  EXPECT_LT(before.front.cleared, 0.6);
  EXPECT_LT(before.back.cleared, 0.6);
  EXPECT_EQ(before.triangle_points, 0);
  tear(fat, [](double share, const Vec3&) { return share < 0.5; });
  const CriticalView half = judge();
  EXPECT_GT(half.front.cleared, before.front.cleared + 0.1);
  EXPECT_LT(half.front.cleared, 0.95);
  EXPECT_GT(half.back.cleared, before.back.cleared + 0.1);
  tear(fat, everywhere);
  const CriticalView after = judge();
  EXPECT_EQ(after.front.cleared, 1);
  EXPECT_EQ(after.back.cleared, 1);
  EXPECT_EQ(after.triangle_points, 2);
  for (const CriticalView& view : {half, after}) {
    EXPECT_EQ(view.front.open, before.front.open) << "tissue is not what closes a side";
    EXPECT_EQ(view.plate, before.plate);
    EXPECT_EQ(view.structures, before.structures);
  }
}

TEST_F(Judged, OfASideThatOrgansCloseNothingIsClearAndTheLesserSideEarnsThePoints) {
  tear(fat, everywhere);
  const CriticalView from_liver = judge(beside_neck(22, 100, 0));
  EXPECT_LT(from_liver.front.open, 0.1);
  EXPECT_EQ(from_liver.front.cleared, 0);
  EXPECT_EQ(from_liver.triangle_points, 0);
  CriticalViewQuestion question;
  question.behind = beside_neck(22, 100, 0);
  const CriticalView behind_liver = judge(beside_neck(22, -100, 0), question);
  EXPECT_EQ(behind_liver.front.cleared, 1);
  EXPECT_LT(behind_liver.back.open, 0.1) << "a lens that an author has put there is hidden from";
  EXPECT_EQ(behind_liver.triangle_points, 0);
  question.behind = beside_neck(22, 18, 0);
  EXPECT_EQ(judge(beside_neck(22, -100, 0), question).triangle_points, 2);
}

TEST_F(Judged, ThePlateCountsByItsStrandsOnTheLowerPartAlone) {
  const CriticalView before = judge();
  EXPECT_EQ(before.plate, 0);
  tear(plate, [](double share, const Vec3&) { return share > lower; });
  EXPECT_EQ(judge().plate, 0) << "the upper part is not asked for";
  tear(plate, [](double, const Vec3& at) { return at.x() < ball_neck.x(); });
  const CriticalView half = judge();
  EXPECT_GT(half.plate, 0.2);
  EXPECT_LT(half.plate, 0.8);
  tear(plate, [](double share, const Vec3&) { return share <= lower; });
  const CriticalView after = judge();
  EXPECT_EQ(after.plate, 1);
  EXPECT_EQ(after.plate_points, 2);
  EXPECT_EQ(after.front.cleared, before.front.cleared);
  EXPECT_EQ(after.back.cleared, before.back.cleared);
  EXPECT_EQ(after.free, before.free);
  CriticalViewQuestion higher;
  higher.lower_part = 0.9;
  ASSERT_TRUE(world().restore(untouched()));
  tear(plate, [](double share, const Vec3&) { return share <= lower; });
  EXPECT_LT(judge(beside_neck(22, -100, 0), higher).plate, 0.6);
}

TEST_F(Judged, TwoStructuresCountWhereEachIsFreeAround) {
  const CriticalView before = judge();
  EXPECT_EQ(before.structures, 2);
  EXPECT_EQ(before.free, 1) << "fat is on the duct, not on the artery";
  EXPECT_EQ(before.structure_points, 1);
  tear(fat, [](double share, const Vec3&) { return share > 0.5; });
  EXPECT_EQ(judge().free, 1) << "what was torn was far from the gallbladder";
  tear(fat, everywhere);
  EXPECT_EQ(judge().free, 2);
  EXPECT_EQ(judge().structure_points, 2);
  ASSERT_TRUE(world().divide("cystic_artery", 0.5));
  EXPECT_EQ(judge().structures, 1) << "a stump does not enter";
  EXPECT_EQ(judge().structure_points, 0);
  ASSERT_TRUE(world().restore(untouched()));
  tear(fat, everywhere);
  EXPECT_EQ(judge().structure_points, 2);
}

TEST_F(Judged, AThirdStructureLeavesNoPoint) {
  tear(fat, everywhere);
  ASSERT_TRUE(world().tie({"common_duct.start", "gallbladder.neck", 4e-3}));
  EXPECT_EQ(judge().structures, 3);
  EXPECT_EQ(judge().structure_points, 0);
}

}  // namespace
}  // namespace calot
