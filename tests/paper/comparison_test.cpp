// Structural extensions against uniform meshes: what the comparison promises of its errors, not of its times.

#include "paper/comparison.h"
#include "support/long_run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace calot {
namespace {

ComparisonCase small(int uniform_levels, int extension_levels, bool paper) {
  ComparisonCase out;
  out.loads = standard_loads(6e-3);
  out.loads.resize(1);
  out.rates = {50};
  out.uniform_levels = uniform_levels;
  out.extension_levels = extension_levels;
  out.cycles = 1;
  out.patience = 0;
  out.paper = paper;
  return out;
}

Comparison compared(const ComparisonCase& given) {
  const Result<Comparison> made = compare(given, [](const std::string&) {});
  EXPECT_TRUE(made) << to_text(made.failure());
  return made ? made.value() : Comparison{};
}

/// By any solver: the errors do not depend on it.
ComparisonRow row_of(const Comparison& all, const std::string& formulation, int nodes) {
  for (const ComparisonRow& row : all.rows)
    if (row.formulation == formulation && row.nodes == nodes) return row;
  ADD_FAILURE() << formulation << " " << nodes;
  return {};
}

/// Both formulations, played once.
const Comparison& both() {
  static const Comparison all = compared(small(2, 1, true));
  return all;
}

TEST(Comparison, ErrorsFallWithTheNodesAndExtensionsKeepTheTargets) {
  CALOT_SLOW_WHEN_SANITIZED("whole comparisons");
  const Comparison& all = both();
  for (const ComparisonRow& row : all.rows) EXPECT_EQ(row.status, "converged") << row.nodes << row.solver;
  const ComparisonRow coarse = row_of(all, "shell", 61), fine = row_of(all, "shell", 238),
                      finest = row_of(all, "shell", 946), extended = row_of(all, "shell", 61 + 36);
  EXPECT_EQ(finest.max_error_pct, 0);
  // Halving the edges: first order at least.
  EXPECT_LT(fine.mean_error_pct, 0.5 * coarse.mean_error_pct);
  EXPECT_LT(fine.contact_error_pct, 0.5 * coarse.contact_error_pct);
  EXPECT_LT(fine.max_error_pct, 0.5 * coarse.max_error_pct);
  EXPECT_GT(extended.mean_error_pct, 0);
  EXPECT_LT(extended.mean_error_pct, 2);
  EXPECT_LT(extended.contact_error_pct, 3);
  EXPECT_LT(extended.max_error_pct, 5);
  EXPECT_EQ(extended.uniform_nodes, 238);
  EXPECT_EQ(extended.extensions, 3);
  // The springs' ends go 6 mm and the springs are soft beside the bed.
  // The paper's two stages leave out what the extensions pass back within a step.
  ASSERT_EQ(all.staged.size(), 1U);
  EXPECT_EQ(all.staged[0].status, "converged");
  EXPECT_GT(all.staged[0].mean_apart_pct, 0);
  EXPECT_LT(all.staged[0].largest_apart_pct, extended.max_error_pct)
      << "less than what the level leaves out itself";
  ASSERT_EQ(all.largest_mm.size(), 1U);
  EXPECT_GT(all.largest_mm[0], 3);
  EXPECT_LT(all.largest_mm[0], 6);
}

TEST(Comparison, BothFormulationsComeToTheSameShape) {
  CALOT_SLOW_WHEN_SANITIZED("whole comparisons");
  const Comparison& all = both();
  ASSERT_EQ(all.formulations_apart_pct.size(), 1U);
  EXPECT_GT(all.formulations_apart_pct[0], 0);
  EXPECT_LT(all.formulations_apart_pct[0], 1);  // 946 flat triangles' nodes err by 0.3 % themselves
}

/// The row of this solver.
ComparisonRow row_by(const Comparison& all, const std::string& formulation, int nodes,
                     const std::string& solver) {
  for (const ComparisonRow& row : all.rows)
    if (row.formulation == formulation && row.nodes == nodes && row.solver == solver) return row;
  ADD_FAILURE() << formulation << " " << nodes << " " << solver;
  return {};
}

/// Of a dense Cholesky factor, and of a solve with it.
double dense_flops(int nodes) {
  const double size = 3 * nodes;
  return size * size * size / 3 + 4 * size * (size + 1) / 2;
}

TEST(Comparison, ErrorAndGainOfThePapersStarsAreOfThePapersOrder) {
  CALOT_SLOW_WHEN_SANITIZED("whole comparisons");
  const Comparison& all = both();
  const ComparisonRow coarse = row_of(all, "1997", 61), fine = row_of(all, "1997", 238),
                      finest = row_of(all, "1997", 946), star = row_of(all, "1997", 61 + 12),
                      staged = row_of(all, "1997 two stages", 61 + 12);
  EXPECT_EQ(finest.max_error_pct, 0);
  EXPECT_LT(fine.mean_error_pct, 0.5 * coarse.mean_error_pct);  // first order at least
  for (const ComparisonRow& row : {star, staged}) {
    EXPECT_EQ(row.levels, 0);
    EXPECT_EQ(row.extensions, 3);
    // The paper: "of the order of 10% of the maximum displacement".
    EXPECT_GT(row.mean_error_pct, 2);
    EXPECT_LT(row.mean_error_pct, 20);
    EXPECT_GT(row.mean_error_pct, fine.mean_error_pct);
    // What extensions are for, though it is little.
    EXPECT_LT(row.contact_error_pct, coarse.contact_error_pct);
  }
  EXPECT_LT(star.contact_error_pct, staged.contact_error_pct);
}

TEST(Comparison, EachOfTwoStagesCostsAtMostACubeOfItsOwnUnknowns) {
  CALOT_SLOW_WHEN_SANITIZED("whole comparisons");
  const Comparison& all = both();
  const ComparisonRow uniform = row_by(all, "1997", 238, "dense"),
                      whole = row_by(all, "1997", 61 + 12, "dense"),
                      staged = row_by(all, "1997 two stages", 61 + 12, "dense"),
                      finer = row_by(all, "1997 two stages", 61 + 48, "dense");
  // Factors keep to an envelope: a full one's operations are the most that they may take.
  EXPECT_LT(uniform.flops, 0.8 * dense_flops(238));
  EXPECT_LT(whole.flops, dense_flops(61 + 12));
  EXPECT_LE(staged.flops, dense_flops(61) + dense_flops(12));
  EXPECT_LT(staged.flops, whole.flops);
  EXPECT_GT(finer.flops, staged.flops);
  EXPECT_LE(finer.flops - staged.flops, dense_flops(48)) << "levels are the second stage's alone";
  EXPECT_EQ(finer.levels, 1);
  EXPECT_LT(staged.memory_bytes, 0.2 * uniform.memory_bytes);
  EXPECT_GT(staged.condition_estimate, 1);
  // The paper's gain, by its own count: nearly two orders of magnitude, 40 with the work in between.
  EXPECT_GT(uniform.flops / staged.flops, 10);
  EXPECT_LT(uniform.flops / staged.flops, 1000);
}

TEST(Comparison, IsTheSameEachTime) {
  const ComparisonCase given = small(0, 0, true);
  const Comparison a = compared(given), b = compared(given);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  ASSERT_GT(a.rows.size(), 0U);
  EXPECT_EQ(a.formulations_apart_pct, b.formulations_apart_pct);
  for (std::size_t k = 0; k < a.rows.size(); ++k) {
    EXPECT_EQ(a.rows[k].mean_error_pct, b.rows[k].mean_error_pct);
    EXPECT_EQ(a.rows[k].newton_iterations, b.rows[k].newton_iterations);
  }
}

TEST(Comparison, TheShapeDoesNotDependOnTheRateNorTheSolver) {
  CALOT_SLOW_WHEN_SANITIZED("whole comparisons");
  const ComparedSurface surface = ComparedSurface::create(20e-3, 61, 2).value();
  const ComparedLoad load = standard_loads(6e-3)[2];
  std::vector<Vec3> places;
  for (const LoadedPlace& place : load.places) places.push_back(place.direction);
  const std::unique_ptr<ComparedBody> body = extended_shell(surface, places, 2).value();
  EXPECT_EQ(body->nodes(), 61 + 3 * 24);
  EXPECT_EQ(body->coarse_nodes(), 61);
  std::vector<std::vector<Vec3>> ends;
  for (const auto& [solver, steps] : {std::pair(FactorKind::sparse, 3), std::pair(FactorKind::dense, 3),
                                      std::pair(FactorKind::condensed, 20)}) {
    ASSERT_TRUE(body->begin(load, solver).converged());
    for (int k = 1; k <= steps; ++k) ASSERT_TRUE(body->step(static_cast<double>(k) / steps).converged());
    ends.push_back(body->surface());
  }
  for (std::size_t k = 1; k < ends.size(); ++k)
    for (std::size_t i = 0; i < ends[0].size(); ++i)
      // Converged to 1e-6 of the body's 69 mm, and of forces of some newton on springs of 1000 N/m.
      EXPECT_LT((ends[k][i] - ends[0][i]).norm(), 1e-6);
}

TEST(Comparison, EveryMeshHasTheSameSurfaceAndTheSameSprings) {
  const ComparedSurface surface = ComparedSurface::create(20e-3, 61, 2).value();
  for (int level : {1, 2}) {
    const TriMesh mesh = surface.level_control(level).value();
    const StencilTable table = surface.levels.evaluate(level, surface.points, 0);
    const std::vector<Vec3> points = blend_all(table, table.value, to_coordinates(mesh.points));
    ASSERT_EQ(points.size(), surface.rest.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_LT((points[i] - surface.rest[i]).norm(), 1e-12);  // rounding of a solve
  }
  double sum = 0;
  int held = 0;
  for (double k : surface.springs(Vec3::UnitX())) {
    sum += k;
    held += k > 0;
  }
  EXPECT_NEAR(sum, contact_stiffness, 1e-9);
  EXPECT_GT(held, 10);
}

TEST(Comparison, CasesWithoutSenseAreRefused) {
  for (int k = 0; k < 5; ++k) {
    ComparisonCase given = small(1, 1, false);
    if (k == 0) given.radius = 0;
    if (k == 1) given.loads.clear();
    if (k == 2) given.rates = {0};
    if (k == 3) given.cycles = 0;
    if (k == 4) given.loads.push_back({"other", {}});
    const Result<Comparison> made = compare(given, [](const std::string&) {});
    ASSERT_FALSE(made);
    EXPECT_EQ(made.failure().kind, FailureKind::usage);
  }
}

}  // namespace
}  // namespace calot
