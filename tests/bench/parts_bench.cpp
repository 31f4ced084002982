// The parts of a step one by one, at the paper's 61 nodes and the gallbladder's 180.

#include <benchmark/benchmark.h>

#include "sim/instrument.h"
#include "sim/organ.h"

namespace {

using namespace calot;

Organ gallbladder(int nodes) {
  OrganDefinition definition = named_anatomy("standard")->organs[0];
  definition.nodes = nodes;
  return make_organ(definition, {}, Vec3::UnitZ(), 1e-6).value();
}

void shell_hessian(benchmark::State& state) {
  Organ organ = gallbladder(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    organ.work.matrix.set_zero();
    organ.body.shell().add_hessian(organ.state.x, organ.work.matrix);
  }
}

void bile_hessian(benchmark::State& state) {
  Organ organ = gallbladder(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    organ.work.matrix.set_zero();
    organ.body.bile()->add_hessian(organ.state.x, organ.state.multiplier, organ.work.matrix);
  }
}

void energy_and_gradient(benchmark::State& state) {
  const Organ organ = gallbladder(static_cast<int>(state.range(0)));
  const Surroundings nothing;
  const BodyProblem problem(organ.body, nothing, {}, organ.state);
  VecX gradient(organ.state.x.size());
  double largest = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(problem.value(organ.state.x));
    problem.gradient(organ.state.x, gradient, largest);
  }
}

/// The search for skin points near a closed grasper whose tip touches the organ.
void contact_search(benchmark::State& state) {
  const Organ organ = gallbladder(static_cast<int>(state.range(0)));
  const Vec3 fundus = organ.body.skin_positions(organ.state.x)[organ.landmarks.at("fundus")];
  const Vec3 trocar = fundus + Vec3(20e-3, -20e-3, 100e-3);
  Surroundings field;
  field.shapes = instrument_shapes(trocar, pose_reaching(trocar, fundus, 0, 0), {});
  for (auto _ : state) benchmark::DoNotOptimize(gather_pairs(organ.body, organ.state.x, field, 2e-3));
}

void factorisation(benchmark::State& state) {
  Organ organ = gallbladder(static_cast<int>(state.range(0)));
  const Surroundings nothing;
  const BodyProblem problem(organ.body, nothing, {}, organ.state);
  problem.hessian(organ.state.x, organ.state.multiplier, organ.work.matrix);
  for (auto _ : state) benchmark::DoNotOptimize(organ.work.factor.factorise(organ.work.matrix));
}

void solve(benchmark::State& state) {
  Organ organ = gallbladder(static_cast<int>(state.range(0)));
  const Surroundings nothing;
  const BodyProblem problem(organ.body, nothing, {}, organ.state);
  problem.hessian(organ.state.x, organ.state.multiplier, organ.work.matrix);
  if (organ.work.factor.factorise(organ.work.matrix) != FactorStatus::ok)
    return state.SkipWithError("not definite");
  const VecX right = VecX::Ones(organ.state.x.size());
  for (auto _ : state) benchmark::DoNotOptimize(organ.work.factor.solve(right));
}

void nodes(benchmark::internal::Benchmark* part) {
  part->ArgName("nodes")->Arg(61)->Arg(180)->Unit(benchmark::kMicrosecond);
}
BENCHMARK(shell_hessian)->Apply(nodes);
BENCHMARK(bile_hessian)->Apply(nodes);
BENCHMARK(energy_and_gradient)->Apply(nodes);
BENCHMARK(contact_search)->Apply(nodes);
BENCHMARK(factorisation)->Apply(nodes);
BENCHMARK(solve)->Apply(nodes);

}  // namespace
