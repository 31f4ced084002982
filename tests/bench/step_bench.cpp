// Converged steps of the paper's ball (20 mm, 2 mm wall, bile), pushed by a closed grasper at 100 mm/s, and
// the parts they are made of. Counters give iterations and the shares of assembly, factorisation and solve.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "organs/body_kinds.h"
#include "tools/tool.h"
#include "world/world.h"

namespace calot::step_bench {
namespace {

OrganDefinition ball(int nodes) {
  OrganDefinition organ;
  organ.name = "ball";
  organ.shape = SphereShape{20e-3};
  organ.nodes = nodes;
  organ.neck = {-60e-3, 100e-3, -120e-3};
  organ.fundus = {-60e-3, 100e-3, -80e-3};
  organ.held = {{"base", "neck", 10e-3, 1e6}};
  return organ;
}

World pushed_world(int nodes, double rate) {
  SceneDefinition scene;
  scene.anatomy.organs = {ball(nodes)};
  scene.laparoscope.look_at = "ball.fundus";
  scene.solver.rate = rate;
  InstrumentDefinition left;
  left.name = "left";
  left.port = "right_subcostal";
  scene.instruments = {left};
  return World::create(scene).value();
}

/// The tip goes 8 mm in from the touched skin and back, again and again.
void converged_step(benchmark::State& state) {
  const double rate = static_cast<double>(state.range(1)), stride = 100e-3 / rate;
  World world = pushed_world(static_cast<int>(state.range(0)), rate);
  const Vec3 trocar = world.port_position("right_subcostal"), fundus = world.landmark("ball.fundus");
  const Vec3 in = (fundus - trocar).normalized();
  const auto at = [&](double depth) { return pose_reaching(trocar, fundus + depth * in, 0.0, 0.0); };
  const InstrumentPose first = world.report().instruments[0].pose, near = at(-1e-3);
  for (int k = 1; k <= 20; ++k)
    if (!world.step(StepInput{{interpolate(first, near, k / 20.0)}}))
      return state.SkipWithError("no way to the organ");
  double depth = 0, way = 1, iterations = 0;
  SolveStatistics sum;
  std::vector<double> times_s;
  for (auto _ : state) {
    depth += way * stride;
    if (depth > 8e-3 || depth < 0) way = -way;
    const auto start = std::chrono::steady_clock::now();
    const Result<StepReport> report = world.step(StepInput{{at(depth)}});
    times_s.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (!report) return state.SkipWithError("a step failed");
    iterations += report->statistics.newton_iterations;
    sum.assembly_s += report->statistics.assembly_s;
    sum.factorisation_s += report->statistics.factorisation_s;
    sum.solve_s += report->statistics.solve_s;
    sum.contact_s += report->statistics.contact_s;
  }
  using benchmark::Counter;
  std::nth_element(times_s.begin(), times_s.begin() + times_s.size() / 2, times_s.end());
  state.counters["median_ms"] = Counter(1e3 * times_s[times_s.size() / 2]);
  state.counters["iterations"] = Counter(iterations, Counter::kAvgIterations);
  state.counters["assembly_ms"] = Counter(1e3 * sum.assembly_s, Counter::kAvgIterations);
  state.counters["factor_ms"] = Counter(1e3 * sum.factorisation_s, Counter::kAvgIterations);
  state.counters["solve_ms"] = Counter(1e3 * sum.solve_s, Counter::kAvgIterations);
  state.counters["contact_ms"] = Counter(1e3 * sum.contact_s, Counter::kAvgIterations);
}
/// Fixed counts: the way to the organ is made once, and the finest mesh takes seconds a step.
void steps(benchmark::internal::Benchmark* bench, int nodes, int count) {
  bench->ArgNames({"nodes", "rate_hz"})->Args({nodes, 50})->Args({nodes, 1000})->Iterations(count);
  bench->Unit(benchmark::kMillisecond);
}
BENCHMARK(converged_step)->Apply([](auto* bench) { steps(bench, 61, 400); });
BENCHMARK(converged_step)->Apply([](auto* bench) { steps(bench, 238, 40); });
BENCHMARK(converged_step)->Apply([](auto* bench) { steps(bench, 946, 4); });

struct Tangent {
  RestedOrgan rested;
  ContactLoads nothing;
  explicit Tangent(int nodes) : rested(make_organ(ball(nodes), {}, Vec3::UnitZ(), 1e-6).value()) {}
  BodyProblem problem() const { return {*rested.organ.body, nothing, {}, rested.organ.state}; }
  /// The tangent where it rests.
  const BlockMatrix& hessian() {
    const BodyProblem at_rest = problem();
    at_rest.hessian(rested.organ.state.x, at_rest.multipliers(), rested.work.matrix);
    return rested.work.matrix;
  }
};

void assembly(benchmark::State& state) {
  Tangent t(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(t.hessian());
}
BENCHMARK(assembly)->ArgName("nodes")->Arg(61)->Arg(238)->Arg(946)->Unit(benchmark::kMillisecond);

/// One factorisation and solve of the same matrix, dense (1) or sparse (0): what a step is measured against.
void factor_and_solve(benchmark::State& state) {
  Tangent t(static_cast<int>(state.range(0)));
  const BlockMatrix& matrix = t.hessian();
  const FactorKind kind = state.range(1) == 1 ? FactorKind::dense : FactorKind::sparse;
  Cholesky factor(matrix, matrix.nodes(), kind);
  const VecX right = VecX::Ones(matrix.size());
  for (auto _ : state) {
    if (factor.factorise(matrix) != FactorStatus::ok) return state.SkipWithError("not definite");
    benchmark::DoNotOptimize(factor.solve(right));
  }
}
BENCHMARK(factor_and_solve)
    ->ArgNames({"nodes", "dense"})
    ->ArgsProduct({{61, 238, 946}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

void world_from_scene(benchmark::State& state) {
  SceneDefinition scene;
  scene.anatomy = named_anatomy("standard").value();
  for (auto _ : state) benchmark::DoNotOptimize(World::create(scene));
}
BENCHMARK(world_from_scene)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace calot::step_bench
