#include "view/grasper_mesh.h"

#include <algorithm>

#include "base/rng.h"
#include "collision/shapes.h"
#include "view/instrument_mesh.h"

namespace calot {
namespace {

InstrumentPose random_pose(Rng& rng) {
  return {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0.05, 0.29), rng.uniform(-3, 3),
          rng.uniform(0, 1.04)};
}

double depth_in_union(const std::vector<Shape>& shapes, const Vec3& x) {
  double nearest = signed_distance(shapes.front(), x);
  for (const Shape& shape : shapes) nearest = std::min(nearest, signed_distance(shape, x));
  return nearest;
}

TEST(GrasperMesh, NothingDrawnLiesOutsideWhatTouches) {
  Rng rng(11);
  const Vec3 trocar(-80e-3, 70e-3, -5e-3);
  for (int i = 0; i < 12; ++i) {
    InstrumentGeometry geometry;
    if (i % 3 == 1) geometry.jaw_length = 30e-3, geometry.jaw_width = 4e-3, geometry.jaw_thickness = 2.4e-3;
    if (i % 3 == 2) geometry.shaft_radius = 5e-3, geometry.jaw_width = 8e-3, geometry.jaw_rounding = 0.5e-3;
    const InstrumentPose pose = random_pose(rng);
    const std::vector<Shape> shapes = instrument_shapes(trocar, pose, geometry);
    double outermost = -1;
    for (const SceneMesh& mesh : posed(grasper_model(geometry), trocar, pose))
      for (const Vec3& p : mesh.positions) outermost = std::max(outermost, depth_in_union(shapes, p));
    EXPECT_LT(outermost, 1e-5) << "pose " << i;  // a hundredth of a millimetre: nothing an eye could see
  }
}

TEST(GrasperMesh, TheDrawnJawsReachWhereTheTouchingJawsDo) {
  // What touches is also seen: along each jaw's axes the drawn extent falls short by less than 0.3 mm.
  const InstrumentGeometry geometry;
  const InstrumentPose pose{0.2, -0.3, 0.12, 0.7, 0.6};
  const Vec3 trocar(0.01, 0.02, 0.03);
  for (int jaw = 0; jaw < 2; ++jaw) {
    const Pose from_world = jaw_frame(trocar, pose, geometry, jaw).inverse();
    Vec3 high = Vec3::Constant(-1), low = Vec3::Constant(1);
    for (const SceneMesh& mesh : posed(grasper_model(geometry), trocar, pose))
      for (const Vec3& p : mesh.positions) {
        const Vec3 q = from_world * p;
        const bool of_this_jaw = q.z() > 4e-3 && q.x() > -1e-4 && q.x() < geometry.jaw_thickness + 1e-4;
        if (of_this_jaw) high = high.cwiseMax(q), low = low.cwiseMin(q);
      }
    EXPECT_NEAR(high.z(), geometry.jaw_length, 0.3e-3);
    EXPECT_NEAR(high.x(), geometry.jaw_thickness, 0.3e-3);
    EXPECT_NEAR(low.x(), 0, 0.3e-3);
    EXPECT_NEAR(high.y() - low.y(), geometry.jaw_width, 0.6e-3);
  }
}

TEST(GrasperMesh, FacesTheWayItsTrianglesTurn) {
  // Back faces are not drawn: a normal against its triangle's turn would be a hole or a dark patch.
  for (const SceneMesh& mesh :
       posed(grasper_model(InstrumentGeometry{}), Vec3::Zero(), {0.1, 0.2, 0.1, 0.3, 0.4}))
    for (const Triangle& t : mesh.triangles) {
      const Vec3& a = mesh.positions[t[0]];
      const Vec3 turn = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
      for (const int corner : t) EXPECT_GE(turn.dot(mesh.normals[corner]), 0);
    }
}

TEST(GrasperMesh, MovesRigidlyWithTheInstrument) {
  const InstrumentGeometry geometry;
  const InstrumentPose a{0.3, 0.1, 0.1, 0.2, 0.5}, b{-0.2, 0.4, 0.2, 1.2, 0.5};
  const Vec3 trocar(0.01, -0.02, 0);
  const Pose motion = hinge_frame(trocar, b, geometry) * hinge_frame(trocar, a, geometry).inverse();
  const auto before = posed(grasper_model(geometry), trocar, a),
             after = posed(grasper_model(geometry), trocar, b);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t m = 0; m < before.size(); ++m)
    for (std::size_t i = 0; i < before[m].positions.size(); ++i)
      // rounding over 0.3 m
      EXPECT_LT((motion * before[m].positions[i] - after[m].positions[i]).norm(), 1e-12);
}

}  // namespace
}  // namespace calot
