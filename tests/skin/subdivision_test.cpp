#include "skin/subdivision.h"

#include <gtest/gtest.h>

#include "skin/loop_reference.h"
#include "skin/meshes.h"

namespace calot::test {
namespace {

LoopSurface surface_of(const TriMesh& mesh) { return LoopSurface::create(mesh).value(); }

/// Quadrature points of the three-, one- and twelve-point rules, an edge, and points ever nearer to corner 0,
/// the last just outside the cap of 1/64.
std::vector<std::array<double, 2>> places() {
  return {{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}, {1. / 3, 1. / 3}, {0.063, 0.063},
          {0.0531, 0.310},  {0.5, 0.25},      {0.3, 0},         {0.03, 0.02},     {0.0100, 1. / 64 - 0.0099}};
}

std::vector<FacePoint> everywhere(const LoopSurface& surface) {
  std::vector<FacePoint> points;
  for (int f = 0; f < surface.faces(); ++f)
    for (const auto& [u, v] : places()) points.push_back({f, u, v});
  return points;
}

std::vector<NamedMesh> all_meshes() {
  std::vector<NamedMesh> meshes = closed_meshes();
  meshes.push_back({"sheet", sheet()});
  return meshes;
}

double row_sum(const StencilTable& table, const std::vector<double>& weights, int r) {
  double sum = 0;
  for (int e = table.begin[r]; e < table.begin[r + 1]; ++e) sum += weights[e];
  return sum;
}

TEST(LoopSurface, WeightsOfARowSumToOneAndTheirDerivativesToZero) {
  for (const auto& [name, mesh] : all_meshes()) {
    const LoopSurface surface = surface_of(mesh);
    const StencilTable rows = surface.evaluate(everywhere(surface), 2);
    for (int r = 0; r < rows.rows(); ++r) {
      // Rounding of some forty weights; derivatives near a node are larger by up to 64 and 64 squared.
      EXPECT_NEAR(row_sum(rows, rows.value, r), 1, 1e-12) << name;
      for (const auto* weights : {&rows.du, &rows.dv})
        EXPECT_NEAR(row_sum(rows, *weights, r), 0, 1e-11) << name;
      for (const auto* weights : {&rows.duu, &rows.duv, &rows.dvv})
        EXPECT_NEAR(row_sum(rows, *weights, r), 0, 1e-9) << name;
    }
  }
}

TEST(LoopSurface, RowsComeInTheOrderAskedForWithNodesIncreasing) {
  const LoopSurface surface = surface_of(closed_meshes()[2].mesh);
  std::vector<FacePoint> points = everywhere(surface), mixed;
  for (std::size_t i = 0; i < points.size(); ++i) mixed.push_back(points[i * 7919 % points.size()]);
  const StencilTable rows = surface.evaluate(mixed, 1);
  ASSERT_EQ(rows.rows(), static_cast<int>(mixed.size()));
  for (int r = 0; r < rows.rows(); r += 13) {
    const StencilTable alone = surface.evaluate(std::span(&mixed[r], 1), 1);
    const auto part = [&](const auto& all) {
      return std::vector(all.begin() + rows.begin[r], all.begin() + rows.begin[r + 1]);
    };
    EXPECT_EQ(part(rows.node), alone.node);
    EXPECT_EQ(part(rows.value), alone.value);
    EXPECT_EQ(part(rows.dv), alone.dv);
    for (std::size_t e = 1; e < alone.node.size(); ++e) EXPECT_LT(alone.node[e - 1], alone.node[e]);
  }
}

TEST(LoopSurface, GivesOnlyTheDerivativesAskedFor) {
  const LoopSurface surface = surface_of(octahedron());
  const std::vector<FacePoint> point = {{3, 0.25, 0.5}};
  const StencilTable none = surface.evaluate(point, 0), first = surface.evaluate(point, 1);
  EXPECT_TRUE(none.du.empty() && none.dv.empty());
  EXPECT_EQ(first.du.size(), first.node.size());
  EXPECT_TRUE(first.duu.empty() && first.duv.empty() && first.dvv.empty());
  EXPECT_EQ(surface.evaluate({}, 2).rows(), 0);
}

TEST(LoopSurface, CornersZeroOneTwoOfAFaceLieAtTheOriginOneZeroAndZeroOne) {
  for (const auto& [name, mesh] : all_meshes()) {
    const LoopSurface surface = surface_of(mesh);
    std::vector<FacePoint> corners;
    for (int f = 0; f < surface.faces(); ++f)
      corners.insert(corners.end(), {{f, 0, 0}, {f, 1, 0}, {f, 0, 1}});
    const StencilTable rows = surface.evaluate(corners, 0);
    for (int r = 0; r < rows.rows(); ++r) {
      // At a corner the weight of its own node is the largest by far.
      const auto largest =
          std::max_element(rows.value.begin() + rows.begin[r], rows.value.begin() + rows.begin[r + 1]);
      EXPECT_EQ(rows.node[largest - rows.value.begin()], mesh.triangles[r / 3][r % 3]) << name;
    }
  }
}

TEST(LoopSurface, PassesThroughTheLimitPointsOfLoopsMask) {
  for (const auto& [name, mesh] : closed_meshes()) {
    const StencilTable rows = surface_of(mesh).tessellate(1).stencils;
    const std::vector<Vec3> limit = blend_all(rows, rows.value, to_coordinates(mesh.points));
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      Vec3 sum = Vec3::Zero();
      int n = 0;
      for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
          if (t[k] == static_cast<int>(i)) {
            sum += mesh.points[t[(k + 1) % 3]];  // each neighbour follows the node in one triangle
            ++n;
          }
      // The fixed point of p' = (1 - n b) p + b sum and of the ring's mean q' = 3/8 p + 5/8 q.
      const double c = 3.0 / 8 + std::cos(2 * std::numbers::pi / n) / 4, b = (5.0 / 8 - c * c) / n;
      const Vec3 expected = (3.0 / 8 * mesh.points[i] + b * sum) / (3.0 / 8 + n * b);
      EXPECT_LT((limit[i] - expected).norm(), 1e-13) << name << " node " << i;
    }
  }
}

TEST(LoopSurface, AgreesWithExplicitSubdivisionInValueAndBothDerivatives) {
  for (const auto& [name, mesh] : closed_meshes()) {
    const LoopSurface surface = surface_of(mesh);
    const std::vector<FacePoint> points = everywhere(surface);
    const StencilTable rows = surface.evaluate(points, 2);
    const VecX x = to_coordinates(mesh.points);
    double value = 0, first = 0, second = 0;
    for (int r = 0; r < rows.rows(); ++r) {
      const SurfacePoint expected = reference(mesh, points[r]);
      const auto miss = [&](const std::vector<double>& weights, const Vec3& wanted) {
        return (blend(rows, weights, r, x) - wanted).norm();
      };
      value = std::max(value, miss(rows.value, expected.value));
      first = std::max({first, miss(rows.du, expected.du), miss(rows.dv, expected.dv)});
      second = std::max(
          {second, miss(rows.duu, expected.duu), miss(rows.duv, expected.duv), miss(rows.dvv, expected.dvv)});
    }
    // Both are exact: rounding of order 1e-15, times 64 and 64 squared for derivatives beside a node.
    EXPECT_LT(value, 1e-13) << name;
    EXPECT_LT(first, 1e-12) << name;
    EXPECT_LT(second, 1e-9) << name;
  }
}

TEST(LoopSurface, IsWithinAThousandthOfAnEdgeInsideTheCapOfAnExtraordinaryNode) {
  for (const auto& [name, mesh] : closed_meshes()) {
    const LoopSurface surface = surface_of(mesh);
    const std::vector<int> valence = valences(mesh);
    const VecX x = to_coordinates(mesh.points);
    for (int f = 0; f < surface.faces(); ++f) {
      const Triangle& t = mesh.triangles[f];
      if (valence[t[0]] == 6) continue;
      const double edge = (mesh.points[t[1]] - mesh.points[t[0]]).norm();
      for (double near : {0.007, 0.003, 0.001}) {
        const FacePoint at{f, near, near};
        const StencilTable row = surface.evaluate(std::span(&at, 1), 1);
        const SurfacePoint expected = reference(mesh, at);
        EXPECT_LT((blend(row, row.value, 0, x) - expected.value).norm(), 1e-3 * edge) << name;
        const Vec3 normal = blend(row, row.du, 0, x).cross(blend(row, row.dv, 0, x)).normalized();
        // The cap is 1/64 of an edge wide, and the surface turns by less than a radian an edge.
        EXPECT_GT(normal.dot(expected.du.cross(expected.dv).normalized()), std::cos(1.0 / 64)) << name;
      }
    }
  }
}

TEST(LoopSurface, DerivativesAreThoseOfTheValueByFiniteDifferences) {
  for (const auto& [name, mesh] : all_meshes()) {
    const LoopSurface surface = surface_of(mesh);
    const VecX x = to_coordinates(mesh.points);
    const double h = 1e-4;
    for (int f = 0; f < surface.faces(); ++f)
      for (const auto& [u, v] : {std::array{0.21, 0.17}, {0.36, 0.33}, {0.6, 0.23}, {0.14, 0.7}}) {
        const std::vector<FacePoint> points = {{f, u, v},        {f, u + h, v}, {f, u - h, v},
                                               {f, u, v + h},    {f, u, v - h}, {f, u + h, v + h},
                                               {f, u - h, v - h}};
        const StencilTable rows = surface.evaluate(points, 2);
        const std::vector<Vec3> p = blend_all(rows, rows.value, x);
        const auto near = [&, &where = name](const std::vector<double>& weights, const Vec3& wanted,
                                             double tolerance) {
          EXPECT_LT((blend(rows, weights, 0, x) - wanted).norm(), tolerance) << where << " face " << f;
        };
        // Central differences: truncation h^2 times fourth derivatives of a few tens, rounding 1e-15 / h^2.
        near(rows.du, (p[1] - p[2]) / (2 * h), 1e-6);
        near(rows.dv, (p[3] - p[4]) / (2 * h), 1e-6);
        near(rows.duu, (p[1] - 2 * p[0] + p[2]) / (h * h), 1e-5);
        near(rows.dvv, (p[3] - 2 * p[0] + p[4]) / (h * h), 1e-5);
        near(rows.duv, (p[5] - p[1] - p[3] + 2 * p[0] - p[2] - p[4] + p[6]) / (2 * h * h), 1e-5);
      }
  }
}

TEST(LoopSurface, ReproducesAffineMapsOfTheControlPoints) {
  const TriMesh mesh = closed_meshes()[1].mesh;
  const LoopSurface surface = surface_of(mesh);
  const StencilTable rows = surface.evaluate(everywhere(surface), 0);
  Mat3 a;
  a << 1, 2, 3, -4, 5, 6, 7, 8, -9;
  const Vec3 b(10, -20, 30);
  std::vector<Vec3> moved;
  for (const Vec3& p : mesh.points) moved.push_back(a * p + b);
  const auto before = blend_all(rows, rows.value, to_coordinates(mesh.points));
  const auto after = blend_all(rows, rows.value, to_coordinates(moved));
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT((a * before[i] + b - after[i]).norm(), 1e-12);  // rounding of coordinates of some tens
}

TEST(LoopSurface, ASheetStaysInItsPlaneAndReproducesLinearFunctionsInside) {
  const TriMesh flat = rectangle(6, 5, 6, 5);
  const LoopSurface surface = surface_of(flat);
  const StencilTable rows = surface.evaluate(everywhere(surface), 2);
  const VecX x = to_coordinates(flat.points);
  for (int r = 0; r < rows.rows(); ++r) EXPECT_EQ(blend(rows, rows.value, r, x).z(), 0);
  // Two cells from the border all stencils are regular: parameters are affine coordinates there.
  const int face = 2 * (2 * 6 + 2);
  const std::vector<FacePoint> points = {{face, 0, 0}, {face, 0.3, 0.4}, {face, 0, 1}};
  const StencilTable inner = surface.evaluate(points, 1);
  const Triangle& t = flat.triangles[face];
  const Vec3 u = flat.points[t[1]] - flat.points[t[0]], v = flat.points[t[2]] - flat.points[t[0]];
  for (int r = 0; r < 3; ++r) {
    EXPECT_LT(
        (blend(inner, inner.value, r, x) - flat.points[t[0]] - points[r].u * u - points[r].v * v).norm(),
        1e-14);
    EXPECT_LT((blend(inner, inner.du, r, x) - u).norm(), 1e-13);
    EXPECT_LT((blend(inner, inner.dv, r, x) - v).norm(), 1e-13);
  }
}

TEST(LoopSurface, TheBoundaryIsTheCubicSplineOfItsOwnNodesAndKeepsItsCorners) {
  const TriMesh mesh = sheet();  // 4 x 3 cells: nodes 0 .. 4 along the lower edge
  const LoopSurface surface = surface_of(mesh);
  const VecX x = to_coordinates(mesh.points);
  const std::vector<Vec3> limit = [&] {
    const StencilTable rows = surface.tessellate(1).stencils;
    return blend_all(rows, rows.value, x);
  }();
  for (int corner : {0, 4, 15, 19}) EXPECT_LT((limit[corner] - mesh.points[corner]).norm(), 1e-13);
  const auto& p = mesh.points;
  EXPECT_LT((limit[2] - (p[1] + 4 * p[2] + p[3]) / 6).norm(), 1e-13);
  // Face 4 has nodes 2 and 3 of the lower edge as its corners 0 and 1.
  ASSERT_EQ(mesh.triangles[4][0], 2);
  ASSERT_EQ(mesh.triangles[4][1], 3);
  for (double u : {0.1, 0.25, 0.5, 0.9}) {
    const FacePoint at{4, u, 0};
    const StencilTable row = surface.evaluate(std::span(&at, 1), 0);
    const double w = 1 - u;
    const Vec3 spline = (w * w * w * p[1] + (3 * u * u * u - 6 * u * u + 4) * p[2] +
                         (3 * w * w * w - 6 * w * w + 4) * p[3] + u * u * u * p[4]) /
                        6;
    EXPECT_LT((blend(row, row.value, 0, x) - spline).norm(), 1e-13) << u;
  }
}

}  // namespace
}  // namespace calot::test
