// Which factor serves a group of bodies: shells, rods tied to them at both ends, and strands from one shell to the other.
// What is printed is the time of one factorisation and of one solve; the switch in numerics/cholesky.h goes by it.

#include <benchmark/benchmark.h>

#include <algorithm>

#include "base/rng.h"
#include "numerics/cholesky.h"
#include "numerics/condense.h"
#include "organs/body_kinds.h"

namespace calot::factor_bench {
namespace {

using Cliques = std::vector<std::vector<int>>;

/// Faces of a gallbladder's limit surface, by the nodes they blend.
Cliques faces(int nodes) {
  OrganDefinition definition = named_anatomy("standard")->organs[0];
  definition.nodes = nodes;
  return make_organ(definition, {}, Vec3::UnitZ(), 1e-6).value().organ.body->as_shell()->shell().cliques();
}

struct Group {
  std::vector<char> kept;
  Cliques cliques;

  int nodes() const { return static_cast<int>(kept.size()); }
  /// Nodes of a body follow those of the ones before.
  void add_body(const Cliques& faces_of_body) {
    const int first = nodes();
    for (std::vector<int> face : faces_of_body) {
      for (int& node : face)
        kept.resize(std::max(kept.size(), static_cast<std::size_t>(node += first) + 1), 1);
      cliques.push_back(std::move(face));
    }
  }
  /// A chain of condensed nodes, each coupled with the two before it, its ends with a face's.
  void add_rod(int length, const std::vector<int>& here, const std::vector<int>& there) {
    const int first = nodes();
    kept.resize(kept.size() + static_cast<std::size_t>(length), 0);
    for (int k = first + 2; k < nodes(); ++k) cliques.push_back({k - 2, k - 1, k});
    cliques.push_back(here);
    cliques.push_back(there);
    cliques[cliques.size() - 2].push_back(first);
    cliques.back().push_back(nodes() - 1);
  }
  void add_strand(const std::vector<int>& here, const std::vector<int>& there) {
    cliques.push_back(here);
    cliques.back().push_back(nodes());
    cliques.push_back(there);
    cliques.back().push_back(nodes());
    kept.push_back(0);
  }
  /// Its springs between the nodes of each clique, with a little to hold them.
  BlockMatrix matrix() const {
    BlockMatrix out(nodes(), cliques);
    Rng rng(1);
    for (const std::vector<int>& clique : cliques)
      for (int a : clique)
        for (int b : clique) {
          if (b >= a) continue;
          const Vec3 along(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
          const Mat3 spring = along * along.transpose();
          out.add(a, b, -spring);
          out.add(a, a, spring);
          out.add(b, b, spring);
        }
    out.add_to_diagonal(1e-2);
    return out;
  }
};

/// Shells of `first` and `second` nodes (0: none); strands tie faces beside each other, half a body's at most.
Group group(int first, int second, int rods, int strands) {
  Group out;
  const Cliques one = faces(first), other = second > 0 ? faces(second) : one;
  out.add_body(one);
  if (second > 0) out.add_body(other);
  const auto face = [&](const Cliques& of, std::size_t k, int offset) {
    std::vector<int> nodes = of[k];
    for (int& node : nodes) node += offset;
    return nodes;
  };
  const int offset = second > 0 ? first : 0;
  for (int k = 0; k < rods; ++k)
    out.add_rod(11, face(one, 40 * static_cast<std::size_t>(k) % one.size(), 0),
                face(other, other.size() - 1 - 20 * static_cast<std::size_t>(k) % other.size(), offset));
  for (int k = 0; k < strands; ++k) {
    const double along = 0.5 * k / strands;
    out.add_strand(face(one, static_cast<std::size_t>(along * static_cast<double>(one.size())), 0),
                   face(other, static_cast<std::size_t>(along * static_cast<double>(other.size())), offset));
  }
  return out;
}

/// Arguments: nodes of two shells, rods, strands, kind of factor (0 dense, 1 sparse, 2 condensed).
Group group(const benchmark::State& state) {
  return group(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
               static_cast<int>(state.range(2)), static_cast<int>(state.range(3)));
}

void group_factor(benchmark::State& state) {
  const Group given = group(state);
  const BlockMatrix matrix = given.matrix();
  Cholesky factor(matrix, given.kept, static_cast<FactorKind>(state.range(4)));
  for (auto _ : state)
    if (factor.factorise(matrix) != FactorStatus::ok) return state.SkipWithError("not definite");
  state.counters["Mflop"] = factor.factor_flops() * 1e-6;
  state.counters["kentries"] = static_cast<double>(factor.factor_nonzeros()) * 1e-3;
}

void group_solve(benchmark::State& state) {
  const Group given = group(state);
  const BlockMatrix matrix = given.matrix();
  Cholesky factor(matrix, given.kept, static_cast<FactorKind>(state.range(4)));
  if (factor.factorise(matrix) != FactorStatus::ok) return state.SkipWithError("not definite");
  const VecX right = VecX::Ones(matrix.size());
  for (auto _ : state) benchmark::DoNotOptimize(factor.solve(right));
}

void group_analysis(benchmark::State& state) {
  const Group given = group(state);
  const BlockMatrix matrix = given.matrix();
  for (auto _ : state)
    benchmark::DoNotOptimize(Cholesky(matrix, given.kept, static_cast<FactorKind>(state.range(4))));
}

/// What of a condensed factorisation goes into its pieces.
void elimination(benchmark::State& state) {
  const Group given = group(state);
  const BlockMatrix matrix = given.matrix();
  Condensation condensation(matrix, given.kept);
  EnvelopeFactor kept(condensation.kept_couplings());
  for (auto _ : state) benchmark::DoNotOptimize(condensation.eliminate(matrix, kept));
  state.counters["pieces"] = condensation.pieces();
}

void groups(benchmark::internal::Benchmark* part) {
  part->ArgNames({"nodes", "more", "rods", "strands", "kind"})->Unit(benchmark::kMillisecond);
  const std::vector<std::vector<std::int64_t>> all = {
      {100, 0, 0, 0},    {180, 0, 0, 0},     {180, 0, 2, 0},     {180, 0, 0, 300},   {180, 40, 2, 100},
      {180, 40, 2, 600}, {180, 100, 4, 300}, {238, 238, 6, 300}, {300, 200, 6, 600}, {946, 0, 0, 0}};
  for (const std::vector<std::int64_t>& one : all)
    for (FactorKind kind : {FactorKind::dense, FactorKind::sparse, FactorKind::condensed}) {
      std::vector<std::int64_t> arguments = one;
      arguments.push_back(static_cast<std::int64_t>(kind));
      part->Args(arguments);
    }
}
BENCHMARK(group_factor)->Apply(groups);
BENCHMARK(group_solve)->Apply(groups);
BENCHMARK(group_analysis)->Apply(groups);
BENCHMARK(elimination)->Apply(groups);

}  // namespace
}  // namespace calot::factor_bench
