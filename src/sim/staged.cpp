#include "sim/staged.h"

namespace calot {

void PartProblem::keep_free(VecX& v) const {
  v.head(3 * Eigen::Index{first_}).setZero();
  v.tail(v.size() - 3 * Eigen::Index{last_}).setZero();
}

void PartProblem::gradient(const VecX& x, VecX& gradient, double& largest_internal) const {
  whole_.gradient(x, gradient, largest_internal);
  keep_free(gradient);
}

void PartProblem::hessian(const VecX& x, double multiplier, BlockMatrix& matrix) const {
  whole_.hessian(x, multiplier, matrix);
  matrix.hold_all_but(first_, last_);
}

double PartProblem::constraint(const VecX& x, VecX& gradient) const {
  const double value = whole_.constraint(x, gradient);
  keep_free(gradient);
  return value;
}

NewtonResult solve_in_stages(const ShellBody& body, const StagedProblem& problem,
                             const NewtonSettings& settings, NewtonWorkspace& work, BodyState& state) {
  work.factored = false;  // each stage has a matrix of its own
  NewtonResult result = solve_equilibrium(PartProblem(*problem(state, false), 0, body.coarse_nodes()),
                                          settings, work, state.x, state.datum_pressure);
  work.factored = false;
  if (!result.converged()) return result;
  double pressure = state.datum_pressure;
  result.add(solve_equilibrium(PartProblem(*problem(state, true), body.coarse_nodes(), body.nodes()),
                               settings, work, state.x, pressure));
  work.factored = false;
  return result;
}

}  // namespace calot
