// What 200 mm^3 of blood cost a step of 20 ms: on the ground and on a ball's skin, at rest and while they run.

#include <benchmark/benchmark.h>

#include "liquid/spill.h"
#include "organs/body_kinds.h"

namespace calot::spill_bench {
namespace {

constexpr double step = 0.02;  // s

/// A ball that is grown on 30 mm above level ground.
Field ball_over_ground() {
  OrganDefinition ball;
  ball.name = "ball";
  ball.shape = SphereShape{20e-3};
  ball.nodes = 61;
  ball.neck = {0, 0, 30e-3};
  ball.fundus = {0, 0, 70e-3};
  ball.held = {{"base", "neck", 10e-3, 1e6}};
  Field field;
  field.add(make_organ(ball, {}, Vec3::UnitZ(), 1e-6, 0).value());
  field.ground.push_back({"ground", Plane{Vec3::Zero(), Vec3::UnitZ()}, 0, false});
  field.middle = ball.neck;
  return field;
}

/// Twenty drops fall there, and what becomes of them runs for `time` s.
Field with_film(const Vec3& at, double time) {
  Field field = ball_over_ground();
  for (int k = 0; k < 20; ++k) field.spill.drops.push_back({Carries::blood, at, Vec3::Zero(), 10e-9});
  for (int k = 0; k < time / step; ++k) spill(field, step);
  return field;
}

const Vec3 over_ground{40e-3, 0, 5e-3}, over_ball{2e-3, 0, 75e-3};

/// 60 s later. `at_rest`: films of which nothing moves.
void film_at_rest(benchmark::State& state, const Vec3& at) {
  Field field = with_film(at, 60);
  for (auto _ : state) spill(field, step);
}

/// The first half second, again and again.
void film_that_runs(benchmark::State& state, const Vec3& at) {
  const Field begun = with_film(at, 0.2);
  Field field = begun;
  int steps = 0;
  for (auto _ : state) {
    if (++steps % 25 == 0) field.spill = begun.spill;
    spill(field, step);
  }
}

BENCHMARK_CAPTURE(film_at_rest, ground, over_ground)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(film_at_rest, skin, over_ball)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(film_that_runs, ground, over_ground)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(film_that_runs, skin, over_ball)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace calot::spill_bench
