#include "view/instrument_mesh.h"

#include <algorithm>
#include <array>
#include <set>

#include "base/rng.h"
#include "collision/shapes.h"

namespace calot::instrument_mesh_test {
namespace {

const Vec3 trocar(-80e-3, 70e-3, -5e-3);

InstrumentPose random_pose(Rng& rng, const InstrumentGeometry& geometry) {
  return {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0.05, 0.29), rng.uniform(-3, 3),
          rng.uniform(0, geometry.jaw_opening)};
}

class InstrumentMesh : public ::testing::TestWithParam<std::string> {
 protected:
  const InstrumentType type = *instrument_type_called(GetParam());
  const InstrumentGeometry geometry = instrument_geometry(type);
};
INSTANTIATE_TEST_SUITE_P(OfType, InstrumentMesh, ::testing::ValuesIn(instrument_type_names()),
                         [](const auto& one) { return one.param; });

TEST_P(InstrumentMesh, LiesInsideWhatTouches) {
  Rng rng(11);
  for (int i = 0; i < 8; ++i) {
    const InstrumentPose pose = random_pose(rng, geometry);
    const std::vector<Shape> shapes = instrument_shapes(trocar, pose, geometry);
    double outermost = -1;
    for (const SceneMesh& mesh : posed(instrument_model(type), trocar, pose))
      for (const Vec3& p : mesh.positions) {
        double nearest = 1;
        for (const Shape& shape : shapes) nearest = std::min(nearest, signed_distance(shape, p));
        outermost = std::max(outermost, nearest);
      }
    EXPECT_LT(outermost, 1e-5) << "pose " << i;  // a hundredth of a millimetre: nothing an eye could see
    EXPECT_GT(outermost, -0.3e-3) << "pose " << i;
  }
}

TEST_P(InstrumentMesh, ReachesItsTip) {
  const InstrumentPose pose{0.2, -0.3, 0.12, 0.7, 0};
  const Pose from_world = hinge_frame(trocar, pose, geometry).inverse();
  double end = 0;
  for (const SceneMesh& mesh : posed(instrument_model(type), trocar, pose))
    for (const Vec3& p : mesh.positions) end = std::max(end, (from_world * p).z());
  EXPECT_NEAR(end, geometry.jaw_length, 0.3e-3);
  EXPECT_NEAR((from_world * tip_position(trocar, pose, geometry)).z(), geometry.jaw_length, 1e-15);
}

TEST_P(InstrumentMesh, FacesTheWayItsTrianglesTurn) {
  // Back faces are not drawn: a normal against its triangle's turn would be a hole or a dark patch.
  const double jaw = 0.6 * geometry.jaw_opening;
  constexpr double sliver = -1e-18;  // m^2: where two rings close on a line the turn is rounding
  for (const SceneMesh& mesh : posed(instrument_model(type), Vec3::Zero(), {0.1, 0.2, 0.1, 0.3, jaw}))
    for (const Triangle& t : mesh.triangles) {
      const Vec3& a = mesh.positions[t[0]];
      const Vec3 turn = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
      for (const int corner : t) EXPECT_GE(turn.dot(mesh.normals[corner]), sliver);
    }
}

TEST_P(InstrumentMesh, SplitsPointsOnlyWhereNormalsDiffer) {
  const InstrumentModel model = instrument_model(*instrument_type_called(GetParam()));
  for (const InstrumentPart* part : {&model.shaft, &model.jaws[0], &model.jaws[1]}) {
    std::set<std::array<double, 6>> known;
    std::size_t points = 0;
    for (const SceneMesh* mesh : {&part->steel, &part->insulation}) {
      points += mesh->positions.size();
      for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
        const Vec3 &p = mesh->positions[i], &n = mesh->normals[i];
        known.insert({p.x(), p.y(), p.z(), n.x(), n.y(), n.z()});
      }
    }
    // Bodies that are turned close on themselves, and their first points lie on their last ones.
    EXPECT_GE(static_cast<double>(known.size()), 0.85 * static_cast<double>(points));
  }
}

TEST_P(InstrumentMesh, HasNoHoleButTheGraspersWindow) {
  const Pose hinge = hinge_frame(trocar, {0, 0, 0.1, 0, 0}, geometry);
  const double beyond_window = 0.92, middle = 0.6;
  const double z =
      geometry.jaw_length * (type == InstrumentType::atraumatic_grasper ? beyond_window : middle);
  const Vec3 from = hinge * Vec3(20e-3, 0, z), to = hinge * Vec3(-20e-3, 0, z);
  int met = 0;  // a line across enters and leaves at least once
  for (const SceneMesh& mesh : posed(instrument_model(type), trocar, {0, 0, 0.1, 0, 0}))
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const auto side = [&](const Vec3& p, const Vec3& q) {
        return (to - from).dot((p - from).cross(q - from));
      };
      const bool through = (side(a, b) > 0) == (side(b, c) > 0) && (side(b, c) > 0) == (side(c, a) > 0);
      met += through;
    }
  EXPECT_GE(met, 2);
}

}  // namespace
}  // namespace calot::instrument_mesh_test
