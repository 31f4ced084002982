#include "geometry/star_split.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/rng.h"
#include "geometry/shapes.h"

namespace calot {
namespace {

TriMesh sphere() { return revolve(sphere_profile(20e-3), 61).value(); }

double area(const TriMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += 0.5 * (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]).norm();
  return sum;
}

std::string problems(const TriMesh& mesh) {
  std::string text;
  for (const Problem& problem : check(mesh)) text += to_text(problem) + "\n";
  return text;
}

int shared_corners(const Triangle& a, const Triangle& b) {
  int count = 0;
  for (int node : a) count += static_cast<int>(std::count(b.begin(), b.end(), node));
  return count;
}

/// A face of the mesh that shares so many corners with face 0.
int neighbour(const TriMesh& mesh, int corners) {
  for (int f = 1; f < static_cast<int>(mesh.triangles.size()); ++f)
    if (shared_corners(mesh.triangles[0], mesh.triangles[f]) == corners) return f;
  return -1;
}

struct Case {
  std::string name;
  std::vector<FacePoint> contacts;
};

/// Stars apart, sharing a node, an edge, a triangle; contacts near a node, near an edge and on either.
std::vector<Case> cases(const TriMesh& mesh) {
  const int by_node = neighbour(mesh, 1), by_edge = neighbour(mesh, 2);
  return {{"one", {{0, 0.3, 0.4}}},
          {"apart", {{0, 0.3, 0.4}, {40, 0.2, 0.3}, {80, 0.6, 0.2}}},
          {"sharing a node", {{0, 0.3, 0.4}, {by_node, 0.2, 0.3}}},
          {"sharing an edge", {{0, 0.3, 0.4}, {by_edge, 0.2, 0.3}}},
          {"sharing both", {{0, 0.3, 0.4}, {by_edge, 0.2, 0.3}, {by_node, 0.5, 0.3}}},
          {"at a node", {{0, 0.01, 0.02}, {by_node, 1.0, 0.0}}},
          {"at an edge", {{0, 0.5, 0.001}, {by_edge, 0.5, 0.5}}}};
}

TEST(StarSplit, EachContactAddsFourNodesAndEightTriangles) {
  const TriMesh coarse = sphere();
  ASSERT_EQ(coarse.points.size(), 61U);
  for (const Case& c : cases(coarse)) {
    const StarMesh split = star_split(coarse, c.contacts, 0).value();
    EXPECT_EQ(split.mesh.points.size(), 61 + 4 * c.contacts.size()) << c.name;
    EXPECT_EQ(split.mesh.triangles.size(), coarse.triangles.size() + 8 * c.contacts.size()) << c.name;
    EXPECT_EQ(split.coarse_nodes, 61);
    for (int i = 0; i < 61; ++i) EXPECT_EQ(split.mesh.points[i], coarse.points[i]);
  }
}

TEST(StarSplit, SurfaceStaysClosedOrientedAndWhereItWas) {
  const TriMesh coarse = sphere();
  for (const Case& c : cases(coarse)) {
    for (int levels : {0, 1, 2}) {
      const StarMesh split = star_split(coarse, c.contacts, levels).value();
      EXPECT_EQ(problems(split.mesh), "") << c.name << ", " << levels << " levels";
      EXPECT_NEAR(enclosed_volume(split.mesh), enclosed_volume(coarse), 1e-13 * enclosed_volume(coarse));
      EXPECT_NEAR(area(split.mesh), area(coarse), 1e-13 * area(coarse));
    }
  }
}

TEST(StarSplit, NewNodesAreThePapersAndTheirTrianglesLieInTheTouchedOne) {
  const TriMesh coarse = sphere();
  const StarMesh split = star_split(coarse, std::vector<FacePoint>{{7, 0.3, 0.4}, {50, 0.2, 0.5}}, 0).value();
  ASSERT_EQ(split.stars.size(), 2U);
  const auto& p = split.mesh.points;
  for (const Star& star : split.stars) {
    for (int i = 0; i < 3; ++i)
      EXPECT_LT((p[star.inner[i]] - 0.5 * (p[star.centre] + p[star.corners[i]])).norm(), 1e-17);
    EXPECT_EQ(star.heirs, star.inner);
  }
  const Star& star = split.stars[0];
  EXPECT_EQ(star.corners, coarse.triangles[7]);
  const Vec3 contact = 0.3 * p[star.corners[0]] + 0.3 * p[star.corners[1]] + 0.4 * p[star.corners[2]];
  EXPECT_LT((p[star.centre] - contact).norm(), 1e-16);
  for (int face : {7, 50}) EXPECT_EQ(std::count(split.parent.begin(), split.parent.end(), face), 9);
  for (std::size_t t = 0; t < split.parent.size(); ++t)
    EXPECT_EQ(split.extended[t], split.parent[t] == 7 || split.parent[t] == 50);
}

TEST(StarSplit, PlacesBlendTheGivenNodesToTheNewOnes) {
  const TriMesh coarse = sphere();
  const StarMesh split = star_split(coarse, std::vector<FacePoint>{{7, 0.3, 0.4}, {50, 0.2, 0.5}}, 1).value();
  const StencilTable table = linear_stencils(coarse.triangles, split.places);
  ASSERT_EQ(table.rows() + 61U, split.mesh.points.size());
  for (int r = 0; r < table.rows(); ++r) {
    const Vec3 at = blend(table, table.value, r, to_coordinates(coarse.points));
    EXPECT_LT((at - split.mesh.points[61 + r]).norm(), 1e-16);
  }
}

TEST(StarSplit, SubdivisionHalvesTheStarsEdgesAndLeavesTheCoarseOnes) {
  const TriMesh coarse = sphere();
  const std::vector<FacePoint> contacts = {{0, 0.3, 0.4}, {neighbour(coarse, 2), 0.2, 0.3}};
  // Of a star's nine triangles three have a coarse edge: 6 * 4 + 3 * 3 = 33, on 12 + 4 nodes; then
  // 30 * 4 + 3 * 3 = 129. Euler: triangles = 2 * nodes + 1 in a triangle with its edges whole.
  for (const auto& [levels, nodes, triangles] : {std::tuple(1, 16, 33), std::tuple(2, 64, 129)}) {
    const StarMesh split = star_split(coarse, contacts, levels).value();
    EXPECT_EQ(split.mesh.points.size(), 61U + 2 * nodes);
    EXPECT_EQ(split.mesh.triangles.size(), coarse.triangles.size() + 2 * (triangles - 1));
    const auto& p = split.mesh.points;
    for (const Star& star : split.stars)
      for (int i = 0; i < 3; ++i) {
        const double share = std::pow(0.5, levels + 1);
        const Vec3 spoke = p[star.centre] - p[star.corners[i]];
        EXPECT_LT((p[star.heirs[i]] - p[star.corners[i]] - share * spoke).norm(), 1e-16);
      }
  }
}

TEST(StarSplit, ACentreStandsBackFromEdgesAndNodes) {
  Rng rng(1);
  for (int trial = 0; trial < 100; ++trial) {
    const FacePoint contact{3, rng.uniform(-0.2, 1.2), rng.uniform(-0.2, 1.2)};
    const FacePoint at = stand_back(contact);
    EXPECT_EQ(at.face, 3);
    EXPECT_GE(std::min({at.u, at.v, 1 - at.u - at.v}), least_weight - 1e-15);
    const double least = std::min({contact.u, contact.v, 1 - contact.u - contact.v});
    const double moved = std::hypot(at.u - contact.u, at.v - contact.v);
    EXPECT_EQ(moved < 1e-14, least >= least_weight) << contact.u << " " << contact.v;
  }
  // So no triangle of a star is a line: heights are at least least_weight / 2 of the touched triangle's.
  const TriMesh coarse = sphere();
  for (const FacePoint& contact : {FacePoint{0, 0, 0}, FacePoint{0, 0.5, 0}, FacePoint{0, 0.01, 0.98}}) {
    const StarMesh split = star_split(coarse, std::vector<FacePoint>{contact}, 0).value();
    double least = 1;
    for (std::size_t t = 0; t < split.parent.size(); ++t) {
      if (!split.extended[t]) continue;
      const TriMesh one{split.mesh.points, {split.mesh.triangles[t]}};
      const TriMesh whole{coarse.points, {coarse.triangles[0]}};
      least = std::min(least, area(one) / area(whole));
    }
    EXPECT_GE(least, 0.25 * least_weight - 1e-12);
  }
}

TEST(StarSplit, BadContactsAreRefused) {
  const TriMesh coarse = sphere();
  const int faces = static_cast<int>(coarse.triangles.size());
  for (const FacePoint& contact :
       {FacePoint{-1, 0.3, 0.3}, FacePoint{faces, 0.3, 0.3}, FacePoint{0, NAN, 0.3}})
    EXPECT_FALSE(star_split(coarse, std::vector<FacePoint>{contact}, 0));
  EXPECT_FALSE(star_split(coarse, std::vector<FacePoint>{{5, 0.3, 0.4}, {5, 0.4, 0.3}}, 0));
  EXPECT_FALSE(star_split(coarse, {}, -1));
}

TEST(StarControl, CornersGiveWayAndAllOtherNodesControlAClosedMesh) {
  const TriMesh coarse = sphere();
  for (const Case& c : cases(coarse)) {
    for (int levels : {0, 1}) {
      const StarMesh split = star_split(coarse, c.contacts, levels).value();
      std::set<int> corners;
      for (const Star& star : split.stars) corners.insert(star.corners.begin(), star.corners.end());
      const StarControl control = star_control(split);
      EXPECT_EQ(problems(control.mesh), "") << c.name << ", " << levels << " levels";
      EXPECT_EQ(control.node.size() + corners.size(), split.mesh.points.size());
      for (std::size_t i = 0; i < control.node.size(); ++i) {
        EXPECT_EQ(corners.count(control.node[i]), 0U);
        EXPECT_EQ(control.mesh.points[i], split.mesh.points[control.node[i]]);
      }
    }
  }
}

TEST(StarControl, TheInnerTrianglesOfAStarRemain) {
  const TriMesh coarse = sphere();
  for (const Case& c : cases(coarse)) {
    const StarMesh split = star_split(coarse, c.contacts, 0).value();
    const StarControl control = star_control(split);
    for (const Star& star : split.stars) {
      std::set<int> round;
      int count = 0;
      for (const Triangle& t : control.mesh.triangles) {
        const Triangle n = {control.node[t[0]], control.node[t[1]], control.node[t[2]]};
        if (std::count(n.begin(), n.end(), star.centre) == 0) continue;
        ++count;
        round.insert(n.begin(), n.end());
      }
      EXPECT_EQ(count, 3);
      EXPECT_THAT(round,
                  testing::UnorderedElementsAre(star.centre, star.inner[0], star.inner[1], star.inner[2]));
    }
  }
}

TEST(LinearStencils, ReproducePointsAndEdgeVectors) {
  const TriMesh mesh = sphere();
  const VecX x = to_coordinates(mesh.points);
  const std::vector<FacePoint> at = {{0, 0.2, 0.7}, {17, 1, 0}, {80, 0.25, 0.25}};
  const StencilTable table = linear_stencils(mesh.triangles, at);
  ASSERT_EQ(table.rows(), 3);
  for (int r = 0; r < 3; ++r) {
    const Triangle& t = mesh.triangles[at[r].face];
    const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    EXPECT_LT((blend(table, table.value, r, x) - a - at[r].u * (b - a) - at[r].v * (c - a)).norm(), 1e-16);
    EXPECT_LT((blend(table, table.du, r, x) - (b - a)).norm(), 1e-16);
    EXPECT_LT((blend(table, table.dv, r, x) - (c - a)).norm(), 1e-16);
    EXPECT_TRUE(std::is_sorted(table.node.begin() + 3 * r, table.node.begin() + 3 * r + 3));
  }
}

}  // namespace
}  // namespace calot
