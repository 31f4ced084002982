#include "view/vessels.h"

#include <algorithm>
#include <limits>

#include "support/mock_organ.h"

namespace calot {
namespace {

SceneMesh pear() { return test::mock_pear(Pose::Identity(), Vec3::Zero(), Vec3::Zero()); }

std::vector<Vec3> vessel_voxels(const VesselMap& map) {
  std::vector<Vec3> centres;
  for (int z = 0; z < map.size[2]; ++z)
    for (int y = 0; y < map.size[1]; ++y)
      for (int x = 0; x < map.size[0]; ++x)
        if (map.share[(z * map.size[1] + y) * map.size[0] + x] > 0)
          centres.push_back(map.lower + map.voxel * Vec3(x + 0.5, y + 0.5, z + 0.5));
  return centres;
}

/// Sizes of the 26-connected sets of voxels that vessels fill.
std::vector<int> connected_sets(const VesselMap& map) {
  std::vector<unsigned char> left = map.share;
  std::vector<int> sizes;
  for (std::size_t start = 0; start < left.size(); ++start) {
    if (left[start] == 0) continue;
    std::vector<int> stack{static_cast<int>(start)};
    left[start] = 0;
    sizes.push_back(0);
    while (!stack.empty()) {
      const int at = stack.back();
      stack.pop_back();
      ++sizes.back();
      const int x = at % map.size[0], y = at / map.size[0] % map.size[1],
                z = at / (map.size[0] * map.size[1]);
      for (int dz = -1; dz <= 1; ++dz)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const int nx = x + dx, ny = y + dy, nz = z + dz;
            if (nx < 0 || ny < 0 || nz < 0 || nx >= map.size[0] || ny >= map.size[1] || nz >= map.size[2])
              continue;
            unsigned char& share = left[(nz * map.size[1] + ny) * map.size[0] + nx];
            if (share == 0) continue;
            share = 0;
            stack.push_back((nz * map.size[1] + ny) * map.size[0] + nx);
          }
    }
  }
  return sizes;
}

TEST(Vessels, LieOnTheSurface) {
  const SceneMesh mesh = pear();
  const auto map = grow_vessels(mesh.rest_positions, mesh.triangles);
  for (const Vec3& centre : vessel_voxels(*map)) {
    // A trunk's radius, a voxel's diagonal and the mesh's half edge.
    constexpr double reach = 0.75e-3 + 0.8e-3 + 1.2e-3;
    EXPECT_TRUE(std::any_of(mesh.rest_positions.begin(), mesh.rest_positions.end(), [&](const Vec3& p) {
      return std::abs(p.z() - centre.z()) < reach && (p - centre).norm() < reach;
    }));
  }
}

TEST(Vessels, EveryTwigComesFromOneOfTwoRoots) {
  const SceneMesh mesh = pear();
  EXPECT_LE(connected_sets(*grow_vessels(mesh.rest_positions, mesh.triangles)).size(), 2u);
}

TEST(Vessels, ReachAllPartsAndAreWidestWhereTheyEnter) {
  const SceneMesh mesh = pear();
  const auto map = grow_vessels(mesh.rest_positions, mesh.triangles);
  int low = 0, high = 0, right = 0, left = 0;
  double neck = 0, fundus = 0;
  for (const Vec3& p : vessel_voxels(*map)) {
    ++(p.z() < 40e-3 ? low : high);
    ++(p.x() > 0 ? right : left);
    (p.z() < 25e-3 ? neck : fundus) += 1;
  }
  EXPECT_GT(std::min({low, high, right, left}), 500);
  // Share of the surface covered: denser at the neck, where all that the fundus gets runs through.
  double neck_area = 0, fundus_area = 0;
  for (const Triangle& t : mesh.triangles) {
    const auto& x = mesh.rest_positions;
    const double area = 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm();
    (x[t[0]].z() < 25e-3 ? neck_area : fundus_area) += area;
  }
  EXPECT_GT(neck / neck_area, fundus / fundus_area);
}

TEST(Vessels, WidthGrowsWithWhatAVesselServes) {
  // A twig never fills a voxel, a trunk does: filled voxels lie where much runs through, few at the fundus.
  const SceneMesh mesh = pear();
  const auto map = grow_vessels(mesh.rest_positions, mesh.triangles);
  double neck = 0, neck_filled = 0, fundus = 0, fundus_filled = 0;
  const int layer = map->size[0] * map->size[1];
  for (std::size_t i = 0; i < map->share.size(); ++i) {
    if (map->share[i] == 0) continue;
    const double z = map->lower.z() + map->voxel * (static_cast<int>(i) / layer + 0.5);
    const bool filled = map->share[i] == 255;
    if (z < 25e-3) neck += 1, neck_filled += filled;
    if (z > 60e-3) fundus += 1, fundus_filled += filled;
  }
  EXPECT_GT(neck_filled / neck, 2 * fundus_filled / fundus);
  EXPECT_GT(neck_filled, 100);
}

TEST(Vessels, GrowFromTheBranchesThatAreGivenAndLieAlongThem) {
  const SceneMesh mesh = pear();
  // Beside the surface, over the pear's free side and over the liver's.
  const std::vector<VesselTrunk> trunks = {
      {{{-14e-3, 0, 12e-3}, {-20e-3, 0, 40e-3}, {-19e-3, 0, 60e-3}}, 0.6e-3},
      {{{14e-3, 0, 12e-3}, {20e-3, 0, 40e-3}, {19e-3, 0, 60e-3}}, 0.6e-3}};
  const auto map = grow_vessels(mesh.rest_positions, mesh.triangles, trunks);
  EXPECT_LE(connected_sets(*map).size(), 2u);
  // Usually all that the pear gets comes through its neck; from a branch that begins beyond it, what the neck gets.
  const auto filled_at_neck = [](const VesselMap& of) {
    const auto layers = static_cast<std::ptrdiff_t>((20e-3 - of.lower.z()) / of.voxel);
    const auto last = of.share.begin() + layers * of.size[0] * of.size[1];
    return std::count(of.share.begin(), last, 255);
  };
  const std::vector<VesselTrunk> beyond = {{{{20e-3, 0, 35e-3}, {19e-3, 0, 60e-3}}, 0.6e-3}};
  EXPECT_LT(2 * filled_at_neck(*grow_vessels(mesh.rest_positions, mesh.triangles, beyond)),
            filled_at_neck(*grow_vessels(mesh.rest_positions, mesh.triangles)));
  // Along each of its branches the wall is covered to its last half.
  for (const double side : {-1.0, 1.0})
    for (double z = 14e-3; z < 58e-3; z += 2e-3) {
      double nearest = std::numeric_limits<double>::max();
      for (const Vec3& p : vessel_voxels(*map))
        if (side * p.x() > 0 && std::abs(p.y()) < 0.4e-3) nearest = std::min(nearest, std::abs(p.z() - z));
      EXPECT_LT(nearest, map->voxel) << side << " " << z;
    }
}

TEST(Vessels, SameSurfaceSameVessels) {
  const SceneMesh mesh = pear();
  EXPECT_EQ(grow_vessels(mesh.rest_positions, mesh.triangles)->share,
            grow_vessels(mesh.rest_positions, mesh.triangles)->share);
}

TEST(Vessels, AnOrganWithoutPointsHasNone) { EXPECT_EQ(grow_vessels({}, {}), nullptr); }

}  // namespace
}  // namespace calot
