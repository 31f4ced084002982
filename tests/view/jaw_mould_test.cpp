#include "view/jaw_mould.h"

#include <gtest/gtest.h>

#include "field/grip.h"
#include "field/teeth.h"
#include "sim/rig.h"
#include "view/coarse_mesh.h"

namespace calot {
namespace {

/// The one tool of a world, where it stands.
Tool tool_of(const World& world) {
  Tool tool;
  tool.geometry = instrument_geometry(world.scene().instruments[0].type);
  tool.trocar = world.port_position(world.scene().instruments[0].port);
  tool.pose = world.report().instruments[0].pose;
  return tool;
}

Field tools_only(const Tool& tool) {
  Field field;
  field.tools.push_back(tool);
  return field;
}

/// Mean distance from the moulded height, m, of skin well before the pads.
double mean_misfit(const Tool& tool, const std::vector<Vec3>& touched, const std::vector<Vec3>& drawn) {
  constexpr double well_inside = 0.6e-3, reach = 0.5e-3;  // m: of the pads' edges; the contact's range
  double sum = 0;
  int count = 0;
  for (int jaw = 0; jaw < 2; ++jaw) {
    const Pose to_jaw = jaw_frame(tool.trocar, tool.pose, tool.geometry, jaw).inverse();
    for (std::size_t p = 0; p < touched.size(); ++p) {
      const Vec3 q = to_jaw * touched[p];
      const InstrumentGeometry& g = tool.geometry;
      const bool held = before_pad(q, g) && q.x() < 0 && q.x() > -reach &&
                        std::abs(q.y()) < 0.5 * g.jaw_width - well_inside &&
                        q.z() < g.jaw_length - well_inside;
      if (!held) continue;
      const Vec3 d = to_jaw * drawn[p];
      sum += std::abs(d.x() - moulded_height(g, d.y(), d.z()));
      ++count;
    }
  }
  EXPECT_GE(count, 5) << "nothing is held";
  return sum / std::max(count, 1);
}

double largest_way(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0;
  for (std::size_t p = 0; p < a.size(); ++p) largest = std::max(largest, (a[p] - b[p]).norm());
  return largest;
}

void expect_touched_skin(const JawMoulds& moulds, const World& world) {
  const DrawnSkin drawn = moulds.skin(world, OrganIndex(0));
  EXPECT_EQ(drawn.positions, world.skin_positions(OrganIndex(0)));
  EXPECT_EQ(drawn.normals, world.skin_normals(OrganIndex(0)));
}

class JawMouldGrasp : public ::testing::TestWithParam<std::string> {
 protected:
  const InstrumentType type = *instrument_type_called(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Of, JawMouldGrasp, ::testing::Values("atraumatic_grasper", "semm_forceps"),
                         [](const auto& one) { return one.param; });

TEST_P(JawMouldGrasp, MovesTheHeldWallOntoThePadsAndNothingElse) {
  test::FundusPath path(test::with_strong_jaws(test::scene_with(type)));
  JawMoulds moulds(path.world);
  expect_touched_skin(moulds, path.world);
  path.driver.watch = [&](const StepReport&) { moulds.follow(path.world); };
  ASSERT_TRUE(path.grasp() && path.driver.stay(12)) << path.driver.why();
  const std::vector<Vec3> touched = path.world.skin_positions(OrganIndex(0));
  const DrawnSkin drawn = moulds.skin(path.world, OrganIndex(0));
  const Tool tool = tool_of(path.world);
  // Not all the way: towards the pads' edges the mould fades, and its functions are as wide as a fold at the tip.
  EXPECT_LT(mean_misfit(tool, touched, drawn.positions), 0.8 * mean_misfit(tool, touched, touched));
  // No point goes further than the contact's range and the bulge together; far from the jaws none goes at all.
  EXPECT_LT(largest_way(drawn.positions, touched), 0.5e-3 + window_bulge + pad_clearance);
  EXPECT_GT(largest_way(drawn.positions, touched), 0.1e-3);
  const Vec3 tip = path.world.report().instruments[0].tip;
  const double far = 2 * tool.geometry.jaw_length;
  for (std::size_t p = 0; p < touched.size(); ++p) {
    EXPECT_NEAR(drawn.normals[p].norm(), 1, 1e-12);
    const bool away = (touched[p] - tip).norm() > far;
    EXPECT_TRUE(!away || drawn.positions[p] == touched[p]);
  }
}

TEST_P(JawMouldGrasp, ASkinOfFewerPointsIsMouldedAndKeepsOutOfTheInstrumentToo) {
  test::FundusPath path(test::with_strong_jaws(test::scene_with(type)));
  JawMoulds moulds(path.world);
  path.driver.watch = [&](const StepReport&) { moulds.follow(path.world); };
  ASSERT_TRUE(path.grasp() && path.driver.stay(12)) << path.driver.why();
  SceneMesh fine;
  fine.rest_positions = path.world.drawn_rest(OrganIndex(0));
  fine.triangles = path.world.drawn_triangles(OrganIndex(0));
  const CoarseMesh coarse = coarser(fine, 1, 0.25);
  const DrawnSkin drawn = moulds.skin(path.world, OrganIndex(0), coarse.kept, coarse.mesh.triangles);
  const std::vector<Vec3> touched = entries(path.world.skin_positions(OrganIndex(0)), coarse.kept);
  ASSERT_EQ(drawn.positions.size(), touched.size());
  EXPECT_LT(touched.size(), fine.rest_positions.size() / 3);
  EXPECT_GT(largest_way(drawn.positions, touched), 0.1e-3);
  EXPECT_LT(largest_way(drawn.positions, touched), 0.5e-3 + window_bulge + pad_clearance);
  const Solids solids(tools_only(tool_of(path.world)));
  for (std::size_t p = 0; p < touched.size(); ++p) {
    EXPECT_NEAR(drawn.normals[p].norm(), 1, 1e-12);
    if (drawn.positions[p] == touched[p]) continue;
    EXPECT_GE(solids.distance(drawn.positions[p]),
              std::min(pad_clearance, solids.distance(touched[p])) - 2e-9);
  }
}

TEST_P(JawMouldGrasp, KeepsOutOfTheInstrumentComesAndGoesWithoutAJumpAndLeavesNothingBehind) {
  test::FundusPath path(test::scene_with(type));
  JawMoulds moulds(path.world), told_twice(path.world);
  std::vector<Vec3> before = path.world.skin_positions(OrganIndex(0)), drawn_before = before;
  path.driver.watch = [&](const StepReport&) {
    moulds.follow(path.world);
    const std::vector<Vec3> touched = path.world.skin_positions(OrganIndex(0));
    const std::vector<Vec3> drawn = moulds.skin(path.world, OrganIndex(0)).positions;
    for (int k = 0; k < 2; ++k) told_twice.follow(path.world);
    ASSERT_EQ(told_twice.skin(path.world, OrganIndex(0)).positions, drawn);
    const Solids solids(tools_only(tool_of(path.world)));
    for (std::size_t p = 0; p < drawn.size(); ++p) {
      if (drawn[p] == touched[p]) continue;
      ASSERT_GE(solids.distance(drawn[p]), std::min(pad_clearance, solids.distance(touched[p])) - 2e-9);
    }
    for (const Triangle& t :
         path.world.skin(OrganIndex(0)).triangles)  // as the touched skin itself, between its points
      ASSERT_GT(solids.distance((drawn[t[0]] + drawn[t[1]] + drawn[t[2]]) / 3), -0.2e-3);
    // Ten steps of easing, the fastest of which does 15% of at most 0.83 mm; the rest is the tissue's own motion.
    EXPECT_LT(largest_way(drawn, drawn_before), largest_way(touched, before) + 0.15 * 0.83e-3);
    before = touched;
    drawn_before = drawn;
  };
  ASSERT_TRUE(path.grasp() && path.driver.stay(12) && path.lift() && path.release() && path.withdraw())
      << path.driver.why();
  EXPECT_EQ(path.driver.count(EventKind::release), 1);
  ASSERT_TRUE(path.driver.stay(10)) << path.driver.why();
  expect_touched_skin(moulds, path.world);
}

TEST(JawMould, AFlatPadIsFlatAndAWindowLetsTheWallThroughInItsMiddleOnly) {
  const InstrumentGeometry semm = instrument_geometry(InstrumentType::semm_forceps), grasper;
  const JawWindow window = jaw_window(grasper).value();
  EXPECT_FALSE(jaw_window(semm));
  double highest = -1;
  for (double z = 0; z < 20e-3; z += 0.1e-3)
    for (double y = -2.5e-3; y < 2.5e-3; y += 0.1e-3) {
      EXPECT_EQ(moulded_height(semm, y, z), -pad_clearance);
      const double height = moulded_height(grasper, y, z);
      highest = std::max(highest, height);
      const bool in_window = z > window.start && z < window.end && std::abs(y) < window.start_half;
      EXPECT_TRUE(in_window || height == -pad_clearance) << y << ", " << z;
      // No step: from one place to the next, 0.1 mm on, it rises by less than the steepest smooth step's slope.
      EXPECT_LT(std::abs(moulded_height(grasper, y + 0.1e-3, z) - height),
                1.5 * window_bulge * 0.1 / (0.7 * 0.75));
    }
  EXPECT_NEAR(highest, window_bulge - pad_clearance, 1e-6);
}

TEST(JawMould, SolidsAreTheShapesThatTouchLessTheJawsWindows) {
  Tool tool;
  tool.trocar = Vec3(-80e-3, 70e-3, -5e-3);
  tool.pose = {0.2, -0.1, 0.12, 0.4, 0.3};
  const Field field = tools_only(tool);
  const Solids solids(field);
  const JawWindow window = jaw_window(tool.geometry).value();
  const Pose jaw = jaw_frame(tool.trocar, tool.pose, tool.geometry, 0);
  const double middle = 0.5 * (window.start + window.end), half = 0.5 * (window.start_half + window.end_half);
  EXPECT_NEAR(solids.distance(jaw * Vec3(1e-3, 0, middle)), half, 1e-12);
  EXPECT_LT(solids.distance(jaw * Vec3(1e-3, 1.5e-3, middle)), -0.5e-3);
  EXPECT_LT(solids.distance(jaw * Vec3(1e-3, 0, window.end + 1e-3)), -0.5e-3);
  const Vec3 beside = jaw * Vec3(-0.2e-3, 1.5e-3, middle);
  EXPECT_NEAR(solids.distance(beside), 0.2e-3, 1e-12);
}

}  // namespace
}  // namespace calot
