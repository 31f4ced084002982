#include "group/staged.h"

namespace calot {

void PartProblem::gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const {
  whole_.gradient(x, gradient, largest_internal);
  for (std::size_t node = 0; node < free_.size(); ++node)
    if (!free_[node]) gradient.segment<3>(3 * static_cast<Eigen::Index>(node)).setZero();
}

void PartProblem::hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const {
  whole_.hessian(x, multipliers, matrix);
  matrix.hold_all_but(free_);
}

bool PartProblem::add_convexity(const VecX& x, BlockMatrix& matrix) const {
  const bool any = whole_.add_convexity(x, matrix);
  if (any) matrix.hold_all_but(free_);
  return any;
}

void PartProblem::constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const {
  whole_.constraint(x, values, gradients);
  for (std::size_t node = 0; node < free_.size(); ++node)
    if (!free_[node]) gradients.middleRows<3>(3 * static_cast<Eigen::Index>(node)).setZero();
}

NewtonResult solve_in_stages(std::span<const Member> members, std::span<const JoinPointer> joins,
                             GroupPatterns& patterns, const NewtonSettings& settings, NewtonWorkspace& work) {
  std::vector<char> coarse, details;
  for (const Member& member : members)
    for (int node = 0; node < member.body.nodes(); ++node) {
      coarse.push_back(node < member.body.coarse_nodes());
      details.push_back(!coarse.back());
    }
  NewtonResult result;
  for (bool second : {false, true}) {
    const GroupProblem problem(members, joins, patterns, second);
    VecX x = problem.coordinates(), multipliers = problem.multipliers();
    work.factored = false;  // each stage has a matrix of its own
    result.add(
        solve_equilibrium(PartProblem(problem, second ? details : coarse), settings, work, x, multipliers));
    work.factored = false;
    problem.keep(x, multipliers);
    if (!result.converged()) break;
  }
  return result;
}

}  // namespace calot
