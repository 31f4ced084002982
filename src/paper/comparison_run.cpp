#include "paper/comparison_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace calot {
namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

const char* name_of(FactorKind kind) {
  return kind == FactorKind::dense ? "dense" : kind == FactorKind::sparse ? "sparse" : "condensed";
}

std::vector<FactorKind> solvers_of(const ComparedBody& body, bool extended) {
  // Beyond, one factorisation takes a minute; the many nodes of fine stars hardly fill a matrix.
  const int most_dense_nodes = extended ? 400 : 1000;
  std::vector<FactorKind> out = {FactorKind::sparse};
  if (body.nodes() <= most_dense_nodes) out.push_back(FactorKind::dense);
  if (body.coarse_nodes() < body.nodes()) out.push_back(FactorKind::condensed);
  return out;
}

double fastest_factor_and_solve(const ComparedBody& body, bool extended) {
  constexpr double enough = 0.2;  // s for each solver and system
  constexpr int most = 25;
  double sum = 0;
  for (const NewtonWorkspace* system : body.systems()) {
    double best = 0;
    for (FactorKind kind : solvers_of(body, extended)) {
      Cholesky factor(system->matrix, body.coarse_nodes(), kind);
      const VecX right = VecX::Ones(system->matrix.size());
      std::vector<double> times;
      const double start = now_s();
      do {
        const double before = now_s();
        if (factor.factorise(system->matrix) != FactorStatus::ok) break;
        if (!factor.solve(right).allFinite()) break;
        times.push_back(now_s() - before);
      } while (now_s() - start < enough && std::ssize(times) < most);
      if (times.empty()) continue;
      const double time = median(times);
      if (best == 0 || time < best) best = time;
    }
    sum += best;
  }
  return sum;
}

ComparedRun run_out_and_back(ComparedBody& body, const ComparedLoad& load, FactorKind solver, int steps_out,
                             const ComparisonCase& given, bool to_the_end) {
  ComparedRun out;
  if (const NewtonResult filled = body.begin(load, solver); !filled.converged()) {
    out.status = "not filled: " + to_text(filled.status);
    return out;
  }
  constexpr int least_steps = 5;
  const std::vector<Vec3> before = body.surface();
  const double start = now_s();
  for (int k = 1; k <= 2 * steps_out * given.cycles; ++k) {
    const int phase = k % (2 * steps_out);
    const double share = static_cast<double>(phase <= steps_out ? phase : 2 * steps_out - phase) / steps_out;
    if (given.stopped()) {
      out.status = "interrupted";
      return out;
    }
    const double begin = now_s();
    const NewtonResult result = body.step(share);
    out.times_s.push_back(now_s() - begin);
    out.iterations += result.iterations;
    if (!result.converged()) {
      out.status = fmt::format("step {}: {}", k, to_text(result.status));
      return out;
    }
    if (k == steps_out) {
      out.displacements = body.surface();
      for (std::size_t i = 0; i < before.size(); ++i) out.displacements[i] -= before[i];
    }
    const int least = to_the_end ? steps_out : std::min(steps_out, least_steps);
    if (now_s() - start > given.patience && k >= least) break;
  }
  return out;
}

}  // namespace calot
