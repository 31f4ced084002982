#pragma once
// What acts on the organs of a field, and their equilibrium where the tools stand.

#include <string>

#include "sim/field.h"

namespace calot {

/// What acts on an organ when the tools stand at `poses`: the tools' shapes first, three each, then the
/// support; the springs of what they hold; and friction as it was at the last equilibrium.
ContactLoads contact_loads(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses);

/// Adds a solve's counts and times.
void count(const NewtonResult& result, SolveStatistics& statistics);

/// Brings one organ to rest with the tools at `poses`; on failure it is left at the last iterate. `before` is
/// where it was at its last equilibrium, tools as field.tools stand: friction resists what moved since, and details
/// fade as far as the tools travel from there.
NewtonResult settle_organ(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                          const VecX& before, int max_iterations, SolveStatistics& statistics);

/// Brings every organ to rest with the tools as they stand. `when` is for the failure's text (simulation);
/// organs are then left as the solves left them.
Result<bool> settle_field(Field& field, const std::string& when, SolveStatistics& statistics);

}  // namespace calot
