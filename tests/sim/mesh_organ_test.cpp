// Organs whose shape an author brings in a file: where they lie, how large they are, where their landmarks are.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "rig.h"
#include "support/text_files.h"

namespace calot {
namespace {

constexpr double ball_radius = 20e-3;  // m

/// A ball about a place, m; written in millimetres, as most tools do.
std::string ball_file(const Vec3& middle) {
  const TriMesh ball = revolve(sphere_profile(ball_radius), 180).value();
  std::string text;
  for (const Vec3& p : ball.points) {
    const Vec3 at = 1e3 * (p + middle);
    text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", at.x(), at.y(), at.z());
  }
  for (const Triangle& t : ball.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

struct Drawn {
  Vec3 middle = Vec3::Zero();  ///< m
  double volume = 0;           ///< m^3
  std::map<std::string, Vec3> landmarks;
  double farthest = 0;  ///< m, of any landmark from the wall
};

/// A ball whose neck and fundus are the scene's, of this file, as it rests.
Drawn drawn(const std::string& text, MeshFile mesh) {
  const test::Folder folder;
  mesh.path = folder.write("organ.obj", text);
  mesh.scale = 1e-3;
  OrganDefinition organ = test::bedded_ball();
  organ.shape = mesh;
  organ.bile = {};
  organ.bile.fill_pressure = 20;  // Pa: next to nothing
  const Result<World> world = World::create(test::ball_scene(organ));
  EXPECT_TRUE(world) << to_text(world.failure());
  if (!world) return {};
  Drawn out;
  const std::vector<Vec3> skin = world->skin_positions(OrganIndex(0));
  for (const Vec3& p : skin) out.middle += p / static_cast<double>(skin.size());
  out.volume = world->report().organs[0].volume;
  for (const std::string& name : world->landmarks()) {
    const Vec3 at = world->landmark(name);
    double nearest = 1;
    for (const Vec3& p : skin) nearest = std::min(nearest, (p - at).norm());
    out.farthest = std::max(out.farthest, nearest);
    out.landmarks[name] = at;
  }
  return out;
}

TEST(MeshOrgan, LiesInItsOrgansAxesOrInTheScenesTurnedAndMoved) {
  const OrganDefinition organ = test::bedded_ball();
  const Vec3 middle = 0.5 * (organ.neck + organ.fundus);
  const double within = 1.5e-3;  // m: it hangs in its bed, and its points are not spread evenly
  // In the organ's axes the neck is the origin and the fundus lies up the z axis.
  const Vec3 in_organ(0, 0, 0.5 * (organ.fundus - organ.neck).norm());
  EXPECT_LT((drawn(ball_file(in_organ), {}).middle - middle).norm(), within);
  MeshFile in_scene;
  in_scene.axes = MeshAxes::scene;
  EXPECT_LT((drawn(ball_file(middle), in_scene).middle - middle).norm(), within);
  in_scene.offset = middle - Vec3(-0.03, 0.01, 0);
  in_scene.turn = Vec3(0, 0, 0.5 * std::numbers::pi);
  EXPECT_LT((drawn(ball_file({0.01, 0.03, 0}), in_scene).middle - middle).norm(), within)
      << "turned, then moved";
}

TEST(MeshOrgan, PassesThroughItsPointsWhereThatIsAskedFor) {
  const OrganDefinition organ = test::bedded_ball();
  MeshFile mesh;
  mesh.axes = MeshAxes::scene;
  const Vec3 middle = 0.5 * (organ.neck + organ.fundus);
  const double control = drawn(ball_file(middle), mesh).volume;
  mesh.through_points = true;
  const double through = drawn(ball_file(middle), mesh).volume;
  const double ball = 4.0 / 3 * std::numbers::pi * std::pow(ball_radius, 3);
  EXPECT_NEAR(through / ball, 1, 0.02);
  EXPECT_LT(control, 0.98 * through) << "control points lie outside of the wall";
}

TEST(MeshOrgan, HasItsLandmarksOnItsWall) {
  const OrganDefinition organ = test::bedded_ball();
  MeshFile mesh;
  mesh.axes = MeshAxes::scene;
  const Drawn there = drawn(ball_file(0.5 * (organ.neck + organ.fundus)), mesh);
  EXPECT_LT(there.farthest, 1e-6);
  const Vec3 axis = (organ.fundus - organ.neck).normalized();
  EXPECT_NEAR((there.landmarks.at("ball.fundus") - there.landmarks.at("ball.neck")).dot(axis), 2 * ball_radius,
              3e-3);
}

}  // namespace
}  // namespace calot
