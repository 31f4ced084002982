#include "view/veil_mesh.h"

#include <gtest/gtest.h>

#include "sim/field_state.h"

namespace calot {
namespace {

/// A stone that hangs on a stiff duct by its tissue.
World hanging_stone() {
  SceneDefinition scene;
  OrganDefinition duct;
  duct.name = "duct";
  duct.shape =
      TubeShape{.points = {Vec3(-100e-3, 70e-3, -100e-3), Vec3(-60e-3, 70e-3, -100e-3)}, .radius = 3e-3};
  duct.wall.thickness = 3e-3, duct.wall.shear_modulus = 2e6;
  duct.held = {{"start", "start", 5e-3, 1e7}, {"end", "end", 5e-3, 1e7}};
  OrganDefinition stone;
  stone.name = "stone";
  stone.shape = RigidShape{Vec3(24e-3, 4e-3, 2e-3), 4e-3, Vec3(-80e-3, 70e-3, -110e-3), 1500};
  scene.anatomy.organs = {duct, stone};
  TissueDefinition tissue;
  tissue.from = "duct", tissue.to = "stone";
  tissue.within = 5e-3, tissue.start = 0.3, tissue.stop = 0.7;
  tissue.strands = 40, tissue.slack = 0;
  tissue.stiffness = tissue.strength = 20e3, tissue.break_energy = 200;
  scene.anatomy.tissue = {tissue};
  scene.instruments.push_back({"left", InstrumentType::atraumatic_grasper, "right_subcostal", 8.0});
  scene.solver.motion = SolverMotion::dynamics;
  scene.laparoscope.look_at = "duct.middle";
  Result<World> world = World::create(scene);
  EXPECT_TRUE(world) << to_text(world.failure());
  return std::move(world).value();
}

TEST(Veil, SpansATissueAndIsOpenWhereItIsTorn) {
  World world = hanging_stone();
  const SceneMesh veil = veil_mesh(world);
  EXPECT_EQ(veil.material, Material::veil);
  EXPECT_GT(veil.triangles.size(), 100);
  const Tissue& tissue = world.field().tissues[0];
  for (const Vec3& p : veil.positions) {
    // From skin to skin: no further from the strands' nodes than they are long, and no further out than fat is thick.
    double nearest = 1;
    for (Eigen::Index k = 0; k < tissue.now.state.x.size() / 3; ++k)
      nearest = std::min(nearest, (tissue.now.state.x.segment<3>(3 * k) - p).norm());
    EXPECT_LT(nearest, 5e-3);
  }
  FieldState state = world.state();
  for (std::size_t k = 0; k < state.group.tissues[0].opened.size() / 2; ++k)
    state.group.tissues[0].opened[k] = 100;  // a strain at which any is torn
  ASSERT_TRUE(world.restore(state));
  ASSERT_EQ(world.field().tissues[0].torn(), 20);
  EXPECT_LT(veil_mesh(world).triangles.size(), veil.triangles.size());
  for (double& opened : state.group.tissues[0].opened) opened = 100;
  ASSERT_TRUE(world.restore(state));
  EXPECT_TRUE(veil_mesh(world).triangles.empty());
}

}  // namespace
}  // namespace calot
