#include <gmock/gmock.h>

#include "skin/meshes.h"
#include "skin/subdivision.h"

namespace calot::test {
namespace {

TriMesh limit_mesh(const TriMesh& control, int parts) {
  const Tessellation t = LoopSurface::create(control).value().tessellate(parts);
  return {blend_all(t.stencils, t.stencils.value, to_coordinates(control.points)), t.triangles};
}

TEST(Tessellation, OfAClosedSurfaceIsClosedAndTouchesItselfNowhere) {
  for (const auto& [name, mesh] : closed_meshes())
    for (int parts : {1, 2, 3, 4, 8}) {
      const std::vector<Problem> problems = check(limit_mesh(mesh, parts));
      EXPECT_TRUE(problems.empty()) << name << " in " << parts << ": " << to_text(problems.front());
    }
}

TEST(Tessellation, OfASheetKeepsItsBoundary) {
  const TriMesh mesh = limit_mesh(sheet(), 8);
  EXPECT_THAT(check(mesh, {.closed = false}), ::testing::IsEmpty());
  EXPECT_EQ(mesh.points.size(), (4 * 8 + 1) * (3 * 8 + 1));
}

TEST(Tessellation, CountsAreThoseOfSplittingEveryEdgeInParts) {
  const TriMesh mesh = octahedron();  // V - E + F = 2 with E = 3/2 F: V = 2 + F / 2
  const LoopSurface surface = LoopSurface::create(mesh).value();
  for (std::size_t parts : {1, 2, 3, 5, 8, 32}) {
    const Tessellation t = surface.tessellate(static_cast<int>(parts));
    EXPECT_EQ(t.triangles.size(), mesh.triangles.size() * parts * parts);
    EXPECT_EQ(t.at.size(), 2 + t.triangles.size() / 2);
    EXPECT_EQ(t.stencils.rows(), static_cast<int>(t.at.size()));
  }
}

TEST(Tessellation, OfOnePartIsTheControlConnectivity) {
  const TriMesh mesh = closed_meshes()[1].mesh;
  EXPECT_EQ(LoopSurface::create(mesh).value().tessellate(1).triangles, mesh.triangles);
}

TEST(Tessellation, PointsLieWhereTheyAreSaidToLieAndFacesAgreeOnSharedPoints) {
  const TriMesh mesh = closed_meshes()[2].mesh;
  const LoopSurface surface = LoopSurface::create(mesh).value();
  const VecX x = to_coordinates(mesh.points);
  const Tessellation t = surface.tessellate(4);
  const std::vector<Vec3> points = blend_all(t.stencils, t.stencils.value, x);
  // The sixteen triangles of a face are consecutive: each corner, evaluated on that very face, is the same
  // point.
  std::vector<FacePoint> again;
  std::vector<int> node_of;
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    const int face = static_cast<int>(i / 16);
    const Triangle& corner = mesh.triangles[face];
    for (int node : t.triangles[i]) {
      const FacePoint& at = t.at[node];
      const std::array<double, 3> part = {1 - at.u - at.v, at.u, at.v};
      FacePoint here{face, 0, 0};
      for (int k = 0; k < 3; ++k) {
        if (mesh.triangles[at.face][k] == corner[1]) here.u = part[k];
        if (mesh.triangles[at.face][k] == corner[2]) here.v = part[k];
      }
      again.push_back(here);
      node_of.push_back(node);
    }
  }
  const StencilTable rows = surface.evaluate(again, 0);
  for (int r = 0; r < rows.rows(); ++r)
    EXPECT_LT((blend(rows, rows.value, r, x) - points[node_of[r]]).norm(),
              1e-12);  // rounding of the two faces
}

TEST(Tessellation, NormalsByTheFirstDerivativesPointOutward) {
  const TriMesh mesh = revolve(sphere_profile(1), 61).value();
  const Tessellation t = LoopSurface::create(mesh).value().tessellate(4);
  const VecX x = to_coordinates(mesh.points);
  const auto du = blend_all(t.stencils, t.stencils.du, x), dv = blend_all(t.stencils, t.stencils.dv, x);
  const auto points = blend_all(t.stencils, t.stencils.value, x);
  for (std::size_t i = 0; i < points.size(); ++i)
    // Sixty-one nodes make a sphere to within a few degrees.
    EXPECT_GT(du[i].cross(dv[i]).normalized().dot(points[i].normalized()), std::cos(0.1));
}

TEST(Tessellation, ConvergesToTheVolumeOfTheLimitSurfaceWithTheSquareOfTheSpacing) {
  const TriMesh mesh = closed_meshes()[1].mesh;
  std::vector<double> volume;
  for (int parts : {2, 4, 8, 16}) volume.push_back(enclosed_volume(limit_mesh(mesh, parts)));
  const double ratio = (volume[2] - volume[1]) / (volume[3] - volume[2]);
  EXPECT_NEAR(ratio, 4, 0.4);  // second order, and the next term a tenth of the first at this spacing
}

TEST(FitToLimit, ASurfacePassesThroughEveryTarget) {
  for (const auto& [name, mesh] : closed_meshes()) {
    const LoopSurface surface = LoopSurface::create(mesh).value();
    const auto control = fit_to_limit(surface, mesh.points);
    ASSERT_TRUE(control) << to_text(control.failure());
    const StencilTable rows = surface.tessellate(1).stencils;
    const auto limit = blend_all(rows, rows.value, to_coordinates(control.value()));
    for (std::size_t i = 0; i < limit.size(); ++i)
      EXPECT_LT((limit[i] - mesh.points[i]).norm(), 1e-13) << name;
  }
}

TEST(FitToLimit, AFittedSphereHoldsTheSpheresVolumeBetterWithEachRefinement) {
  const auto error = [](int nodes) {
    TriMesh mesh = revolve(sphere_profile(1), nodes).value();
    mesh.points = fit_to_limit(LoopSurface::create(mesh).value(), mesh.points).value();
    const Tessellation t = LoopSurface::create(mesh).value().tessellate(16);
    const TriMesh skin{blend_all(t.stencils, t.stencils.value, to_coordinates(mesh.points)), t.triangles};
    const double exact = 4 * std::numbers::pi / 3;
    return std::abs(enclosed_volume(skin) / exact - 1);
  };
  const double coarse = error(61), fine = error(238);
  EXPECT_LT(coarse, 5e-3);
  EXPECT_LT(fine, coarse / 4);  // at least second order: twice the nodes along an edge
}

TEST(FitToLimit, TargetsThatAreNotFiniteOrTooFewAreRefused) {
  const TriMesh mesh = octahedron();
  const LoopSurface surface = LoopSurface::create(mesh).value();
  EXPECT_FALSE(fit_to_limit(surface, std::span(mesh.points).first(5)));
  std::vector<Vec3> targets = mesh.points;
  targets[3].y() = NAN;
  EXPECT_FALSE(fit_to_limit(surface, targets));
}

}  // namespace
}  // namespace calot::test
