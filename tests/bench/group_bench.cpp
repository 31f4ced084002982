// What a step costs by how many bodies are in the group: ducts in a row, each tied to the next. A blunt tip pushes the
// first one up and down.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "tools/tool.h"
#include "world/world.h"

namespace calot::group_bench {
namespace {

/// From `start` on, one behind the other, to and fro.
std::vector<OrganDefinition> ducts(int count, const Vec3& start) {
  std::vector<OrganDefinition> out;
  Vec3 from = start;
  for (int k = 0; k < count; ++k) {
    const Vec3 to = from + Vec3(10e-3, k % 2 == 0 ? 30e-3 : -30e-3, 0);
    OrganDefinition duct;
    duct.name = "duct_" + std::to_string(k);
    duct.shape = TubeShape{.points = {from, 0.5 * (from + to), to}, .radius = 2.5e-3};
    duct.wall.thickness = 0.8e-3;
    duct.wall.density = 1050;
    duct.held = {{"root", "start", 6e-3, 1e6}, {"tip", "end", 6e-3, 1e6}};
    out.push_back(duct);
    from = to;
  }
  return out;
}

World row_of_ducts(int count) {
  SceneDefinition scene;
  scene.anatomy.organs = ducts(count, {-110e-3, 90e-3, -100e-3});
  for (int k = 1; k < count; ++k)
    scene.anatomy.joints.push_back(
        {"duct_" + std::to_string(k - 1) + ".end", "duct_" + std::to_string(k) + ".start"});
  scene.laparoscope.look_at = "duct_0.middle";
  scene.solver.motion = SolverMotion::dynamics;
  InstrumentDefinition tip;
  tip.name = "tip";
  tip.port = "right_subcostal";
  tip.type = InstrumentType::bipolar_electrode;
  scene.instruments = {tip};
  return World::create(scene).value();
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// step_ms, and of it bodies_ms beside the kept system's factor and solves: medians.
void swinging_ducts(benchmark::State& state) {
  World world = row_of_ducts(static_cast<int>(state.range(0)));
  const Vec3 trocar = world.port_position("right_subcostal"), middle = world.landmark("duct_0.middle");
  const auto over = [&](double height) {
    return pose_reaching(trocar, middle + height * Vec3::UnitZ(), 0.0, 0.0);
  };
  const InstrumentPose first = world.report().instruments[0].pose;
  for (int k = 1; k <= 40; ++k)
    if (!world.step(StepInput{{interpolate(first, over(2e-3), k / 40.0)}}))
      return state.SkipWithError("no way to the duct");
  double height = 2e-3, way = -0.25e-3, iterations = 0;
  std::vector<double> step_ms, bodies_ms;
  for (auto _ : state) {
    height += way;
    if (height < -2e-3 || height > 2e-3) way = -way;
    const auto start = std::chrono::steady_clock::now();
    const Result<StepReport> report = world.step(StepInput{{over(height)}});
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    if (!report) return state.SkipWithError("a step failed");
    step_ms.push_back(taken.count());
    bodies_ms.push_back(taken.count() -
                        1e3 * (report->statistics.factorisation_s + report->statistics.solve_s));
    iterations += report->statistics.newton_iterations;
  }
  using benchmark::Counter;
  state.counters["step_ms"] = Counter(median(step_ms));
  state.counters["bodies_ms"] = Counter(median(bodies_ms));
  state.counters["iterations"] = Counter(iterations, Counter::kAvgIterations);
}
BENCHMARK(swinging_ducts)
    ->ArgName("bodies")
    ->DenseRange(1, 12)
    ->Iterations(200)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace calot::group_bench
