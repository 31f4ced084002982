#include "view/tissue_mesh.h"

#include "field/field_state.h"
#include "sim/act_rig.h"
#include "view/leaf_mesh.h"

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

void tear_all(World& world) {
  FieldState state = world.state();
  ASSERT_EQ(state.group.tissues.size(), 1u);
  state.group.tissues[0].opened.assign(state.group.tissues[0].opened.size(), 1e3);
  ASSERT_TRUE(world.restore(state));
}

TEST(TissueMesh, WhatIsTornDrawsBackToBothSidesAndCurlsUpTowardsTheFront) {
  World world = World::create(sheet_between_tubes()).value();
  const Extent whole = extent(world);
  EXPECT_GT(whole.in_the_middle, 0);
  tear_all(world);
  const Extent torn = extent(world);
  EXPECT_EQ(torn.in_the_middle, 0) << "the sheet is open there";
  EXPECT_GT(torn.front, whole.front + 1e-3) << "its edges stand up";
}

SceneDefinition covered_sheet() {
  SceneDefinition scene = sheet_between_tubes();
  scene.anatomy.tissue[0].covered = true;
  return scene;
}

TEST(LeafMesh, CoversTheStrandsAndTheTubesTowardsTheFront) {
  const World world = World::create(covered_sheet()).value();
  const SceneMesh leaf = leaf_mesh(world);
  ASSERT_FALSE(leaf.triangles.empty());
  const VecX nodes = world.state().group.tissues[0].state.x;
  double strands = 0;  // m, how high their middles lie in the mean
  for (Eigen::Index i = 2; i < nodes.size(); i += 3)
    strands += 3 * nodes[i] / static_cast<double>(nodes.size());
  double left = 1, right = -1, over_strands = -1;
  for (std::size_t i = 0; i < leaf.positions.size(); ++i) {
    if (leaf.rest_positions[i].z() < 0.9e-3) continue;  // its faint rim
    const Vec3& p = leaf.positions[i];
    left = std::min(left, p.x());
    right = std::max(right, p.x());
    if (std::abs(p.x() - 8e-3) < 2e-3) over_strands = std::max(over_strands, p.z());
    EXPECT_GT(leaf.normals[i].z(), 0.3) << "it faces the front";
  }
  EXPECT_LT(left, 1e-3) << "up to the crest of one tube";
  EXPECT_GT(right, 15e-3) << "and of the other";
  EXPECT_GT(over_strands, strands + 1e-3) << "fat, a lobule thick, is below it";
}

TEST(LeafMesh, IsOpenWhereStrandsAreTorn) {
  World world = World::create(covered_sheet()).value();
  FieldState state = world.state();
  const std::size_t whole = leaf_mesh(world).triangles.size();
  std::vector<double>& opened = state.group.tissues[0].opened;
  const VecX& nodes = state.group.tissues[0].state.x;
  for (std::size_t i = 0; i < opened.size(); ++i)
    if (nodes[3 * static_cast<Eigen::Index>(i) + 1] > 0) opened[i] = 1e3;
  ASSERT_TRUE(world.restore(state));
  const std::size_t half = leaf_mesh(world).triangles.size();
  EXPECT_GT(half, 0.3 * static_cast<double>(whole));
  EXPECT_LT(half, 0.7 * static_cast<double>(whole));
  tear_all(world);
  EXPECT_TRUE(leaf_mesh(world).triangles.empty());
}

TEST(LeafMesh, LiesOnlyOnTissueThatIsSaidToBeCovered) {
  const World world = World::create(sheet_between_tubes()).value();
  EXPECT_TRUE(leaf_mesh(world).triangles.empty());
}

}  // namespace
}  // namespace calot
