#include "group/equilibrium.h"

#include <algorithm>

#include "group/staged.h"

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
  const auto forget_margins = [&] {
    for (const Member& member : members) {
      member.search.margin = contact_margin;
      member.search.held_up = false;
    }
  };
  forget_margins();
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
      moved |= (member.state.x - before[k]).lpNorm<Eigen::Infinity>() > options.gets_nowhere;
      moved |= member.search.widen();
      // Walls that met without couplings in the matrix have them in the next round.
      moved |= member.search.own.lacking();
    }
    for (const JoinPointer& join : joins) moved |= join->lacking();
    const bool cut_short =
        result.status == NewtonStatus::stalled || result.status == NewtonStatus::iteration_limit;
    if (!cut_short || !moved) break;
  }
  forget_margins();
  return total;
}

namespace {

/// Mean stiffness at a node, N/m; of what has a mass that which lets it fall for 20 ms where `first` of it holds it back.
double sinking_stiffness(const Member& member, double first) {
  constexpr double time = 0.02;  // s
  if (const BlockMatrix* mass = member.body.mass()) return mass->diagonal_mean() / (time * time) / first;
  BlockMatrix matrix = member.body.pattern();
  member.body.add_hessian(member.state.x, matrix, member.assembly);
  return matrix.diagonal_mean();
}

}  // namespace

NewtonResult sink(std::span<const Member> members, std::span<const JoinPointer> joins,
                  GroupPatterns& patterns, const NewtonSettings& settings, NewtonWorkspace& work,
                  const SettleOptions& options) {
  constexpr int most_steps = 100;
  // Of the stiffness: the first step is a small one, the last spring is felt no more.
  constexpr double first = 1e-2, last = 1e-7, weaken = 0.25;
  std::vector<double> stiffness;
  std::vector<ContactLoads> loads;
  for (const Member& member : members) {
    stiffness.push_back(sinking_stiffness(member, first));
    loads.push_back(member.loads);
  }
  std::vector<Member> held;
  for (std::size_t k = 0; k < members.size(); ++k)
    held.push_back({members[k].body, loads[k], members[k].search, members[k].state, members[k].assembly});
  NewtonResult total;
  double share = first;
  for (int step = 0; step < most_steps && total.iterations < settle_iterations; ++step) {
    for (std::size_t k = 0; k < held.size(); ++k) loads[k].drag = Drag{held[k].state.x, share * stiffness[k]};
    work.factored = false;
    const NewtonResult result = settle(held, joins, patterns, settings, work, options);
    total.add(result);
    if (!result.converged()) break;
    bool stays = share <= last;
    for (const Member& member : held)
      stays &= member.body.largest_motion(member.state.x - member.loads.drag->from) <=
               settings.tolerance * member.body.size();
    if (stays) return total;
    share = std::max(last, weaken * share);
  }
  if (total.converged()) total.status = NewtonStatus::iteration_limit;
  return total;
}

NewtonResult sink(const Member& member, const NewtonSettings& settings, NewtonWorkspace& work,
                  const SettleOptions& options) {
  GroupPatterns none;
  return sink({&member, 1}, {}, none, settings, work, options);
}

NewtonResult settle(const Member& member, const NewtonSettings& settings, NewtonWorkspace& work,
                    const SettleOptions& options) {
  GroupPatterns none;
  return settle({&member, 1}, {}, none, settings, work, options);
}

}  // namespace calot
