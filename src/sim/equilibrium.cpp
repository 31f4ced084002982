#include "sim/equilibrium.h"

#include <algorithm>

#include "sim/staged.h"

namespace calot {

NewtonResult solve(const GroupProblem& problem, const NewtonSettings& settings, NewtonWorkspace& work) {
  VecX x = problem.coordinates(), multipliers = problem.multipliers();
  const NewtonResult result = solve_equilibrium(problem, settings, work, x, multipliers);
  problem.keep(x, multipliers);
  return result;
}

namespace {

bool refined(std::span<const Member> members) {
  return std::any_of(members.begin(), members.end(),
                     [](const Member& member) { return !member.body.details().empty(); });
}

}  // namespace

NewtonResult settle(std::span<const Member> members, std::span<const JoinPointer> joins,
                    GroupPatterns& patterns, const NewtonSettings& settings, NewtonWorkspace& work,
                    const SettleOptions& options) {
  constexpr int max_rounds = 30;
  NewtonResult total;
  for (int round = 0; round < max_rounds && total.iterations < settle_iterations; ++round) {
    std::vector<VecX> before;
    for (const Member& member : members) before.push_back(member.state.x);
    const bool staged = options.scheme == ExtensionScheme::staged && refined(members);
    const NewtonResult result =
        staged ? solve_in_stages(members, joins, patterns, settings, work)
               : solve(GroupProblem(members, joins, patterns, options.fixed_pressures), settings, work);
    total.add(result);
    bool moved = false;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const Member& member = members[k];
      moved |= (member.state.x - before[k]).lpNorm<Eigen::Infinity>() > 1e-3 * contact_margin;
      // Walls that met without couplings in the matrix have them in the next round.
      moved |= member.search.own.lacking();
    }
    const bool cut_short =
        result.status == NewtonStatus::stalled || result.status == NewtonStatus::iteration_limit;
    if (!cut_short || !moved) break;
  }
  return total;
}

NewtonResult sink(const Member& member, const NewtonSettings& settings, NewtonWorkspace& work,
                  const SettleOptions& options) {
  constexpr int most_steps = 100;
  // Of the mean stiffness at a node: the first step is a small one, the last spring is felt no more.
  constexpr double first = 1e-2, last = 1e-7, weaken = 0.25;
  BlockMatrix matrix = member.body.pattern();
  member.body.add_hessian(member.state.x, matrix);
  const double stiffness = matrix.diagonal_mean();
  ContactLoads loads = member.loads;
  const Member held{member.body, loads, member.search, member.state};
  NewtonResult total;
  double share = first;
  for (int step = 0; step < most_steps && total.iterations < settle_iterations; ++step) {
    loads.drag = Drag{member.state.x, share * stiffness};
    work.factored = false;
    const NewtonResult result = settle(held, settings, work, options);
    total.add(result);
    if (!result.converged()) break;
    const double way = member.body.largest_motion(member.state.x - loads.drag->from);
    if (share <= last && way <= settings.tolerance * member.body.size()) return total;
    share = std::max(last, weaken * share);
  }
  if (total.converged()) total.status = NewtonStatus::iteration_limit;
  return total;
}

NewtonResult settle(const Member& member, const NewtonSettings& settings, NewtonWorkspace& work,
                    const SettleOptions& options) {
  GroupPatterns none;
  return settle({&member, 1}, {}, none, settings, work, options);
}

}  // namespace calot
