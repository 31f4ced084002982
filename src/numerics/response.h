#pragma once
// What bodies in equilibrium do when their load changes a little.

#include "numerics/body_energy.h"
#include "numerics/newton_result.h"
#include "numerics/newton_workspace.h"

namespace calot {

/// First-order response to a change of load with the last factor: K dx = load, constraints kept to first
/// order but for their compliances. `dmultipliers` receives their multipliers' changes. `values`: by how much the
/// constraints are not met before; empty: they are. Needs workspace.factored.
VecX linear_response(const NewtonWorkspace& workspace, const VecX& load, VecX& dmultipliers,
                     const VecX& values = {});

/// Factorises the tangent at (x, multipliers) into the workspace, for linear_response; unless `fresh`, a last
/// factor that can serve is kept. Of the result only status, part, shifts and times have a meaning.
NewtonResult factorise_tangent(const ConstrainedEnergy& problem, NewtonWorkspace& workspace, const VecX& x,
                               const VecX& multipliers, bool fresh);
NewtonResult factorise_tangent(const BodyEnergy& body, NewtonWorkspace& workspace, const VecX& x,
                               double multiplier, bool fresh);

/// No node of a first-order answer is believed further than this share of its shortest edge.
inline constexpr double answer_edge_share = 0.5;

struct FirstOrderAnswer {
  NewtonResult result;  ///< status, part, shifts and times
  VecX dx;
  VecX dmultipliers;
  double share = 1;  ///< of both that can be believed
  /// Of a body alone; 0 where it is not constrained.
  double dmultiplier() const { return dmultipliers.size() > 0 ? dmultipliers[0] : 0; }
};
/// Of bodies at (x, multipliers) to a change of their load; `edges`: each node's shortest, m; `fresh` and `values` as
/// above. Fails where there is no tangent, or no finite answer.
FirstOrderAnswer first_order_answer(const ConstrainedEnergy& problem, NewtonWorkspace& workspace,
                                    const VecX& x, const VecX& multipliers, const VecX& load,
                                    const std::vector<double>& edges, bool fresh, const VecX& values = {});
FirstOrderAnswer first_order_answer(const BodyEnergy& body, NewtonWorkspace& workspace, const VecX& x,
                                    double multiplier, const VecX& load, const std::vector<double>& edges,
                                    bool fresh);

}  // namespace calot
