#include "numerics/response.h"

#include "base/timed.h"
#include "numerics/tangent.h"

namespace calot {

NewtonResult factorise_tangent(const ConstrainedEnergy& problem, NewtonWorkspace& work, const VecX& x,
                               const VecX& multipliers, bool fresh) {
  NewtonResult result;
  // The factor at hand serves whatever has come near since: an answer is of first order.
  if (!fresh && work.matrix.size() == x.size() && serves(work, problem)) return result;
  problem.prepare(work);
  VecX values;
  work.border.gradients.resize(x.size(), 0);
  if (problem.constraints() > 0) problem.constraint(x, values, work.border.gradients);
  work.border.compliances = problem.compliances();
  Definiteness definiteness;
  factorise(problem, problem.parts(), x, multipliers, definiteness, work, result);
  return result;
}

NewtonResult factorise_tangent(const BodyEnergy& body, NewtonWorkspace& work, const VecX& x,
                               double multiplier, bool fresh) {
  const LoneBody problem(body, x, multiplier);
  return factorise_tangent(problem, work, x, problem.multipliers(), fresh);
}

VecX linear_response(const NewtonWorkspace& work, const VecX& load, VecX& dmultipliers, const VecX& values) {
  VecX dx = work.factor.solve(load);
  dmultipliers =
      work.border.keep(values.size() > 0 ? values : VecX(VecX::Zero(work.border.constraints())), dx);
  return dx;
}

FirstOrderAnswer first_order_answer(const ConstrainedEnergy& problem, NewtonWorkspace& work, const VecX& x,
                                    const VecX& multipliers, const VecX& load,
                                    const std::vector<double>& edges, bool fresh, const VecX& values) {
  FirstOrderAnswer out;
  out.result = factorise_tangent(problem, work, x, multipliers, fresh);
  if (!out.result.converged()) return out;
  const Timed timed(out.result.solve_s);
  out.dx = linear_response(work, load, out.dmultipliers, values);
  if (!out.dx.allFinite()) {
    out.result.status = NewtonStatus::not_finite;
    return out;
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double move = out.dx.segment<3>(3 * static_cast<Eigen::Index>(i)).norm();
    if (move * out.share > answer_edge_share * edges[i]) out.share = answer_edge_share * edges[i] / move;
  }
  return out;
}

FirstOrderAnswer first_order_answer(const BodyEnergy& body, NewtonWorkspace& work, const VecX& x,
                                    double multiplier, const VecX& load, const std::vector<double>& edges,
                                    bool fresh) {
  const LoneBody problem(body, x, multiplier);
  return first_order_answer(problem, work, x, problem.multipliers(), load, edges, fresh);
}

}  // namespace calot
