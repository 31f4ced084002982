#include "view/tissue_mesh.h"

#include "field/field_state.h"
#include "sim/act_rig.h"
#include "sim/triangle_rig.h"
#include "view/burnt_shares.h"
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
  for (const SceneMesh& mesh : tissue_meshes(world))
    for (const Vec3& p : mesh.positions) {
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

SceneDefinition areolar_sheet() {
  SceneDefinition scene = sheet_between_tubes();
  scene.anatomy.tissue[0].looks = TissueLooks::areolar;
  return scene;
}

/// 1: all that is drawn of the fibres is as white as any; of no fibres 0.
double whiteness(const World& world) {
  double sum = 0, points = 1e-9;
  for (const SceneMesh& mesh : tissue_meshes(world))
    for (const Vec3& p : mesh.rest_positions)
      if (p.z() >= 0) sum += p.z() / 1e-3, ++points;  // lobules of fat are below
  return sum / points;
}

TEST(AreolarTissue, IsDrawnAsFibresAndFilms) {
  std::vector<Material> materials;
  for (const SceneMesh& mesh : tissue_meshes(World::create(areolar_sheet()).value()))
    materials.push_back(mesh.material);
  EXPECT_EQ(materials, (std::vector{Material::areolar, Material::cobweb}));
}

TEST(AreolarTissue, WhitensAsItIsStretched) {
  World world = World::create(areolar_sheet()).value();
  const double slack = whiteness(world);
  FieldState state = world.state();
  VecX& nodes = state.group.tissues[0].state.x;
  for (Eigen::Index i = 2; i < nodes.size(); i += 3) nodes[i] += 12e-3;  // carried off by some hook
  ASSERT_TRUE(world.restore(state));
  EXPECT_LT(slack, 0.2);
  EXPECT_GT(whiteness(world), slack + 0.3);
}

TEST(AreolarTissue, ATornStrandIsNoBridge) {
  World world = World::create(areolar_sheet()).value();
  EXPECT_GT(extent(world).in_the_middle, 0);
  tear_all(world);
  EXPECT_EQ(extent(world).in_the_middle, 0);
  EXPECT_FALSE(tissue_meshes(world).empty()) << "a fuzz is left on both sides";
}

TEST(AreolarTissue, CoarseHasAThirdOfThePoints) {
  const World world = World::create(areolar_sheet()).value();
  const auto points = [&](SceneDetail detail) {
    std::size_t sum = 0;
    for (const SceneMesh& mesh : tissue_meshes(world, detail)) sum += mesh.positions.size();
    return sum;
  };
  EXPECT_LT(3 * points(SceneDetail::coarse), points(SceneDetail::full));
}

double most_burnt(const World& world) {
  const std::vector<double> shares = burnt_shares(world.field(), OrganIndex(0), nullptr);
  return shares.empty() ? 0 : *std::max_element(shares.begin(), shares.end());
}

TEST(BurntShares, WhereALoosePlaneHangsIsAWhitishSheetThatCharsWithIt) {
  SceneDefinition scene = test::triangle_scene();
  EXPECT_EQ(most_burnt(World::create(scene).value()), 0) << "fat leaves none";
  scene.anatomy.tissue[0].looks = TissueLooks::areolar;
  World world = World::create(scene).value();
  const double sheet = most_burnt(world);
  EXPECT_GT(sheet, 0.05) << "whitish";
  EXPECT_LT(sheet, 0.3) << "and no more";
  FieldState state = world.state();
  std::vector<double>& heated = state.group.tissues[0].heated;
  heated.assign(heated.size(), 1e3);
  ASSERT_TRUE(world.restore(state));
  EXPECT_GT(most_burnt(world), 0.6);
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

/// Two tubes, and a leaf over the second half of the first one.
SceneDefinition two_tubes_in_a_leaf(double goes_on) {
  SceneDefinition scene = sheet_between_tubes();
  scene.anatomy.tissue.clear();
  scene.anatomy.leaves = {{.from = "duct", .to = "other", .start = 0.5, .goes_on = goes_on}};
  return scene;
}

TEST(LeafMesh, OverTwoTubesLiesOnThePartOfThemThatItIsGiven) {
  for (const double goes_on : {0.0, 10e-3}) {
    const World world = World::create(two_tubes_in_a_leaf(goes_on)).value();
    const Organ& duct = world.field().organs[0];
    const Vec3 start = duct.body->skin_positions(duct.state.x).front(),
               end = duct.body->skin_positions(duct.state.x).back();
    const Eigen::AlignedBox3d box = [&] {
      Eigen::AlignedBox3d out;
      for (const Vec3& p : leaf_mesh(world).positions) out.extend(p);
      return out;
    }();
    const double middle = 0.5 * (start.y() + end.y()), spacing = 2e-3;
    EXPECT_NEAR(end.y() > middle ? box.min().y() : box.max().y(), middle, spacing);
    EXPECT_NEAR(end.y() > middle ? box.max().y() : box.min().y(), end.y(), spacing);
    const double before = std::min(0.0, box.min().x()), past = box.max().x() - 16e-3;
    EXPECT_LT(before, -2e-3) << "its free edge";
    EXPECT_NEAR(past - goes_on, 2e-3, 1e-3) << "it reaches around the other one, and on";
  }
}

TEST(LeafMesh, OverTwoTubesIsGoneWhereOneOfThemIs) {
  World world = World::create(two_tubes_in_a_leaf(0)).value();
  ASSERT_FALSE(leaf_mesh(world).triangles.empty());
  ASSERT_TRUE(world.remove("other", "to see what is left"));
  EXPECT_TRUE(leaf_mesh(world).triangles.empty());
}

}  // namespace
}  // namespace calot
