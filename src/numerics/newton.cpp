#include "numerics/newton.h"

#include <cmath>

#include "base/timed.h"
#include "numerics/modes.h"

namespace calot {
namespace {

/// The six rigid motions of a body at x, orthonormal columns. Displacements, which follow the places, turn but do
/// not shift.
Eigen::Matrix<double, Eigen::Dynamic, 6> rigid_motions(const VecX& x, int places) {
  const int nodes = static_cast<int>(x.size()) / 3;
  places = std::min(places, nodes);
  Vec3 centre = Vec3::Zero();
  for (int i = 0; i < places; ++i) centre += x.segment<3>(3 * i) / places;
  Eigen::Matrix<double, Eigen::Dynamic, 6> motions(x.size(), 6);
  for (int i = 0; i < nodes; ++i) {
    const bool place = i < places;
    const Vec3 arm = place ? Vec3(x.segment<3>(3 * i) - centre) : Vec3(x.segment<3>(3 * i));
    for (int axis = 0; axis < 3; ++axis) {
      motions.col(axis).segment<3>(3 * i) = place ? Vec3(Vec3::Unit(axis)) : Vec3(Vec3::Zero());
      motions.col(3 + axis).segment<3>(3 * i) = Vec3::Unit(axis).cross(arm);
    }
  }
  for (int c = 0; c < 6; ++c) {
    for (int k = 0; k < c; ++k) motions.col(c) -= motions.col(k).dot(motions.col(c)) * motions.col(k);
    motions.col(c).normalize();
  }
  return motions;
}

/// A rigid motion that meets no resistance: its stiffness and the forces it causes, but for what the multiplier takes
/// up, are rounding beside the matrix. (The stiffness alone may change its sign where a motion is held softly.) Rigid
/// motions keep the volume, so the border cannot hold them.
bool has_mechanism(const BlockMatrix& matrix, const VecX& border, const VecX& x, int places) {
  const auto motions = rigid_motions(x, places);
  Eigen::Matrix<double, Eigen::Dynamic, 6> forces(x.size(), 6);
  for (int c = 0; c < 6; ++c) forces.col(c) = matrix.multiply(motions.col(c));
  const std::optional<Modes6> resisted = modes(Mat6(motions.transpose() * forces));
  if (!resisted) return false;  // not finite: the solve says so
  Eigen::Index softest = 0;
  const double least = resisted->values.cwiseAbs().minCoeff(&softest), scale = matrix.diagonal_mean();
  if (least >= 1e-9 * scale) return false;
  VecX met = forces * resisted->vectors.col(softest);
  if (border.size() > 0) met -= border.dot(met) / border.squaredNorm() * border;
  return met.norm() < 1e-8 * scale;
}

struct State {
  VecX gradient;  ///< of the energy
  VecX constraint_gradient;
  VecX residual;  ///< gradient - multiplier * constraint gradient
  double constraint = 0;
  double relative_residual = 0, constraint_error = 0;  ///< dimensionless
};

void evaluate(const ConstrainedEnergy& problem, const VecX& x, double multiplier, State& state,
              NewtonResult& result) {
  const Timed timed(result.assembly_s);
  double largest_internal = 0;
  state.constraint = 0;
  if (problem.constrained()) {
    state.constraint =
        problem.gradient_and_constraint(x, state.gradient, largest_internal, state.constraint_gradient);
    state.residual = state.gradient - multiplier * state.constraint_gradient;
  } else {
    problem.gradient(x, state.gradient, largest_internal);
    state.residual = state.gradient;
  }
  state.relative_residual = largest_node(state.residual) / std::max(largest_internal, 1e-12);
  state.constraint_error =
      problem.constrained() ? std::abs(state.constraint) / problem.constraint_scale() : 0.0;
}

/// How far from balance, in units of what is tolerated.
double imbalance(const State& state, const NewtonSettings& settings) {
  return std::max(state.relative_residual / settings.tolerance,
                  state.constraint_error / settings.constraint_tolerance);
}

/// Factorises, raising a diagonal shift until the matrix is positive definite (an instability is passed by
/// descent on the energy); a mechanism is reported instead.
NewtonStatus factorise(NewtonWorkspace& work, const VecX& x, int places, NewtonResult& result) {
  const Timed timed(result.factorisation_s);
  int& shifts = result.shifts;
  const int shifts_before = shifts;
  work.factored = false;
  FactorStatus status = work.factor.factorise(work.matrix);
  const bool doubtful = status == FactorStatus::not_positive_definite ||
                        (status == FactorStatus::ok && work.factor.reciprocal_condition() < 1e-12);
  if (doubtful && has_mechanism(work.matrix, work.constraint_gradient, x, places))
    return NewtonStatus::mechanism;
  double shift = 1e-4 * work.matrix.diagonal_mean();
  while (status == FactorStatus::not_positive_definite) {
    work.matrix.add_to_diagonal(shift);
    ++shifts;
    status = work.factor.factorise(work.matrix);
    shift *= 4;
    if (!std::isfinite(shift)) return NewtonStatus::not_finite;
  }
  if (status == FactorStatus::not_finite) return NewtonStatus::not_finite;
  if (status == FactorStatus::out_of_memory) return NewtonStatus::out_of_memory;
  work.factored = true;
  work.shifted = shifts > shifts_before;
  if (work.constraint_gradient.size() > 0) work.bordered = work.factor.solve(work.constraint_gradient);
  return NewtonStatus::converged;
}

double safe_share(const ConstrainedEnergy& problem, const VecX& x, const VecX& step, NewtonResult& result) {
  const Timed timed(result.safety_s);
  return problem.safe_share(x, step);
}

/// Backtracking on phi = energy - m * constraint + penalty / 2 * constraint^2. Begins with `share`;
/// returns the share taken, 0 when no decrease was found.
double line_search(const ConstrainedEnergy& problem, const VecX& x, const VecX& step, const State& state,
                   double multiplier, double curvature, double share, NewtonResult& result) {
  const bool constrained = problem.constrained();
  const double c = state.constraint;
  // Large enough that the bordered step descends whatever the curvature along it.
  double penalty = 0;
  if (constrained) {
    penalty = (std::abs(multiplier) + 1.0) / problem.constraint_scale();
    if (c != 0) penalty = std::max(penalty, 2.0 * std::max(0.0, -curvature) / (c * c));
  }
  const double slope = -curvature - penalty * c * c;
  const double energy = problem.value(x);
  const auto merit = [&](double e, double constraint) {
    return e - multiplier * constraint + 0.5 * penalty * constraint * constraint;
  };
  const double start = merit(energy, c);
  // Differences below the rounding of the sum cannot be judged.
  const double rounding = 1e-13 * (std::abs(energy) + std::abs(multiplier) * problem.constraint_scale());
  const Timed timed(result.assembly_s);
  for (int trial = 0; trial < 40 && share > 0; ++trial) {
    const VecX next = x + share * step;
    const double e = problem.value(next);
    if (std::isfinite(e)) {
      const double now = merit(e, constrained ? problem.constraint_value(next) : 0.0);
      if (now <= start + 1e-4 * share * slope + rounding) return share;
    }
    share *= 0.5;
  }
  return 0;
}

}  // namespace

double force_scale(double largest_internal, const VecX& gradient) {
  return std::max(largest_internal, 1e-3 * largest_node(gradient));
}

double largest_node(const Eigen::Ref<const VecX>& v) {
  double largest_squared = 0;
  for (int i = 0; i + 2 < v.size(); i += 3)
    // Not std::max, which would swallow a NaN.
    if (const double squared = v.segment<3>(i).squaredNorm(); !(squared <= largest_squared)) {
      largest_squared = squared;
      if (std::isnan(squared)) break;
    }
  return std::sqrt(largest_squared);
}

void NewtonResult::add(const NewtonResult& next) {
  const NewtonResult before = *this;
  *this = next;
  iterations += before.iterations;
  chords += before.chords;
  shifts += before.shifts;
  assembly_s += before.assembly_s;
  factorisation_s += before.factorisation_s;
  solve_s += before.solve_s;
  safety_s += before.safety_s;
}

std::string to_text(NewtonStatus status) {
  switch (status) {
    case NewtonStatus::converged:
      return "converged";
    case NewtonStatus::not_finite:
      return "a value is not finite";
    case NewtonStatus::mechanism:
      return "nothing holds the body against a rigid motion";
    case NewtonStatus::stalled:
      return "no step lowers the energy any more";
    case NewtonStatus::iteration_limit:
      return "the iteration limit was reached";
    case NewtonStatus::out_of_memory:
      return "out of memory";
    case NewtonStatus::stopped:
      return "stopped";
  }
  return "unknown";
}

namespace {

void assemble(const ConstrainedEnergy& problem, const VecX& x, double multiplier, NewtonWorkspace& work,
              NewtonResult& result) {
  const Timed timed(result.assembly_s);
  problem.hessian(x, multiplier, work.matrix);
}

/// Of the body's size: a step cut down to this gets nowhere.
constexpr double smallest_move = 1e-13;

/// Whether the last factor can serve this problem's chord steps and predictions.
bool serves(const NewtonWorkspace& work, const ConstrainedEnergy& problem) {
  return work.factored && !work.shifted && problem.constrained() == (work.constraint_gradient.size() > 0);
}

/// What whole steps since the last factorisation say of how the tangent has changed: Broyden's good method, by his
/// steps alone (Kelley, Iterative Methods for Linear and Nonlinear Equations, 1995, section 7.3).
class SecantSteps {
 public:
  void clear() { steps_.clear(); }
  void add(VecX step, double dmultiplier) {
    const double squared = step.squaredNorm();
    steps_.push_back({std::move(step), dmultiplier, squared});
  }
  /// Turns the old factor's answer to a residual into that of the tangent the steps have seen.
  void correct(VecX& step, double& dmultiplier) const {
    constexpr double least = 0.25;  // a step is not believed to be longer than four of the old factor's
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const double along = steps_[k].x.dot(step) / steps_[k].squared;
      if (k + 1 < steps_.size()) {
        step += along * steps_[k + 1].x;
        dmultiplier += along * steps_[k + 1].multiplier;
      } else {
        const double stretch = 1.0 / std::max(1.0 - along, least);
        step *= stretch;
        dmultiplier *= stretch;
      }
    }
  }

 private:
  struct Step {
    VecX x;
    double multiplier;
    double squared;  ///< length squared, m^2
  };
  std::vector<Step> steps_;
};

/// One solve's moving parts, so that its steps can be functions.
struct Iteration {
  const ConstrainedEnergy& problem;
  const NewtonSettings& settings;
  NewtonWorkspace& work;
  VecX& x;
  double& multiplier;
  NewtonResult result;
  State state;
  SecantSteps seen;

  /// Bordered step with the factor at hand, for the residual and constraint at x.
  VecX bordered_step(double& dmultiplier) {
    const Timed timed(result.solve_s);
    VecX step = -work.factor.solve(state.residual);
    dmultiplier = 0;
    if (problem.constrained()) {
      const double complement = work.constraint_gradient.dot(work.bordered);
      dmultiplier = -(state.constraint + work.constraint_gradient.dot(step)) / complement;
      step += dmultiplier * work.bordered;
    }
    return step;
  }

  /// A whole step, kept only if it brings the body much nearer to balance: then no energy need be asked.
  bool leap(const VecX& step, double dmultiplier) {
    constexpr double worth = 0.25;  // slower than this, a factorisation pays
    const VecX next = x + step;
    State then;
    evaluate(problem, next, multiplier + dmultiplier, then, result);
    if (!then.residual.allFinite() || imbalance(then, settings) > worth * imbalance(state, settings))
      return false;
    x = next;
    multiplier += dmultiplier;
    state = std::move(then);
    seen.add(step, dmultiplier);
    result.increment = step.lpNorm<Eigen::Infinity>() / problem.length_scale();
    return true;
  }

  /// A step with the last factor.
  bool chord() {
    if (!serves(work, problem)) return false;
    double dmultiplier = 0;
    VecX step = bordered_step(dmultiplier);
    seen.correct(step, dmultiplier);
    if (!step.allFinite() || safe_share(problem, x, step, result) < 1.0 || !leap(step, dmultiplier))
      return false;
    ++result.chords;
    return true;
  }

  /// A full Newton step with a line search; false when it failed (result.status says why).
  bool newton() {
    seen.clear();
    assemble(problem, x, multiplier, work, result);
    work.constraint_gradient = state.constraint_gradient;  // empty when there is no constraint
    result.status = factorise(work, x, problem.places(), result);
    if (result.status != NewtonStatus::converged) return false;
    double dmultiplier = 0;
    const VecX step = bordered_step(dmultiplier);
    result.status = NewtonStatus::not_finite;
    if (!step.allFinite()) return false;
    const double safe = safe_share(problem, x, step, result);
    if (!work.shifted && safe == 1.0 && leap(step, dmultiplier)) {
      result.status = NewtonStatus::converged;
      return true;
    }
    // step' K step, from the bordered equations, without another product with the matrix.
    double curvature = -state.residual.dot(step);
    if (problem.constrained()) curvature += dmultiplier * work.constraint_gradient.dot(step);
    const double share =
        line_search(problem, x, step, state, multiplier + dmultiplier, curvature, safe, result);
    result.status = NewtonStatus::stalled;
    if (share * step.lpNorm<Eigen::Infinity>() <= smallest_move * problem.length_scale()) return false;
    x += share * step;
    multiplier += share * dmultiplier;
    evaluate(problem, x, multiplier, state, result);
    result.increment = share * step.lpNorm<Eigen::Infinity>() / problem.length_scale();
    result.status = NewtonStatus::converged;
    return true;
  }

  bool balanced() const {
    return imbalance(state, settings) <= 1.0 && result.increment <= settings.tolerance;
  }
};

}  // namespace

NewtonResult solve_equilibrium(const ConstrainedEnergy& problem, const NewtonSettings& settings,
                               NewtonWorkspace& work, VecX& x, double& multiplier) {
  Iteration it{problem, settings, work, x, multiplier, {}, {}, {}};
  NewtonResult& result = it.result;
  evaluate(problem, x, multiplier, it.state, result);
  while (true) {
    result.residual = it.state.relative_residual;
    result.constraint_error = it.state.constraint_error;
    if (!it.state.residual.allFinite()) result.status = NewtonStatus::not_finite;
    if (result.status != NewtonStatus::converged || it.balanced()) return result;
    if (result.iterations == settings.max_iterations) {
      result.status = NewtonStatus::iteration_limit;
      return result;
    }
    if (settings.stop && settings.stop()) {
      result.status = NewtonStatus::stopped;
      return result;
    }
    if (result.iterations++ == 0) problem.prepare(work);
    if (!it.chord() && !it.newton()) return result;
  }
}

void NewtonWorkspace::restore(const Kept& kept) {
  if (!matrix.same_pattern(kept.pattern)) matrix = kept.pattern.blank();
  factor = kept.factor;
  constraint_gradient = kept.constraint_gradient;
  bordered = kept.bordered;
  factored = kept.factored;
  shifted = kept.shifted;
}

NewtonResult factorise_tangent(const ConstrainedEnergy& problem, NewtonWorkspace& work, const VecX& x,
                               double multiplier, bool fresh) {
  NewtonResult result;
  problem.prepare(work);
  if (!fresh && serves(work, problem)) return result;
  work.constraint_gradient.resize(0);
  if (problem.constrained()) problem.constraint(x, work.constraint_gradient);
  assemble(problem, x, multiplier, work, result);
  result.status = factorise(work, x, problem.places(), result);
  return result;
}

VecX linear_response(const NewtonWorkspace& work, const VecX& load, double& dmultiplier) {
  VecX dx = work.factor.solve(load);
  dmultiplier = 0;
  if (work.constraint_gradient.size() > 0) {
    dmultiplier = -work.constraint_gradient.dot(dx) / work.constraint_gradient.dot(work.bordered);
    dx += dmultiplier * work.bordered;
  }
  return dx;
}

FirstOrderAnswer first_order_answer(const ConstrainedEnergy& problem, NewtonWorkspace& work, const VecX& x,
                                    double multiplier, const VecX& load, const std::vector<double>& edges,
                                    bool fresh) {
  FirstOrderAnswer out;
  out.result = factorise_tangent(problem, work, x, multiplier, fresh);
  if (!out.result.converged()) return out;
  const Timed timed(out.result.solve_s);
  out.dx = linear_response(work, load, out.dmultiplier);
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

}  // namespace calot
