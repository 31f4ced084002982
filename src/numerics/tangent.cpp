#include "numerics/tangent.h"

#include <algorithm>
#include <cmath>

#include "base/timed.h"
#include "numerics/mechanism.h"

namespace calot {
namespace {

/// Each part's share of its stiffness, N/m.
VecX shifts_of(double share, const BlockMatrix& matrix, std::span<const Part> parts) {
  VecX out(static_cast<Eigen::Index>(parts.size()));
  for (Eigen::Index p = 0; p < out.size(); ++p) out[p] = share * mean_stiffness(matrix, parts[p]);
  return out;
}

void add_shifts(const VecX& shifts, std::span<const Part> parts, BlockMatrix& matrix) {
  for (Eigen::Index p = 0; p < shifts.size(); ++p)
    parts[p].for_nodes([&](int node) { matrix.add_to_diagonal(node, shifts[p]); });
}

FactorStatus factorise_once(Workers* workers, NewtonWorkspace& work, NewtonResult& result) {
  ++result.factorisations;
  return work.factor.factorise(work.matrix, workers);
}

/// Shifts a matrix that is not positive definite until it is; returns by what share of its stiffness.
double shift(std::span<const Part> parts, double last, Workers* workers, NewtonWorkspace& work,
             NewtonResult& result, FactorStatus& status) {
  constexpr double least = 1e-4, factor = 4;
  const VecX whole = shifts_of(1.0, work.matrix, parts);
  double share = 0;
  for (double next = std::max(least, last / factor); status == FactorStatus::not_positive_definite;
       next *= factor) {
    if (!std::isfinite(next)) {
      status = FactorStatus::not_finite;
      break;
    }
    add_shifts((next - share) * whole, parts, work.matrix);
    ++result.shifts;
    share = next;
    status = factorise_once(workers, work, result);
  }
  return share;
}

NewtonStatus factorise_matrix(const ConstrainedEnergy& problem, std::span<const Part> parts, const VecX& x,
                              Definiteness& definiteness, NewtonWorkspace& work, NewtonResult& result) {
  Workers* workers = problem.workers();
  const bool begun_convex = definiteness.convex == 1 && problem.add_convexity(x, work.matrix);
  FactorStatus status = factorise_once(workers, work, result);
  const Border& border = work.border;
  // Between a stiff joint and a strand of fat the condition is low without anything amiss.
  const bool weighed = std::all_of(parts.begin(), parts.end(), [](const Part& part) { return part.weighed; });
  const bool doubtful =
      !weighed && (status == FactorStatus::not_positive_definite ||
                   (status == FactorStatus::ok && work.factor.reciprocal_condition() < 1e-12));
  if (doubtful)
    if (const std::optional<int> loose =
            mechanism(work.matrix, border.gradients, border.compliances, x, parts)) {
      result.part = *loose;
      return NewtonStatus::mechanism;
    }
  // What compliant constraints alone hold has no factor without them. Shifted by this, steps are as good as exact.
  constexpr double next_to_nothing = 1e-7;
  if (doubtful && static_cast<Eigen::Index>(border.kept().size()) < border.gradients.cols() &&
      mechanism(work.matrix, border.gradients, VecX(), x, parts)) {
    add_shifts(shifts_of(next_to_nothing, work.matrix, parts), parts, work.matrix);
    ++result.shifts;
    status = factorise_once(workers, work, result);
  }
  bool convex = begun_convex;
  if (status == FactorStatus::not_positive_definite && !convex && problem.add_convexity(x, work.matrix)) {
    convex = true;
    status = factorise_once(workers, work, result);
  }
  definiteness.convex = !convex ? 0 : begun_convex ? 2 : 1;
  definiteness.shift = shift(parts, definiteness.shift, workers, work, result, status);
  if (status == FactorStatus::not_finite) return NewtonStatus::not_finite;
  if (status == FactorStatus::out_of_memory) return NewtonStatus::out_of_memory;
  work.shifted = convex || definiteness.shift > 0;
  work.sharp = problem.sharp_tangents(x, convex);
  return NewtonStatus::converged;
}

}  // namespace

bool serves(const NewtonWorkspace& work, const ConstrainedEnergy& problem) {
  return work.factored && !work.shifted && problem.constraints() == work.border.constraints();
}

void factorise(const ConstrainedEnergy& problem, std::span<const Part> parts, const VecX& x,
               const VecX& multipliers, Definiteness& definiteness, NewtonWorkspace& work,
               NewtonResult& result) {
  {
    const Timed timed(result.assembly_s);
    problem.hessian(x, multipliers, work.matrix);
  }
  const Timed timed(result.factorisation_s);
  work.factored = false;
  result.status = factorise_matrix(problem, parts, x, definiteness, work, result);
  if (result.status != NewtonStatus::converged) return;
  work.border.solve_with(work.factor, problem.workers());
  if (!work.border.complement.allFinite()) {
    result.status = NewtonStatus::not_finite;
  } else if (const std::optional<int> dependent = work.border.dependent()) {
    result.status = NewtonStatus::dependent_constraints;
    result.part = part_of_constraint(parts, work.border.gradients, *dependent);
  }
  work.factored = result.status == NewtonStatus::converged;
}

int part_of_constraint(std::span<const Part> parts, const Eigen::MatrixXd& gradients, int constraint) {
  Worst most;
  for (std::size_t p = 0; p < parts.size(); ++p)
    most.take(largest_node(parts[p], gradients.col(constraint)), static_cast<int>(p));
  return most.index;
}

}  // namespace calot
