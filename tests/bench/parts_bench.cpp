// The parts of a step one by one, at the paper's 61 nodes and the gallbladder's 180.

#include <benchmark/benchmark.h>

#include "motion/structural_extension.h"
#include "organs/body_kinds.h"
#include "tools/instrument.h"

namespace calot::parts_bench {
namespace {

RestedOrgan gallbladder(int nodes, int levels = 0) {
  OrganDefinition definition = named_anatomy("standard")->organs[0];
  definition.nodes = nodes;
  return make_organ(definition, {}, Vec3::UnitZ(), 1e-6, levels).value();
}

void shell_hessian(benchmark::State& state) {
  auto [organ, work] = gallbladder(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    work.matrix.set_zero();
    organ.body->as_shell()->shell().add_hessian(organ.state.x, work.matrix);
  }
}

void shared_shell_hessian(benchmark::State& state) {
  auto [organ, work] = gallbladder(static_cast<int>(state.range(0)));
  Workers workers(static_cast<int>(state.range(1)));
  Assembly assembly(workers);
  for (auto _ : state) {
    work.matrix.set_zero();
    organ.body->as_shell()->shell().add_hessian(organ.state.x, work.matrix, &assembly);
  }
}

void bile_hessian(benchmark::State& state) {
  auto [organ, work] = gallbladder(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    work.matrix.set_zero();
    organ.body->as_shell()->bile()->add_hessian(organ.state.x, organ.state.datum_pressure, work.matrix);
  }
}

void energy_and_gradient(benchmark::State& state) {
  const Organ organ = gallbladder(static_cast<int>(state.range(0))).organ;
  const ContactLoads nothing;
  const BodyProblem problem(*organ.body, nothing, {}, organ.state);
  VecX gradient, largest;
  for (auto _ : state) {
    benchmark::DoNotOptimize(problem.value(organ.state.x));
    problem.gradient(organ.state.x, gradient, largest);
  }
}

/// The search for skin points near a closed grasper whose tip touches the organ.
void contact_search(benchmark::State& state) {
  const Organ organ = gallbladder(static_cast<int>(state.range(0))).organ;
  const Vec3 fundus = organ.body->skin_positions(organ.state.x)[organ.landmarks.at("fundus")];
  const Vec3 trocar = fundus + Vec3(20e-3, -20e-3, 100e-3);
  ContactLoads field;
  field.shapes = instrument_shapes(trocar, pose_reaching(trocar, fundus, 0, 0), {});
  for (auto _ : state) benchmark::DoNotOptimize(gather_pairs(*organ.body, organ.state.x, field, 2e-3));
}

void factorisation(benchmark::State& state) {
  auto [organ, work] = gallbladder(static_cast<int>(state.range(0)));
  const ContactLoads nothing;
  const BodyProblem problem(*organ.body, nothing, {}, organ.state);
  problem.hessian(organ.state.x, problem.multipliers(), work.matrix);
  for (auto _ : state) benchmark::DoNotOptimize(work.factor.factorise(work.matrix));
}

void solve(benchmark::State& state) {
  auto [organ, work] = gallbladder(static_cast<int>(state.range(0)));
  const ContactLoads nothing;
  const BodyProblem problem(*organ.body, nothing, {}, organ.state);
  problem.hessian(organ.state.x, problem.multipliers(), work.matrix);
  if (work.factor.factorise(work.matrix) != FactorStatus::ok) return state.SkipWithError("not definite");
  const VecX right = VecX::Ones(organ.state.x.size());
  for (auto _ : state) benchmark::DoNotOptimize(work.factor.solve(right));
}

/// A second extension of twelve nodes beside one that is there, and its matrix and factor's workspace.
void laying_an_extension(benchmark::State& state) {
  const Organ organ = gallbladder(static_cast<int>(state.range(0)), 1).organ;
  const int fundus = organ.landmarks.at("fundus"), neck = organ.landmarks.at("neck");
  const ShellBody one =
      organ.body->as_shell()->with_details(details_around(*organ.body->as_shell(), {{0, fundus}})).value();
  const std::vector<int> both = details_around(*organ.body->as_shell(), {{0, fundus}, {1, neck}});
  for (auto _ : state) {
    const ShellBody two = one.with_details(both).value();
    benchmark::DoNotOptimize(NewtonWorkspace(two.pattern(), two.coarse_nodes()));
  }
}

void nodes(benchmark::internal::Benchmark* part) {
  part->ArgName("nodes")->Arg(61)->Arg(180)->Unit(benchmark::kMicrosecond);
}
BENCHMARK(shell_hessian)->Apply(nodes);
BENCHMARK(shared_shell_hessian)
    ->ArgNames({"nodes", "threads"})
    ->ArgsProduct({{61, 180}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(bile_hessian)->Apply(nodes);
BENCHMARK(energy_and_gradient)->Apply(nodes);
BENCHMARK(contact_search)->Apply(nodes);
BENCHMARK(factorisation)->Apply(nodes);
BENCHMARK(solve)->Apply(nodes);
BENCHMARK(laying_an_extension)->Apply(nodes);

}  // namespace
}  // namespace calot::parts_bench
