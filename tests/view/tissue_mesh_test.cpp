#include "view/tissue_mesh.h"

#include "sim/act_rig.h"
#include "sim/field_state.h"

namespace calot {
namespace {

/// A sheet of strands between two tubes, 16 mm apart.
SceneDefinition sheet_between_tubes() {
  SceneDefinition scene = test::across(InstrumentType::atraumatic_grasper);
  OrganDefinition other = test::tube_across("other");
  for (Vec3& p : std::get<TubeShape>(other.shape).points) p.x() += 16e-3;
  scene.anatomy.organs.push_back(other);
  scene.anatomy.tissue = {
      {.name = "sheet", .from = "duct", .to = "other", .within = 14e-3, .strands = 30, .break_energy = 500}};
  return scene;
}

struct Extent {
  int in_the_middle = 0;  ///< points drawn halfway between the tubes
  double front = -1;      ///< m, of the foremost
};

Extent extent(const World& world) {
  Extent out;
  for (const Vec3& p : tissue_mesh(world).positions) {
    out.in_the_middle += std::abs(p.x() - 8e-3) < 1e-3;
    out.front = std::max(out.front, p.z());
  }
  return out;
}

TEST(TissueMesh, WhatIsTornDrawsBackToBothSidesAndCurlsUpTowardsTheFront) {
  World world = World::create(sheet_between_tubes()).value();
  const Extent whole = extent(world);
  EXPECT_GT(whole.in_the_middle, 0);
  FieldState state = world.state();
  ASSERT_EQ(state.group.tissues.size(), 1u);
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(state.group.tissues[0].opened.size()); ++i)
    state.group.tissues[0].opened[i] = 1e3;
  ASSERT_TRUE(world.restore(state));
  const Extent torn = extent(world);
  EXPECT_EQ(torn.in_the_middle, 0) << "the sheet is open there";
  EXPECT_GT(torn.front, whole.front + 1e-3) << "its edges stand up";
}

}  // namespace
}  // namespace calot
