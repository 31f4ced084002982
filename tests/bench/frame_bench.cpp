// The picture of the standard field, the scene that it is drawn of, and the way from a scene to its first frame.

#include <benchmark/benchmark.h>

#include "render/offscreen.h"
#include "view/build_scene.h"

namespace calot::frame_bench {
namespace {

SceneDefinition standard() {
  SceneDefinition scene;
  scene.anatomy = named_anatomy("standard").value();
  InstrumentDefinition left;
  left.name = "left";
  left.port = "right_subcostal";
  scene.instruments = {left};
  return scene;
}

void frame(benchmark::State& state, const DrawQuality& quality, SceneDetail detail) {
  const World world = World::create(standard()).value();
  SceneBuilder builder(world, detail);
  OffscreenRenderer renderer = OffscreenRenderer::create(960, 540, quality).value();
  for (auto _ : state)
    if (!renderer.render(builder.build(world))) return state.SkipWithError("no picture");
}
BENCHMARK_CAPTURE(frame, golden, golden_quality, SceneDetail::full)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(frame, live_full, live_quality, SceneDetail::full)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(frame, live, live_quality, SceneDetail::coarse)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

/// The part of a picture that the simulation's thread does: what it sees, as plain data.
void scene(benchmark::State& state, SceneDetail detail) {
  const World world = World::create(standard()).value();
  const SceneBuilder builder(world, detail);
  for (auto _ : state) benchmark::DoNotOptimize(builder.build(world));
}
BENCHMARK_CAPTURE(scene, full, SceneDetail::full)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scene, coarse, SceneDetail::coarse)->Unit(benchmark::kMillisecond);

void start_to_first_frame(benchmark::State& state) {
  for (auto _ : state) {
    const World world = World::create(standard()).value();
    OffscreenRenderer renderer = OffscreenRenderer::create().value();
    if (!renderer.render(SceneBuilder(world).build(world))) return state.SkipWithError("no picture");
  }
}
BENCHMARK(start_to_first_frame)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace calot::frame_bench
