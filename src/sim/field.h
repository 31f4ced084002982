#pragma once
// Organs, tools and what carries them, and the equilibrium of all organs where the tools stand.

#include <optional>
#include <string>
#include <vector>

#include "sim/organ.h"
#include "sim/step_report.h"
#include "sim/tool.h"

namespace calot {

/// What the laparoscope looks at from near by.
struct ViewedPlace {
  int organ = 0, skin_point = 0;
};

struct Field {
  std::vector<Organ> organs;
  std::vector<Tool> tools;
  std::optional<Plane> support;
  double support_friction = 0;  ///< Coulomb's
  Barrier barrier = contact_barrier;
  double tolerance = 1e-6;
  std::optional<ViewedPlace> viewed;
  ExtensionScheme scheme = ExtensionScheme::condensed;
};

std::vector<InstrumentPose> present_poses(const Field& field);

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
