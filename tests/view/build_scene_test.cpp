#include "view/build_scene.h"

#include "anatomy/organ_frame.h"
#include "render/image_compare.h"
#include "render/offscreen.h"

namespace calot {
namespace {

/// A sphere on its supporting plane and one grasper above it: the quickest whole world.
SceneDefinition sphere_scene() {
  SceneDefinition scene;
  OrganDefinition organ;
  organ.name = "ball";
  organ.shape = SphereShape{};
  organ.nodes = 61;
  organ.neck = Vec3(-60e-3, 110e-3, -100e-3);
  organ.fundus = organ.neck + Vec3(0, 0, 40e-3);
  organ.held.push_back({"base", "neck", 12e-3, 2e6});
  scene.anatomy.organs.push_back(organ);
  scene.anatomy.support = SupportDefinition{organ.neck - Vec3(0, 0, 0.5e-3), Vec3::UnitZ()};
  scene.instruments.push_back({"left", InstrumentType::atraumatic_grasper, "right_subcostal", 8.0});
  scene.laparoscope.look_at = "ball.fundus";
  return scene;
}

World make_world(const SceneDefinition& scene) {
  Result<World> world = World::create(scene);
  if (!world) {
    ADD_FAILURE() << to_text(world.failure());
    std::abort();
  }
  return std::move(world).value();
}

const SceneMesh* mesh_of(const Scene& scene, Material material) {
  for (const SceneMesh& mesh : scene.meshes)
    if (mesh.material == material) return &mesh;
  return nullptr;
}

TEST(BuildScene, DrawsTheSkinThatTheWorldTouches) {
  const World world = make_world(sphere_scene());
  const Scene scene = build_scene(world);
  const SceneMesh* skin = mesh_of(scene, Material::membrane);
  ASSERT_NE(skin, nullptr);
  EXPECT_EQ(skin->triangles, world.skin(OrganIndex(0)).triangles);
  EXPECT_EQ(skin->positions, world.skin_positions(OrganIndex(0)));
  EXPECT_EQ(skin->normals, world.skin_normals(OrganIndex(0)));
  const Pose frame = organ_frame(world.scene().anatomy.organs[0]);
  for (std::size_t i = 0; i < skin->rest_positions.size(); i += 97)
    EXPECT_LT((frame * skin->rest_positions[i] - world.drawn_rest(OrganIndex(0))[i]).norm(),
              1e-14);  // rounding
  EXPECT_NE(skin->vessels, nullptr);
}

SceneDefinition with_duct() {
  SceneDefinition definition = sphere_scene();
  OrganDefinition duct;
  duct.name = "duct";
  duct.shape = TubeShape{.points = {Vec3(0, 0.1, -0.08), Vec3(0.04, 0.1, -0.08)}};
  duct.held = {{"first", "start", 5e-3, 1e6}, {"second", "end", 5e-3, 1e6}};
  definition.anatomy.organs.push_back(duct);
  return definition;
}

TEST(BuildScene, DrawsPiecesAndNotWhatIsGone) {
  World world = make_world(with_duct());
  const SceneBuilder builder(world);
  const std::size_t before = builder.build(world).meshes.size();
  const auto drawn = [&](OrganIndex organ) {
    const Scene scene = builder.build(world);
    const std::vector<Vec3> places = world.drawn(organ).positions;
    return std::count_if(scene.meshes.begin(), scene.meshes.end(), [&](const SceneMesh& mesh) {
      return mesh.positions == places && mesh.triangles == world.drawn_triangles(organ) &&
             mesh.rest_positions.size() == places.size();
    });
  };
  ASSERT_TRUE(world.divide("duct", 0.5));
  EXPECT_EQ(builder.build(world).meshes.size(), before + 1);
  for (int organ : {0, 1, 2}) EXPECT_EQ(drawn(OrganIndex(organ)), 1) << organ;
  ASSERT_TRUE(world.remove("duct.specimen", ""));
  ASSERT_TRUE(world.remove("ball", ""));
  EXPECT_EQ(builder.build(world).meshes.size(), before - 1);
  EXPECT_EQ(drawn(OrganIndex(0)), 1);
  // The laparoscope still looks where the ball was, also one that is set up now.
  EXPECT_EQ(build_scene(world).meshes.size(), before - 1);
}

TEST(BuildScene, CoarseSkinsStayWithTheirTissueAndPiecesThatCameLaterAreDrawnWhole) {
  World world = make_world(with_duct());
  const SceneBuilder builder(world, SceneDetail::coarse);
  ASSERT_TRUE(world.divide("duct", 0.5));
  const Scene scene = builder.build(world);
  const SceneMesh* ball = mesh_of(scene, Material::membrane);
  ASSERT_NE(ball, nullptr);
  const std::vector<Vec3> skin = world.skin_positions(OrganIndex(0));
  EXPECT_LT(ball->positions.size(), skin.size() / 2);
  for (const Vec3& p : ball->positions) EXPECT_NE(std::find(skin.begin(), skin.end(), p), skin.end());
  ASSERT_EQ(ball->rest_positions.size(), ball->positions.size());
  for (const OrganIndex piece : {OrganIndex(1), OrganIndex(2)})
    EXPECT_TRUE(std::any_of(scene.meshes.begin(), scene.meshes.end(), [&](const SceneMesh& mesh) {
      return mesh.positions == world.drawn(piece).positions;
    })) << piece.value;
}

TEST(BuildScene, ASupportedOrganHasADrapeAndNoLiver) {
  const Scene scene = build_scene(make_world(sphere_scene()));
  EXPECT_EQ(mesh_of(scene, Material::liver), nullptr);
  EXPECT_NE(mesh_of(scene, Material::peritoneum), nullptr);
  EXPECT_NE(mesh_of(scene, Material::steel), nullptr);
}

TEST(BuildScene, AHydropsIsPale) {
  SceneDefinition scene = sphere_scene();
  scene.anatomy.organs[0].looks = OrganLooks::pale;
  const Scene drawn = build_scene(make_world(scene));
  EXPECT_NE(mesh_of(drawn, Material::hydrops), nullptr);
  EXPECT_EQ(mesh_of(drawn, Material::membrane), nullptr);
}

TEST(BuildScene, ThePictureFollowsTheInstrumentAndTheCameraHoldsStill) {
  World world = make_world(sphere_scene());
  const SceneBuilder builder(world);
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(200, 160);
  ASSERT_TRUE(renderer);
  const Scene before = builder.build(world);
  const Result<Image> first = renderer->render(before);
  StepInput input;
  input.instruments.push_back(world.report().instruments[0].pose);
  input.instruments[0].yaw += 0.01;
  ASSERT_TRUE(world.step(input));
  const Scene after = builder.build(world);
  const Result<Image> second = renderer->render(after);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(before.camera.position, after.camera.position);
  EXPECT_EQ(before.camera.direction, after.camera.direction);
  EXPECT_FALSE(compare(first.value(), second.value())->within);
}

/// The tool straight down into the ball's top, `depth` (m) below where it was at rest.
void press(World& world, double depth) {
  const Vec3 top = sphere_scene().anatomy.organs[0].fundus;
  StepInput input;
  input.instruments = {pose_reaching(world.port_position("right_subcostal"), top - Vec3(0, 0, depth), 0, 0)};
  const Result<StepReport> step = world.step(input);
  ASSERT_TRUE(step) << to_text(step.failure());
}

TEST(BuildScene, LookingDoesNotTouchTheWorld) {
  // Beside a world that nobody looks at, where the skin is touched and so remembers friction and contacts.
  World seen = make_world(sphere_scene()), unseen = make_world(sphere_scene());
  for (double depth : {-5e-3, 1e-3, 2e-3, 3e-3}) {
    press(seen, depth);
    press(unseen, depth);
    const Scene a = build_scene(seen), b = build_scene(seen);
    EXPECT_EQ(seen.state_hash(), unseen.state_hash());
    EXPECT_EQ(seen.skin_positions(OrganIndex(0)), unseen.skin_positions(OrganIndex(0)));
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions);
  }
  EXPECT_TRUE(seen.report().instruments[0].touching);
}

}  // namespace
}  // namespace calot
