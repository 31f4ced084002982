#include "geometry/tri_mesh.h"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "geometry/shapes.h"

namespace calot::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> messages(const TriMesh& mesh, bool closed = true) {
  std::vector<std::string> result;
  for (const Problem& problem : check(mesh, {.closed = closed})) result.push_back(problem.message);
  return result;
}

/// Volume 1/6 m^3, one corner at the origin.
TriMesh tetrahedron(const Vec3& at = Vec3::Zero()) {
  return {{at, at + Vec3::UnitX(), at + Vec3::UnitY(), at + Vec3::UnitZ()},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TriMesh joined(const TriMesh& a, const TriMesh& b) {
  TriMesh both = a;
  const int n = static_cast<int>(a.points.size());
  both.points.insert(both.points.end(), b.points.begin(), b.points.end());
  for (const auto& [i, j, k] : b.triangles) both.triangles.push_back({i + n, j + n, k + n});
  return both;
}

TEST(MeshCheck, PassesASoundClosedMeshAndASoundSheet) {
  EXPECT_THAT(messages(tetrahedron()), IsEmpty());
  EXPECT_THAT(messages(split_edges(tetrahedron())), IsEmpty());
  EXPECT_THAT(messages(rectangle(1, 1, 3, 2), false), IsEmpty());
}

TEST(MeshCheck, DoesNotDependOnPlaceOrSize) {
  for (double size : {1e-6, 1.0, 1e6}) {
    TriMesh mesh = split_edges(tetrahedron());
    for (Vec3& p : mesh.points) p = size * (p + Vec3(30, -20, 10));
    EXPECT_THAT(messages(mesh), IsEmpty()) << size;
  }
}

TEST(MeshCheck, RefusesAMeshWithoutTriangles) {
  EXPECT_THAT(messages({}), ElementsAre(HasSubstr("no triangles")));
}

TEST(MeshCheck, NamesPointsThatAreNotFinite) {
  TriMesh mesh = tetrahedron();
  mesh.points[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(messages(mesh), ElementsAre(HasSubstr("not finite: point 2")));
  mesh.points[2].y() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(messages(mesh), ElementsAre(HasSubstr("not finite: point 2")));
}

TEST(MeshCheck, NamesIndicesOutOfRange) {
  for (int index : {-1, 4}) {
    TriMesh mesh = tetrahedron();
    mesh.triangles[3][2] = index;
    EXPECT_THAT(messages(mesh), ElementsAre(HasSubstr("out of range (there are 4 points): triangle 3")))
        << index;
  }
}

TEST(MeshCheck, NamesPointsThatNoTriangleUses) {
  TriMesh mesh = tetrahedron();
  mesh.points.emplace_back(5, 5, 5);
  EXPECT_THAT(messages(mesh), ElementsAre(HasSubstr("no triangle uses: point 4")));
}

TEST(MeshCheck, NamesDegenerateTriangles) {
  TriMesh line{{{0, 0, 0}, {1, 0, 0}, {2, 1e-9, 0}}, {{0, 1, 2}}};
  EXPECT_THAT(messages(line, false), ElementsAre(HasSubstr("degenerate: triangle 0 (points 0 1 2)")));
  TriMesh repeated = rectangle(1, 1, 1, 1);
  repeated.triangles.push_back({1, 1, 3});
  EXPECT_THAT(messages(repeated, false),
              ::testing::Contains(HasSubstr("degenerate: triangle 2 (points 1 1 3)")));
}

TEST(MeshCheck, NamesDuplicateTriangles) {
  TriMesh mesh = rectangle(1, 1, 1, 1);
  mesh.triangles.push_back({mesh.triangles[0][1], mesh.triangles[0][2], mesh.triangles[0][0]});
  EXPECT_THAT(messages(mesh, false),
              ::testing::Contains(HasSubstr("duplicate: triangle 2 (points 1 3 0) repeats 0")));
}

TEST(MeshCheck, NamesEdgesOfMoreThanTwoTriangles) {
  const TriMesh fins{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                     {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  EXPECT_THAT(messages(fins, false),
              ElementsAre(HasSubstr("non-manifold edge: edge 0-1 in triangles 0 1 2")));
}

TEST(MeshCheck, NamesPointsInWhichTwoFansMeet) {
  const TriMesh bow{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_THAT(messages(bow, false),
              ElementsAre(HasSubstr("non-manifold point: point 0"), HasSubstr("several pieces")));
}

TEST(MeshCheck, NamesNeighboursOfOppositeWinding) {
  TriMesh mesh = tetrahedron();
  std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
  EXPECT_THAT(messages(mesh), ElementsAre(HasSubstr("inconsistent winding: triangles 0 and 1 at edge 0-1")));
}

TEST(MeshCheck, NamesOpenEdgesUnlessABoundaryIsAllowed) {
  TriMesh mesh = tetrahedron();
  mesh.triangles.pop_back();
  EXPECT_THAT(messages(mesh),
              ElementsAre(HasSubstr("open boundary: edge 1-2 of triangle 0, edge 1-3 of triangle 1")));
  EXPECT_THAT(messages(mesh, false), IsEmpty());
}

TEST(MeshCheck, RefusesAMeshTurnedInsideOut) {
  TriMesh mesh = tetrahedron();
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_THAT(messages(mesh), ElementsAre(HasSubstr("inside out")));
}

TEST(MeshCheck, RefusesSeveralPieces) {
  EXPECT_THAT(messages(joined(tetrahedron(), tetrahedron({5, 0, 0}))),
              ElementsAre(HasSubstr("several pieces: 2")));
}

TEST(MeshCheck, NamesTrianglesThatCross) {
  const TriMesh mesh = joined(tetrahedron(), tetrahedron({0.2, 0.2, 0.2}));
  EXPECT_THAT(messages(mesh), ::testing::Contains(HasSubstr("self-touching: triangles 3 and")));
}

TEST(MeshCheck, NamesTrianglesThatTouchWithoutCrossing) {
  // A face upon a face, a corner on a face, and an edge across an edge (a rounding error away).
  const TriMesh face_on_face = joined(tetrahedron(), [] {
    TriMesh below = tetrahedron();
    for (Vec3& p : below.points) p.z() = -p.z();
    for (Triangle& t : below.triangles) std::swap(t[0], t[1]);
    return below;
  }());
  const TriMesh corner = joined(tetrahedron(), tetrahedron({0.2, 0.2, -1}));
  const TriMesh edge =
      joined(tetrahedron(), {{{0.5, 0.5 + 1e-10, -1}, {0.5, 0.5 + 1e-10, 1}, {1.5, 1, 0}, {1, 1.5, 0}},
                             {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
  for (const TriMesh& mesh : {face_on_face, corner, edge})
    EXPECT_THAT(messages(mesh), ::testing::Contains(HasSubstr("self-touching")));
}

TEST(MeshCheck, LetsSurfacesComeCloseWithoutTouching) {
  const TriMesh mesh = joined(tetrahedron(), tetrahedron({0, 0, -1 - 1e-6}));
  EXPECT_THAT(messages(mesh), ElementsAre(HasSubstr("several pieces")));
}

TEST(MeshCheck, NamesNeighboursFoldedOntoEachOther) {
  const TriMesh fold{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0.9, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_THAT(messages(fold, false), ElementsAre(HasSubstr("self-touching: triangles 0 and 1")));
  TriMesh ajar = fold;
  ajar.points[3].z() = 1e-3;
  EXPECT_THAT(messages(ajar, false), IsEmpty());
}

TEST(MeshCheck, NamesTrianglesAtOnePointThatCrossBeyondIt) {
  // Six triangles round point 0; the point between 1 and 3 is dropped through the far side of the fan.
  TriMesh fan{{{0, 0, 0}}, {}};
  for (int k = 0; k < 6; ++k) {
    const double angle = k * std::numbers::pi / 3;
    fan.points.emplace_back(std::cos(angle), std::sin(angle), 0.1 * (k % 2));
    fan.triangles.push_back({0, 1 + k, 1 + (k + 1) % 6});
  }
  EXPECT_THAT(messages(fan, false), IsEmpty());
  fan.points[1] = {-1, 0.1, 0.05};
  EXPECT_THAT(messages(fan, false), ::testing::Contains(HasSubstr("self-touching")));
}

TEST(MeshCheck, GivesEveryReasonAtOnceEachWithAHint) {
  TriMesh mesh = tetrahedron();
  mesh.triangles.pop_back();
  std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
  mesh.points.emplace_back(5, 5, 5);
  mesh.points.emplace_back(NAN, 0, 0);
  const std::vector<Problem> problems = check(mesh);
  EXPECT_EQ(problems.size(), 4u);  // not finite, unused, winding, open
  for (const Problem& problem : problems) EXPECT_FALSE(problem.hint.empty()) << problem.message;
}

TEST(MeshCheck, NamesAtMostEightOffendersOfAKind) {
  TriMesh mesh = tetrahedron();
  for (int i = 0; i < 100; ++i) mesh.points.emplace_back(i, 5, 5);
  EXPECT_THAT(messages(mesh), ElementsAre(::testing::EndsWith("point 11 and 92 more")));
}

TEST(MeshCheck, RefusesACrowdedPointBeforeAnythingElse) {
  // Two pyramids on one base of so many corners, its first face missing.
  const int corners = 41;
  TriMesh mesh;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    mesh.points.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  mesh.points.emplace_back(0, 0, -1);
  mesh.points.emplace_back(0, 0, 1);
  for (int i = 0; i < corners; ++i) {
    const int next = (i + 1) % corners;
    mesh.triangles.push_back({next, i, corners});
    if (i > 0) mesh.triangles.push_back({i, next, corners + 1});
  }
  EXPECT_THAT(messages(mesh), ElementsAre(::testing::EndsWith("at a point: point 41 with 41 triangles")));
  EXPECT_THAT(check(mesh, {.counted_from = 1}).front().message, HasSubstr("point 42"));
  EXPECT_THAT(check(mesh, {.most_edges_at_a_point = 41}).front().message, HasSubstr("open boundary"));
}

TEST(EnclosedVolume, IsThatOfATetrahedronWhereverItLies) {
  EXPECT_NEAR(enclosed_volume(tetrahedron()), 1.0 / 6, 1e-15);
  EXPECT_NEAR(enclosed_volume(tetrahedron({1e6, -1e6, 1e6})), 1.0 / 6, 1e-9);  // coordinates keep 1e-10
}

TEST(SplitEdges, KeepsPointsAreaAndOrientationAndQuartersTriangles) {
  const TriMesh mesh = tetrahedron(), fine = split_edges(mesh);
  EXPECT_EQ(fine.triangles.size(), 4 * mesh.triangles.size());
  EXPECT_EQ(fine.points.size(), 4u + 6u);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) EXPECT_EQ(fine.points[i], mesh.points[i]);
  EXPECT_NEAR(enclosed_volume(fine), enclosed_volume(mesh), 1e-15);
}

}  // namespace
}  // namespace calot::test
