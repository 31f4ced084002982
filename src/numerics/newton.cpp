#include "numerics/newton.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/timed.h"
#include "numerics/line_search.h"
#include "numerics/response.h"
#include "numerics/secant_steps.h"
#include "numerics/sharp_step.h"
#include "numerics/tangent.h"

namespace calot {
namespace {

/// Of a body's size: a step cut down to this gets nowhere.
constexpr double smallest_move = 1e-13;

struct State {
  VecX gradient;     ///< of the energy
  VecX constraints;  ///< with what their compliances allow: 0 where met
  Eigen::MatrixXd constraint_gradients;
  VecX residual;           ///< gradient - constraint gradients * multipliers
  Worst worst_residual;    ///< relative
  Worst worst_constraint;  ///< relative
};

/// One solve's moving parts, so that its steps can be functions.
class Iteration {
 public:
  Iteration(const ConstrainedEnergy& problem, const NewtonSettings& settings, NewtonWorkspace& work, VecX& x,
            VecX& multipliers)
      : problem_(problem),
        settings_(settings),
        work_(work),
        x_(x),
        multipliers_(multipliers),
        parts_(problem.parts()) {
    int nodes = 0;
    for (const Part& part : parts_) nodes += part.nodes();
    // A node that no part has would never be judged: a defect of ours.
    if (3 * Eigen::Index{nodes} != x.size() || multipliers.size() != problem.constraints()) std::abort();
    if (constrained()) {
      scales_ = problem.constraint_scales();
      compliances_ = problem.compliances();
    }
  }

  NewtonResult run() {
    result_.furthest.resize(parts_.size());
    evaluate(x_, multipliers_, state_);
    while (!ended()) {
      if (result_.iterations == 0 && begins_in_balance()) break;
      ++result_.iterations;
      ++result_.furthest[static_cast<std::size_t>(state_.worst_residual.index)];
      if (!chord() && !newton()) break;
      ++result_.by_last_factor;
    }
    result_.residual = state_.worst_residual.value;
    result_.increment = increment_.value;
    result_.constraint_error = state_.worst_constraint.value;
    if (result_.status != NewtonStatus::mechanism && result_.status != NewtonStatus::dependent_constraints)
      result_.part = worst_part();
    return result_;
  }

 private:
  bool constrained() const { return problem_.constraints() > 0; }

  void evaluate(const VecX& x, const VecX& multipliers, State& state) {
    const Timed timed(result_.assembly_s);
    VecX largest_internal;
    state.constraint_gradients.resize(x.size(), 0);
    if (constrained())
      problem_.gradient_and_constraint(x, state.gradient, largest_internal, state.constraints,
                                       state.constraint_gradients);
    else
      problem_.gradient(x, state.gradient, largest_internal);
    state.residual = state.gradient;
    for (Eigen::Index k = 0; k < multipliers.size(); ++k)
      state.residual -= multipliers[k] * state.constraint_gradients.col(k);
    if (constrained()) state.constraints += compliances_.cwiseProduct(multipliers);
    state.worst_residual = {};
    for (std::size_t p = 0; p < parts_.size(); ++p)
      state.worst_residual.take(largest_node(parts_[p], state.residual) /
                                    std::max(largest_internal[static_cast<Eigen::Index>(p)], 1e-12),
                                static_cast<int>(p));
    state.worst_constraint = {};
    for (Eigen::Index k = 0; k < multipliers.size(); ++k)
      state.worst_constraint.take(std::abs(state.constraints[k]) / scales_[k], static_cast<int>(k));
  }

  /// Makes ready for iterations; whether none is needed, because nodes that are relaxed were all that was out of balance.
  bool begins_in_balance() {
    problem_.prepare(work_);
    VecX relaxed = problem_.relaxed(x_);
    if (relaxed == x_) return false;
    x_ = std::move(relaxed);
    evaluate(x_, multipliers_, state_);
    return balanced();
  }

  /// How far from balance, in units of what is tolerated.
  double imbalance(const State& state) const {
    return std::max(state.worst_residual.value / settings_.tolerance,
                    state.worst_constraint.value / settings_.constraint_tolerance);
  }

  /// How far the forces are from balance, in the same units. Constraints count no more than forces: that a volume is off
  /// by more than 1e-10 does not say that forces are.
  double force_imbalance(const State& state) const {
    return std::max(state.worst_residual.value, state.worst_constraint.value) / settings_.tolerance;
  }

  bool balanced() const {
    return in_place_ || (imbalance(state_) <= 1.0 && increment_.value <= settings_.tolerance);
  }

  /// Whether no coordinates can be nearer to balance: those of each part change by less than they are rounded to.
  /// Stiffness times that is a force, of a stone that falls half a metre away 1e-4 of its weight.
  bool is_below_rounding(const VecX& step) const {
    constexpr double most = 1e-3;  // of the largest forces: what is further off is no rounding
    if (work_.shifted || state_.worst_residual.value > most ||
        state_.worst_constraint.value > settings_.constraint_tolerance)
      return false;
    return std::all_of(parts_.begin(), parts_.end(), [&](const Part& part) {
      return largest_coordinate(part, step) <=
             std::numeric_limits<double>::epsilon() * largest_coordinate(part, x_);
    });
  }

  /// Whether no iteration follows; result_.status says why.
  bool ended() {
    if (!state_.residual.allFinite()) {
      result_.status = NewtonStatus::not_finite;
      return true;
    }
    if (balanced()) return true;
    if (result_.iterations == settings_.max_iterations)
      result_.status = NewtonStatus::iteration_limit;
    else if (settings_.stop && settings_.stop())
      result_.status = NewtonStatus::stopped;
    return result_.status != NewtonStatus::converged;
  }

  /// The part furthest from converged.
  int worst_part() const {
    const Worst& residual = state_.worst_residual;
    if (std::isnan(residual.value)) return residual.index;
    const double by_step = increment_.value / settings_.tolerance;
    if (by_step > imbalance(state_)) return increment_.index;
    if (residual.value / settings_.tolerance < imbalance(state_))
      return part_of_constraint(parts_, state_.constraint_gradients, state_.worst_constraint.index);
    return residual.index;
  }

  /// A share of a step, beside the parts' sizes.
  Worst relative_increment(const VecX& step, double share) const {
    Worst out;
    for (std::size_t p = 0; p < parts_.size(); ++p)
      out.take(share * largest_coordinate(parts_[p], step) / parts_[p].length, static_cast<int>(p));
    return out;
  }

  /// What of `most` of a step is safe.
  double safe_share(const VecX& step, double most) {
    const Timed timed(result_.safety_s);
    return most > 0 ? most * problem_.safe_share(x_, most * step) : 0;
  }

  /// See ConstrainedEnergy's.
  double share_if_whole(const VecX& step) {
    const Timed timed(result_.safety_s);
    return problem_.share_if_whole(x_, step);
  }

  /// Bordered step with the factor at hand, for the residual and constraints at x.
  VecX bordered_step(VecX& dmultipliers) {
    const Timed timed(result_.solve_s);
    VecX step = -work_.factor.solve(state_.residual);
    dmultipliers = work_.border.keep(state_.constraints, step);
    return problem_.curved(x_, std::move(step));
  }

  /// Adds to a step what it misses of terms that bend sharply; whether there is any. Near balance none bends by much. Of 223
  /// steps in two operations that had some and took a node further than `longest` 4 were taken.
  bool sharpen(VecX& step, VecX& dmultipliers) {
    constexpr double near = 3e-3, worth = 0.03, longest = 5e-3;  // m
    if (!step.allFinite() || state_.worst_residual.value < near || largest_node(step) > longest) return false;
    const Timed timed(result_.sharp_s);
    const double residual = largest_node(state_.residual);
    const VecX load = sharp_load(problem_, work_, {x_, step, residual}, worth * residual);
    if (load.size() == 0) return false;
    VecX dmore;
    const VecX more = linear_response(work_, load, dmore);
    step += more;
    if (constrained()) dmultipliers += dmore;
    return step.allFinite();
  }

  /// Second-order correction (Nocedal and Wright, section 15.6): a whole step ends where the constraints hold, not where
  /// their tangents say so; their values cost a share of what a whole evaluation does. It lies in what the factor
  /// answers to them, so that balance is as near as before, to first order.
  void correct_constraints(VecX& step, VecX& dmultipliers) {
    constexpr int most_rounds = 3;
    if (!constrained() || !step.allFinite()) return;
    const Timed timed(result_.assembly_s);
    double missed_before = std::numeric_limits<double>::infinity();
    for (int round = 0; round < most_rounds; ++round) {
      const VecX missed =
          problem_.constraint_values(x_ + step) + compliances_.cwiseProduct(multipliers_ + dmultipliers);
      const double worst = missed.cwiseAbs().cwiseQuotient(scales_).maxCoeff();
      if (!(worst < missed_before) || worst <= 0.1 * settings_.constraint_tolerance) return;
      missed_before = worst;
      dmultipliers += work_.border.restore(missed, step);
    }
  }

  /// A whole step, kept only if it brings the bodies nearer to balance, by this share: then no energy need be asked.
  bool leap(const VecX& step, const VecX& dmultipliers, double worth) {
    const VecX next = problem_.relaxed(x_ + step), multipliers = multipliers_ + dmultipliers;
    State then;
    evaluate(next, multipliers, then);
    if (!then.residual.allFinite()) return false;
    const double far = force_imbalance(state_), left = force_imbalance(then);
    if (left > std::max(worth * far, 1.0) ||
        then.worst_constraint.value >
            std::max(worth * state_.worst_constraint.value, settings_.constraint_tolerance))
      return false;
    x_ = next;
    multipliers_ = multipliers;
    state_ = std::move(then);
    seen_.add(step, dmultipliers);
    increment_ = relative_increment(step, 1.0);
    left_of_last_ = left / far;
    return true;
  }

  /// A step with the last factor.
  bool chord() {
    constexpr double worth = 0.4;  // slower than this, a factorisation pays
    // The next step gets no further than the last one, and a step that is not kept costs a whole evaluation.
    if (left_of_last_ > worth || !serves(work_, problem_)) return false;
    VecX dmultipliers;
    VecX step = bordered_step(dmultipliers);
    seen_.correct(step, dmultipliers);
    sharpen(step, dmultipliers);
    correct_constraints(step, dmultipliers);
    if (!step.allFinite() || share_if_whole(step) < 1.0 || !leap(step, dmultipliers, worth)) return false;
    ++result_.chords;
    return true;
  }

  /// A whole step by a definite matrix, if it is safe and brings the bodies much nearer to balance: a search along it costs
  /// two more evaluations. `safe` receives the share that is, if it is below 1.
  bool jump(VecX& step, VecX& dmultipliers, double& safe) {
    constexpr double worth = 0.5;
    correct_constraints(step, dmultipliers);
    safe = share_if_whole(step);
    if (safe < 1.0 || !leap(step, dmultipliers, worth)) return false;
    definiteness_.convex = 0;  // so near to balance the next matrix may well be definite as it is
    return true;
  }

  /// A full Newton step with a line search; false when it failed (result_.status says why).
  bool newton() {
    seen_.clear();
    result_.by_last_factor = 0;
    work_.border.gradients = state_.constraint_gradients;  // no columns when there is no constraint
    work_.border.compliances = compliances_;
    factorise(problem_, parts_, x_, multipliers_, definiteness_, work_, result_);
    if (result_.status != NewtonStatus::converged) return false;
    VecX dmultipliers;
    const VecX step = bordered_step(dmultipliers);
    if (!step.allFinite()) {
      result_.status = NewtonStatus::not_finite;
      return false;
    }
    double most = 1;
    if (definiteness_.shift == 0) {
      VecX whole = step, with = dmultipliers;
      double safe = 1;
      if (sharpen(whole, with)) {
        if (jump(whole, with, safe)) return true;
        whole = step, with = dmultipliers;
      }
      if (jump(whole, with, safe)) return true;
      // The step itself, which is nearly the same, is looked at as far as that: a longer way takes longer to look at.
      most = safe;
    }
    return descend(step, dmultipliers, safe_share(step, most));
  }

  /// Of a share of a step, from what bordering says of the whole. Where forces are further from balance than all that acts
  /// within the bodies, a shifted matrix may set a nearly singular mode against a constraint alone; the multiplier that this
  /// asks for makes the next matrix worse, and the next multiplier. There it changes by no more than twice what balances the
  /// residual best (least squares). A compliant constraint's follows x, however long the step is.
  double multiplier_change(Eigen::Index k, double share, double whole) const {
    constexpr double far = 10;  // times the largest internal force
    const double change = share * whole;
    if (compliances_[k] > 0 || !work_.shifted || state_.worst_residual.value < far) return change;
    const auto gradient = state_.constraint_gradients.col(k);
    const double most = 2 * std::abs(gradient.dot(state_.residual)) / gradient.squaredNorm();
    return std::clamp(change, -most, most);
  }

  bool descend(const VecX& step, const VecX& dmultipliers, double safe) {
    // step' K step, from the bordered equations, without another product with the matrix.
    double curvature = -state_.residual.dot(step);
    for (Eigen::Index k = 0; k < dmultipliers.size(); ++k)
      curvature += dmultipliers[k] * work_.border.gradients.col(k).dot(step);
    const VecX multipliers = multipliers_ + dmultipliers;
    double share = 0;
    {
      const Timed timed(result_.assembly_s);
      share = line_search(problem_, {x_, step, multipliers, dmultipliers, state_.constraints, curvature},
                          safe, work_.shifted);
    }
    const Worst increment = relative_increment(step, share);
    if (increment.value <= smallest_move) {
      // In balance to rounding no step improves it: a step that is no longer worth taking is the last increment.
      increment_ = relative_increment(step, 1.0);
      in_place_ = is_below_rounding(step);
      if (!balanced()) result_.status = NewtonStatus::stalled;
      return balanced();
    }
    x_ = problem_.relaxed(x_ + share * step);
    for (Eigen::Index k = 0; k < multipliers_.size(); ++k)
      multipliers_[k] += multiplier_change(k, share, dmultipliers[k]);
    const double far = force_imbalance(state_);
    evaluate(x_, multipliers_, state_);
    increment_ = increment;
    left_of_last_ = force_imbalance(state_) / far;
    return true;
  }

  const ConstrainedEnergy& problem_;
  const NewtonSettings& settings_;
  NewtonWorkspace& work_;
  VecX& x_;
  VecX& multipliers_;
  std::vector<Part> parts_;
  VecX scales_, compliances_;  ///< of the constraints
  NewtonResult result_;
  State state_;
  Worst increment_;          ///< the last, relative
  double left_of_last_ = 0;  ///< share of the imbalance that the last step left
  bool in_place_ = false;    ///< no step is worth taking, to rounding
  SecantSteps seen_;
  Definiteness definiteness_;
};

}  // namespace

NewtonResult solve_equilibrium(const ConstrainedEnergy& problem, const NewtonSettings& settings,
                               NewtonWorkspace& work, VecX& x, VecX& multipliers) {
  return Iteration(problem, settings, work, x, multipliers).run();
}

NewtonResult solve_equilibrium(const BodyEnergy& body, const NewtonSettings& settings, NewtonWorkspace& work,
                               VecX& x, double& multiplier) {
  const LoneBody problem(body, x, multiplier);
  VecX multipliers = problem.multipliers();
  const NewtonResult result = solve_equilibrium(problem, settings, work, x, multipliers);
  if (multipliers.size() > 0) multiplier = multipliers[0];
  return result;
}

}  // namespace calot
