#pragma once
// Equilibrium of bodies against their liquids, their beds, each other, the shapes that touch them and the grips that
// hold them.
//
// Converged, everywhere, body by body: largest nodal residual / largest internal nodal force and last increment /
// body's size both at most `tolerance` (a scenario's solver.tolerance), volumes kept to 1e-10 of themselves.

#include "anatomy/definitions.h"
#include "group/group_problem.h"
#include "numerics/newton.h"

namespace calot {

/// No equilibrium takes more Newton iterations, whatever its rounds: one that needs them is blocked.
inline constexpr int settle_iterations = 1000;

/// Newton's method, once, from the members' states, which receive the result; on failure they hold the last iterate.
NewtonResult solve(const GroupProblem& problem, const NewtonSettings& settings, NewtonWorkspace& work);

/// How an equilibrium is looked for.
struct SettleOptions {
  bool fixed_pressures = false;  ///< liquids keep their pressures, not their volumes
  ExtensionScheme scheme = ExtensionScheme::condensed;
  /// m: a solve that is broken off and moves no coordinate by more than this gets nowhere.
  double gets_nowhere = 1e-3 * contact_margin;
};

/// Equilibrium under loads that stand still, however far from the members' states it is: where a solve ends at the
/// margin, the next goes on from there with fresh pairs, always downhill. On failure the states hold the last iterate.
/// Counts of all rounds.
NewtonResult settle(std::span<const Member> members, std::span<const JoinPointer> joins,
                    GroupPatterns& patterns, const NewtonSettings& settings, NewtonWorkspace& work,
                    const SettleOptions& options = {});
/// The same of bodies that nothing holds, or not in every direction: they are let sink, each step held back by springs
/// from where it was, which weaken, until it moves no more (the proximal point method). On failure the state holds the
/// last iterate.
NewtonResult sink(std::span<const Member> members, std::span<const JoinPointer> joins,
                  GroupPatterns& patterns, const NewtonSettings& settings, NewtonWorkspace& work,
                  const SettleOptions& options = {});
NewtonResult sink(const Member& member, const NewtonSettings& settings, NewtonWorkspace& work,
                  const SettleOptions& options = {});
/// Of a body alone.
NewtonResult settle(const Member& member, const NewtonSettings& settings, NewtonWorkspace& work,
                    const SettleOptions& options = {});

}  // namespace calot
