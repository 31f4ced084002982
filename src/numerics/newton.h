#pragma once
// Newton's method for a stationary point of an energy under at most one scalar constraint, by bordering, with
// a line search on the augmented Lagrangian (Nocedal and Wright, Numerical Optimization, 2nd ed., ch. 17 and
// 18).

#include <functional>
#include <limits>
#include <string>

#include "numerics/block_matrix.h"
#include "numerics/cholesky.h"

namespace calot {

/// Length of the largest of the 3-vectors, one a node, that v is made of.
double largest_node(const Eigen::Ref<const VecX>& v);

/// Scale of a residual, N, from the largest internal nodal force: a body at rest carries none yet, then the loads on it
/// (the rest of the gradient) are the scale.
double force_scale(double largest_internal, const VecX& gradient);

/// L(x, m) = energy(x) - m * constraint(x), to be made stationary in x with constraint(x) = 0.
class ConstrainedEnergy {
 public:
  virtual ~ConstrainedEnergy() = default;
  virtual bool constrained() const = 0;
  /// J; infinite where x is not admissible.
  virtual double value(const VecX& x) const = 0;
  /// Gradient (N, 3 a node); `largest_internal` receives the largest nodal force of the elastic part (N): the
  /// scale of a residual.
  virtual void gradient(const VecX& x, VecX& gradient, double& largest_internal) const = 0;
  /// Hessian of L into `matrix` (values are overwritten).
  virtual void hessian(const VecX& x, double multiplier, BlockMatrix& matrix) const = 0;
  /// Constraint and its gradient; not called when unconstrained.
  virtual double constraint(const VecX& x, VecX& gradient) const = 0;
  virtual double constraint_value(const VecX& x) const = 0;
  /// gradient() and constraint() at once, for where they share what they are made of.
  virtual double gradient_and_constraint(const VecX& x, VecX& of_energy, double& largest_internal,
                                         VecX& of_constraint) const {
    gradient(x, of_energy, largest_internal);
    return constraint(x, of_constraint);
  }
  /// Scale of the constraint (the kept volume), > 0.
  virtual double constraint_scale() const = 0;
  /// How many of the first nodes of x are places, if not all; the others are displacements added to them.
  virtual int places() const { return std::numeric_limits<int>::max(); }
  /// Size of the body, m: the scale of an increment.
  virtual double length_scale() const = 0;
  /// Called before a tangent is asked for, and before the first step of a solve that does not begin in balance: makes
  /// room in the matrix for what the solve may couple.
  virtual void prepare(struct NewtonWorkspace&) const {}
  /// Largest share (0 to 1] of the step that is safe to take (nothing crosses).
  virtual double safe_share(const VecX& x, const VecX& step) const = 0;
};

struct NewtonSettings {
  double tolerance = 1e-6;              ///< residual and increment, dimensionless
  double constraint_tolerance = 1e-10;  ///< relative
  int max_iterations = 80;
  std::function<bool()> stop{};  ///< asked before each iteration: true ends the solve there; may be empty
};

enum class NewtonStatus {
  converged,
  not_finite,
  mechanism,
  stalled,
  iteration_limit,
  out_of_memory,
  stopped
};

struct NewtonResult {
  NewtonStatus status = NewtonStatus::converged;
  int iterations = 0;
  int chords = 0;               ///< of the iterations, those that reused a factor
  int shifts = 0;               ///< factorisations that needed a diagonal shift
  double residual = 0;          ///< largest nodal residual / largest internal nodal force
  double increment = 0;         ///< largest coordinate of the last increment / length scale
  double constraint_error = 0;  ///< relative
  /// Wall time, for benchmarks only: energies and their derivatives, factors, solves with them, and
  /// safe_share.
  double assembly_s = 0, factorisation_s = 0, solve_s = 0, safety_s = 0;
  bool converged() const { return status == NewtonStatus::converged; }
  /// Takes over the outcome of a further solve and adds its counts and times.
  void add(const NewtonResult& next);
};

/// In words, for an error message.
std::string to_text(NewtonStatus status);

/// Workspace of a body, kept between solves.
struct NewtonWorkspace {
  /// `coarse` nodes first, those of extensions after them.
  explicit NewtonWorkspace(BlockMatrix pattern, int coarse = std::numeric_limits<int>::max())
      : matrix(std::move(pattern)), factor(matrix, coarse) {}
  BlockMatrix matrix;
  Cholesky factor;
  VecX constraint_gradient;  ///< at the last factorisation
  VecX bordered;             ///< factor^-1 constraint_gradient
  bool factored = false;
  bool shifted = false;  ///< the factor is of a shifted matrix: no use for chord steps

  /// All that later solves depend on: the matrix' values are written anew by each. Cheap to copy, as the factor is
  /// shared until the next one is made.
  struct Kept {
    BlockMatrix pattern;
    Cholesky factor;
    VecX constraint_gradient, bordered;
    bool factored, shifted;
  };
  Kept keep() const {
    return {matrix.pattern_only(), factor, constraint_gradient, bordered, factored, shifted};
  }
  void restore(const Kept& kept);
};

/// Solves from (x, multiplier), which receive the result; on failure they hold the last iterate.
NewtonResult solve_equilibrium(const ConstrainedEnergy& problem, const NewtonSettings& settings,
                               NewtonWorkspace& workspace, VecX& x, double& multiplier);

/// First-order response to a change of load with the last factor: K dx = load, constraint kept to first
/// order. dmultiplier receives the multiplier's change. Needs workspace.factored.
VecX linear_response(const NewtonWorkspace& workspace, const VecX& load, double& dmultiplier);

/// Factorises the tangent at (x, multiplier) into the workspace, for linear_response; unless `fresh`, a last
/// factor that can serve is kept. Of the result only status, shifts and times have a meaning.
NewtonResult factorise_tangent(const ConstrainedEnergy& problem, NewtonWorkspace& workspace, const VecX& x,
                               double multiplier, bool fresh);

/// No node of a first-order answer is believed further than this share of its shortest edge.
inline constexpr double answer_edge_share = 0.5;

struct FirstOrderAnswer {
  NewtonResult result;  ///< status, shifts and times
  VecX dx;
  double dmultiplier = 0;
  double share = 1;  ///< of both that can be believed
};
/// Of a body at (x, multiplier) to a change of its load; `edges`: each node's shortest, m. `fresh` as above. Fails
/// where there is no tangent, or no finite answer.
FirstOrderAnswer first_order_answer(const ConstrainedEnergy& problem, NewtonWorkspace& workspace,
                                    const VecX& x, double multiplier, const VecX& load,
                                    const std::vector<double>& edges, bool fresh);

}  // namespace calot
