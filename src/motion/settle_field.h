#pragma once
// What acts on the organs of a field, and their equilibrium where the tools stand.

#include <string>

#include "field/field.h"

namespace calot {

/// What acts on an organ when the tools stand at `poses`: the tools' shapes first, three each, then the
/// ground; the springs of what they hold; and friction as it was at the last equilibrium.
ContactLoads contact_loads(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses);

/// The same for a solve: with the organ's inertia in the part of a motion that it is in, if any.
ContactLoads solve_loads(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses);
/// Those of all organs.
std::vector<ContactLoads> solve_loads(const Field& field, const std::vector<InstrumentPose>& poses);

/// How the field's bodies are solved for; a solve ends (stopped) as soon as the field is, or after so many iterations.
NewtonSettings solver_settings(const Field& field, int iterations);

/// Adds a solve's counts and times.
void count(const Field& field, const NewtonResult& result, SolveStatistics& statistics);

/// What such a group's part is called, the tissues behind the organs.
std::string member_name(const Field& field, int part);
/// All joins of the field's group: organs', then tissues', with the tools at `poses`.
std::vector<JoinPointer> all_joins(const Field& field, const std::vector<InstrumentPose>& poses);

/// The organs as members of one group under `loads`, one an organ.
std::vector<Member> members_of(Field& field, const std::vector<ContactLoads>& loads);

/// The way of the tool that travels most from where it stands, m.
double largest_travel(const Field& field, const std::vector<InstrumentPose>& to);

/// Brings the organs to rest, or to the end of the part of a motion that they are in, with the tools at `poses`; on failure they are left at the last iterate. `before`, one an
/// organ, is where they were at their last equilibrium, tools as field.tools stand: friction resists what moved since,
/// and details fade as far as the tools travel from there.
NewtonResult settle_group(Field& field, const std::vector<InstrumentPose>& poses,
                          const std::vector<VecX>& before, int max_iterations, SolveStatistics& statistics);
/// Brings the bodies along to `poses` on the way through a step where masses count: by Newton steps until one moves none by
/// more than the rest of the way takes along, or no more may be begun (step_budget.h). What rubs is held as it was found
/// last. The states hold the last iterate, which may stay where the result converged or reached its limit of iterations.
NewtonResult bring_along(Field& field, const std::vector<InstrumentPose>& poses, SolveStatistics& statistics);
/// Balances to the field's tolerance what was solved roughly until now, nothing rubbing otherwise. Where that fails all
/// stays as it is, and the step is one that was cut short.
void end_in_balance(Field& field, SolveStatistics& statistics);

/// Lets organs that nothing holds sink to rest with no tool near (equilibrium.h); they rest without friction. As a scene
/// begins: that it has no rest is the scene's fault (scenario), at the organ.
Result<bool> sink_field(Field& field, SolveStatistics& statistics);

/// Whether a solve of the group ended because the step's budget was spent (step_budget.h): its members are left at the
/// last iterate, from where the next step goes on.
bool was_cut_short(const Field& field, const NewtonResult& result);
/// The same, or, where masses count, that it found no balance but left its members at a state that may be kept.
bool may_end_so(const Field& field, const NewtonResult& result);

/// Brings every organ to rest with the tools as they stand, or as far as the step's budget goes. `when` is for the failure's text (simulation);
/// organs are then left as the solves left them.
Result<bool> settle_field(Field& field, const std::string& when, SolveStatistics& statistics);
/// The same as a scene begins: a rest that is not found is the scene's fault (scenario), at the organ.
Result<bool> settle_at_rest(Field& field, SolveStatistics& statistics);
/// settle_field() within a step. Where masses count, one that finds no balance is a step that was cut short: all stays where the
/// last iterate left it, and inertia carries it on.
Result<bool> settle_in_step(Field& field, const std::string& when, SolveStatistics& statistics);

}  // namespace calot
