#include "view/surroundings.h"

#include <algorithm>

#include "anatomy/organ_frame.h"
#include "render/offscreen.h"
#include "view/build_scene.h"
#include "view/laparoscope.h"

namespace calot {
namespace {

std::vector<OrganDefinition> organs() {
  OrganDefinition standard, other;
  other.neck = Vec3(-40e-3, 140e-3, -100e-3);
  other.fundus = Vec3(-60e-3, 90e-3, -60e-3);
  other.shape = PearShape{100e-3, 40e-3, 1, 20e-3};
  return {standard, other};
}

TEST(OrganFrame, IsRightHandedFromNeckToFundusAndToTheLiver) {
  for (const OrganDefinition& organ : organs()) {
    const Pose frame = organ_frame(organ);
    EXPECT_LT((frame.linear().transpose() * frame.linear() - Mat3::Identity()).norm(), 1e-14);  // rounding
    EXPECT_NEAR(frame.linear().determinant(), 1, 1e-14);
    EXPECT_LT((frame * Vec3(0, 0, (organ.fundus - organ.neck).norm()) - organ.fundus).norm(), 1e-14);
    EXPECT_GT(frame.linear().col(0).dot(organ.liver_side), 0);
  }
}

TEST(OrganFrame, ALiverSideAlongTheAxisStillGivesAFrame) {
  OrganDefinition organ;
  organ.liver_side = organ.fundus - organ.neck;
  EXPECT_LT((organ_frame(organ).linear().transpose() * organ_frame(organ).linear() - Mat3::Identity()).norm(),
            1e-14);
}

TEST(Surroundings, TheGallbladderIsEmbeddedALittleAndItsFundusIsFree) {
  for (const OrganDefinition& organ : organs()) {
    const OrganExtent extent = organ_extent(organ);
    const Pose to_organ = organ_frame(organ).inverse();
    double margin = -1;
    int in_bed = 0;
    for (const Vec3& p : liver_mesh(organ).positions) {
      const Vec3 q = to_organ * p;
      if (std::abs(q.y()) > 6e-3) continue;
      margin = std::max(margin, q.z());
      if (q.z() < 0.4 * extent.length || q.z() > 0.65 * extent.length || q.x() > 1.5 * extent.radius)
        continue;  // the front lies beyond
      ++in_bed;    // the visceral surface passes between the organ's axis and its liver side
      EXPECT_GT(q.x(), 0.2 * extent.radius);
      EXPECT_LT(q.x(), extent.radius);
    }
    EXPECT_GT(in_bed, 3);
    EXPECT_LT(margin, 0.95 * extent.length);
    EXPECT_GT(margin, 0.5 * extent.length);
  }
}

TEST(Surroundings, EverySurfaceFacesTheWayItsTrianglesTurn) {
  SceneDefinition scene;
  scene.anatomy.organs.push_back({});
  std::vector<SceneMesh> meshes = still_meshes(scene);
  scene.anatomy.support = SupportDefinition{};
  for (const SceneMesh& mesh : still_meshes(scene)) meshes.push_back(mesh);
  GroundDefinition bar{.type = GroundType::capsule, .to = Vec3(0, 30e-3, 10e-3)};
  GroundDefinition block{.type = GroundType::box, .size = Vec3(10e-3, 20e-3, 5e-3), .radius = 2e-3};
  GroundDefinition bowel = bar;
  bowel.looks = GroundLooks::bowel;
  scene.anatomy.ground = {bar, block, bowel};
  for (const SceneMesh& mesh : still_meshes(scene)) meshes.push_back(mesh);
  for (const SceneMesh& mesh : meshes)
    for (const Triangle& t : mesh.triangles) {
      const Vec3& a = mesh.positions[t[0]];
      const Vec3 turn = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
      // Triangles that shrink to nothing at a pole turn either way by rounding: 1e-12 m^2.
      EXPECT_GT(turn.dot(mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]]), -1e-12);
    }
}

TEST(Surroundings, GroundLooksAsItsAuthorSays) {
  SceneDefinition scene;
  scene.anatomy.organs.push_back({});
  const GroundDefinition bar{.type = GroundType::capsule, .to = Vec3(0, 30e-3, 10e-3)};
  const auto looks = [&](GroundLooks wanted, GroundType type = GroundType::capsule) {
    scene.anatomy.ground = {bar};
    scene.anatomy.ground[0].looks = wanted;
    scene.anatomy.ground[0].type = type;
    return still_meshes(scene).front().material;
  };
  EXPECT_EQ(looks(GroundLooks::liver), Material::capsule);
  EXPECT_EQ(looks(GroundLooks::bowel), Material::bowel);
  EXPECT_EQ(looks(GroundLooks::fat), Material::fat);
  EXPECT_EQ(looks(GroundLooks::fat, GroundType::plane), Material::fat);
  EXPECT_EQ(looks(GroundLooks::peritoneum), Material::peritoneum);
  EXPECT_EQ(looks(GroundLooks::usual), Material::liver);
  EXPECT_EQ(looks(GroundLooks::usual, GroundType::plane), Material::peritoneum);
  scene.anatomy.organs.push_back(OrganDefinition{});
  scene.anatomy.organs.back().shape = LobeShape{};
  EXPECT_EQ(looks(GroundLooks::usual), Material::peritoneum);
}

TEST(Surroundings, BowelIsDrawnWithinWhatIsTouchedAndNearlyAsThick) {
  GroundDefinition bowel{.type = GroundType::capsule, .to = Vec3(0, 60e-3, 10e-3), .radius = 20e-3};
  const Vec3 way = bowel.to - bowel.point;
  double thinnest = 1;
  for (const Vec3& p : bowel_mesh(bowel).positions) {
    const double share = std::clamp((p - bowel.point).dot(way) / way.squaredNorm(), 0.0, 1.0);
    const double from_axis = (p - bowel.point - share * way).norm() / bowel.radius;
    EXPECT_LT(from_axis, 1 + 1e-12);  // rounding
    thinnest = std::min(thinnest, from_axis);
  }
  EXPECT_GT(thinnest, 0.88);
  EXPECT_LT(thinnest, 0.92);  // there are folds
}

int black_pixels_of_the_field(const SceneCamera& camera, const std::vector<SceneMesh>& meshes) {
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(160, 140);
  EXPECT_TRUE(renderer);
  const Result<Image> image = renderer->render({camera, meshes});
  EXPECT_TRUE(image);
  int black = 0;
  for (int y = 0; y < 140; ++y)
    for (int x = 0; x < 160; ++x) {
      const unsigned char* p = &image.value().rgb[3 * (y * 160 + x)];
      const double r = std::hypot(x + 0.5 - 80, y + 0.5 - 70) / renderer->lens().field_radius(140);
      if (r < 0.9 && p[0] + p[1] + p[2] == 0) ++black;
    }
  return black;
}

TEST(Surroundings, NoVoidIsSeenFromAnyUsualView) {
  for (const OrganDefinition& organ : organs()) {
    SceneDefinition scene;
    scene.anatomy.organs.push_back(organ);
    for (const PortDefinition& port : default_ports())
      for (const double distance : {60e-3, 90e-3}) {
        LaparoscopeDefinition scope;
        scope.distance = distance;
        if ((port.position - organ.fundus).norm() < distance + 20e-3) continue;  // no room for the scope
        const SceneCamera camera = laparoscope_camera(
            scope, {{}, laparoscope_pose(scope, port.position, organ.fundus), scope.distance});
        EXPECT_EQ(black_pixels_of_the_field(camera, still_meshes(scene)), 0) << port.name << " " << distance;
      }
  }
}

TEST(Surroundings, ASupportIsFlatUnderTheOrganAndNeverAboveItsPlane) {
  const SupportDefinition support{Vec3(0.01, 0.02, -0.08), Vec3(0.1, 0.2, 1).normalized()};
  const Vec3 about = support.point + 20e-3 * support.normal;
  const SceneMesh drape = plane_mesh(support.point, support.normal, about, Material::peritoneum);
  for (const Vec3& p : drape.positions) {
    const double height = support.normal.dot(p - support.point);
    EXPECT_LT(height, 1e-12);
    EXPECT_TRUE((p - about).norm() > 22e-3 || height > -1e-3);
  }
}

}  // namespace
}  // namespace calot
