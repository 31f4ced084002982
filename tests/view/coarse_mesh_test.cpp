#include "view/coarse_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "render/image_compare.h"
#include "render/offscreen.h"
#include "view/build_scene.h"
#include "view/surfaces.h"

namespace calot {
namespace {

constexpr double sheet_side = 60e-3;  // m

SceneMesh waves() {
  return sheet(Material::liver, 60, 60, [](double u, double v) {
    return Vec3(sheet_side * u, sheet_side * v, 2e-3 * std::sin(9 * u) * std::cos(7 * v));
  });
}

/// Height above a place of the plane z = 0; NaN beside the mesh.
double height_at(const SceneMesh& mesh, const Vec3& place) {
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    Eigen::Matrix2d sides;
    sides.col(0) = (b - a).head<2>();
    sides.col(1) = (c - a).head<2>();
    const Vec2 share = sides.inverse() * (place - a).head<2>();
    constexpr double rim = -1e-9;
    if (share.x() < rim || share.y() < rim || share.sum() > 1 - rim) continue;
    return a.z() + share.x() * (b - a).z() + share.y() * (c - a).z();
  }
  return std::numeric_limits<double>::quiet_NaN();
}

TEST(CoarseMesh, StaysNearTheFineSurfaceWithManyFewerTriangles) {
  const SceneMesh fine = waves();
  constexpr double error = 0.1e-3;  // m
  const CoarseMesh coarse = coarser(fine, error, 0);
  EXPECT_LT(coarse.mesh.triangles.size(), fine.triangles.size() / 4);
  double furthest = 0;
  for (const Vec3& p : fine.positions) {
    const double height = height_at(coarse.mesh, p);
    ASSERT_FALSE(std::isnan(height)) << "a hole at " << p.transpose();
    furthest = std::max(furthest, std::abs(height - p.z()));
  }
  EXPECT_LT(furthest, 4 * error) << "the library's error is a mean over the triangles that meet at a point";
  EXPECT_GT(furthest, 0.1 * error) << "nothing was left out";
}

TEST(CoarseMesh, KeepsPointsAsTheyAreAndTheShareOfTrianglesThatItMust) {
  SceneMesh fine = waves();
  for (std::size_t i = 0; i < fine.positions.size(); ++i)
    fine.burnt.push_back(1.0 / static_cast<double>(i + 1));
  const CoarseMesh coarse = coarser(fine, 1, 0.5);
  const auto triangles = static_cast<double>(fine.triangles.size());
  EXPECT_NEAR(static_cast<double>(coarse.mesh.triangles.size()), 0.5 * triangles, 0.02 * triangles);
  ASSERT_EQ(coarse.kept.size(), coarse.mesh.positions.size());
  std::set<int> once;
  for (std::size_t k = 0; k < coarse.kept.size(); ++k) {
    const auto i = static_cast<std::size_t>(coarse.kept[k]);
    EXPECT_TRUE(once.insert(coarse.kept[k]).second);
    EXPECT_EQ(coarse.mesh.positions[k], fine.positions[i]);
    EXPECT_EQ(coarse.mesh.normals[k], fine.normals[i]);
    EXPECT_EQ(coarse.mesh.rest_positions[k], fine.rest_positions[i]);
    EXPECT_EQ(coarse.mesh.burnt[k], fine.burnt[i]);
  }
}

TEST(CoarseMesh, HasNoTrianglesBackToBackBetweenWhichAPointWouldHaveNoNormal) {
  SceneMesh fine = waves();
  const std::size_t triangles = fine.triangles.size(), points = fine.positions.size();
  // A spike of two triangles, as simplifying leaves them of a thin one.
  const auto tip = static_cast<int>(points);
  fine.positions.push_back(fine.positions[0] + Vec3(0, 0, 5e-3));
  fine.rest_positions.push_back(fine.positions.back());
  fine.normals.push_back(Vec3::UnitZ());
  fine.triangles.push_back({0, 1, tip});
  fine.triangles.push_back({1, 0, tip});
  const CoarseMesh coarse = coarser(fine, 0, 1);
  EXPECT_EQ(coarse.mesh.triangles.size(), triangles);
  EXPECT_EQ(coarse.kept.size(), points);
  EXPECT_EQ(std::count(coarse.kept.begin(), coarse.kept.end(), tip), 0);
}

TEST(CoarseMesh, AFieldDrawnOfCoarseOnesIsNearlyTheSamePicture) {
  SceneDefinition definition;
  definition.anatomy = named_anatomy("standard").value();
  definition.instruments.push_back({"left", InstrumentType::atraumatic_grasper, "right_subcostal", 8.0});
  const World world = World::create(definition).value();
  const Scene fine = build_scene(world), coarse = SceneBuilder(world, SceneDetail::coarse).build(world);
  const auto points = [](const Scene& scene) {
    std::size_t sum = 0;
    for (const SceneMesh& mesh : scene.meshes) sum += mesh.positions.size();
    return sum;
  };
  EXPECT_LT(points(coarse), points(fine) / 2);
  OffscreenRenderer renderer = OffscreenRenderer::create(960, 540, live_quality).value();
  const Image one = renderer.render(fine).value(), other = renderer.render(coarse).value();
  // What had gone would be one large blob: outlines and mirrored lights move by a pixel.
  CompareTolerance plain;
  plain.small_delta = plain.large_delta = 40;
  const ImageDifference difference = compare(one, other, plain).value();
  EXPECT_LT(difference.largest_blob, 400) << difference.blob_x << ", " << difference.blob_y;
  double sum = 0;
  for (std::size_t i = 0; i < one.rgb.size(); ++i) sum += std::abs(int{one.rgb[i]} - int{other.rgb[i]});
  const double mean = sum / static_cast<double>(one.rgb.size());
  EXPECT_LT(mean, 2.0) << "of 255: outlines and mirrored lights move by a pixel";
  EXPECT_GT(mean, 0) << "nothing was left out";
}

}  // namespace
}  // namespace calot
