#include "joins/met_skin.h"

#include <map>
#include <numeric>
#include <set>

#include "body/loop_skin.h"
#include "group_rig.h"
#include "skin/tessellate.h"

namespace calot {
namespace {

/// Each edge of a closed or open surface, in the way that its triangles turn, so often as they do.
std::map<std::array<int, 2>, int> turned_edges(const std::vector<Triangle>& triangles) {
  std::map<std::array<int, 2>, int> out;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) ++out[{t[k], t[(k + 1) % 3]}];
  return out;
}

TEST(MetSkin, JoinedTrianglesAreTheGridsOfTheirFaces) {
  // Two faces of a square: where a point of the grid lies is where it was asked for.
  const std::vector<Triangle> faces{{0, 1, 2}, {2, 1, 3}};
  const std::array<Vec3, 4> corners{Vec3{0, 0, 0}, Vec3{12, 0, 0}, Vec3{0, 12, 0}, Vec3{12, 12, 0}};
  for (const int step : {2, 3, 6}) {
    const Tessellation split = split_faces(4, faces, 6);
    const auto place = [&](int point) {
      const FacePoint& at = split.at[point];
      const Triangle& f = faces[at.face];
      return Vec3((1 - at.u - at.v) * corners[f[0]] + at.u * corners[f[1]] + at.v * corners[f[2]]);
    };
    const std::vector<Triangle> joined = joined_triangles(split.triangles, 6, step);
    ASSERT_EQ(joined.size(), split.triangles.size() / static_cast<std::size_t>(step * step));
    for (const Triangle& t : joined) {
      const Vec3 twice_area = (place(t[1]) - place(t[0])).cross(place(t[2]) - place(t[0]));
      EXPECT_NEAR(twice_area.z(), 4.0 * step * step, 1e-12) << step;  // of the same size and turned alike
    }
    for (const auto& [edge, times] : turned_edges(joined)) EXPECT_EQ(times, 1) << edge[0] << " " << edge[1];
  }
}

TEST(MetSkin, ABallIsMetByAClosedSurfaceOfAQuarterOfItsPoints) {
  const BodyPointer ball = test::soft_ball(Vec3::Zero());
  const MetSkin met = met_skin(*ball);
  ASSERT_GT(ball->skin_parts(), 1);
  std::set<int> points;
  for (const Triangle& t : met.triangles) points.insert(t.begin(), t.end());
  EXPECT_LT(points.size(), ball->skin_rest().size() / 3);
  EXPECT_LE(widest_gap(ball->skin_rest(), met.triangles), met_spacing);
  EXPECT_EQ(met.each * ball->face_nodes().size(), met.triangles.size());
  const std::map<std::array<int, 2>, int> edges = turned_edges(met.triangles);
  for (const auto& [edge, times] : edges) EXPECT_EQ(edges.count({edge[1], edge[0]}), 1u);
  // Flat triangles 2 mm wide on a ball of 20 mm leave out (2 / 20)^2 / 24 of its area and less.
  const auto sum = [](const std::vector<double>& areas) {
    return std::accumulate(areas.begin(), areas.end(), 0.0);
  };
  EXPECT_NEAR(sum(met.areas) / sum(ball->skin_areas()), 1, 0.1 * 0.1 / 24 * 4);
  EXPECT_LT(sum(met.areas), sum(ball->skin_areas()));
  for (std::size_t p = 0; p < met.areas.size(); ++p)
    EXPECT_EQ(met.areas[p] > 0, points.contains(static_cast<int>(p)));
}

}  // namespace
}  // namespace calot
