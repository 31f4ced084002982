#include "view/clip_mesh.h"

#include <gtest/gtest.h>

#include "sim/act_rig.h"

namespace calot {
namespace {

TEST(ClipMesh, ItsLegsLieToBothSidesOfTheFlatTubeAndSpanIt) {
  test::Acting acting(test::across(InstrumentType::clip_applier));
  const double depth = test::tube_depth + 5e-3;
  const std::size_t loaded = loaded_clip(acting.world.field().tools[0]).size();
  EXPECT_EQ(loaded, 1u);
  ASSERT_TRUE(acting.go({0, 0, depth - 25e-3, 0, 0.4}, 2) && acting.go({0, 0, depth, 0, 0.4}, 6));
  ASSERT_TRUE(acting.fire());
  const Organ& organ = acting.world.field().organs[0];
  const std::vector<SceneMesh> clips = clip_meshes(organ);
  ASSERT_EQ(clips.size(), 1u);
  double left = 0, right = 0, low = 0, high = -1;
  for (const Vec3& p : clips[0].positions) {
    // The tube runs along y, the legs along z, their sides are along x; two walls of 0.8 mm are between them.
    EXPECT_LT(std::abs(p.y()), 0.5e-3);
    left = std::min(left, p.x());
    right = std::max(right, p.x());
    low = std::min(low, p.z());
    high = std::max(high, p.z());
    const bool beside_tube = p.z() < -test::tube_depth + 2e-3;
    EXPECT_TRUE(!beside_tube || std::abs(p.x()) > 0.75e-3) << p.transpose();
  }
  EXPECT_NEAR(right - left, 2 * (0.8e-3 + 0.8e-3), 0.1e-3);
  EXPECT_NEAR(high - low, clip_row(ClipSize::ml).leg, 0.8e-3);
  EXPECT_LT(low, -test::tube_depth - 2.4e-3) << "its tips are seen beyond the tube";
}

TEST(ClipMesh, AnEmptyApplierShowsNone) {
  SceneDefinition scene = test::across(InstrumentType::clip_applier);
  scene.instruments[0].clips = 0;
  test::Acting acting(scene);
  EXPECT_TRUE(loaded_clip(acting.world.field().tools[0]).empty());
}

}  // namespace
}  // namespace calot
