#pragma once
// Motion, force and organ metrics of a session, and their names. A name carries its unit.
//
// Per instrument (p tip, u unit shaft axis, d insertion, psi roll; all from processed motion, see trace.h):
//   path_length_mm            sum |dp|
//   time_s                    from the first movement to the last (movement: not idle)
//   idle_time_s               time at less than 5 mm/s, counted where it lasts 0.5 s or more
//   economy                   sum of straight legs / path length, 0 to 1; a leg ends at each grasp, release
//                             and step
//   depth_perception_mm       sum |dd|
//   angular_path_deg          sum of the angle between u and the next u
//   response_orientation_deg  sum |dpsi|
//   peak_force_N, mean_force_N (of the samples above 1 mN), peak_handle_force_N: raw, not smoothed
//   grasps, releases, slips   counts of events
// Per organ: peak_pressure_Pa, max_stretch (largest principal stretch of the wall), lowest_frequency_Hz (at rest,
// bile included: shaking below a third of it may be treated as static). Of one that is compared with another, when the
// session ends: mean_difference_pct, largest_difference_pct (session/skin_difference.h).
// Per hold: <step>.<hold>.time_in_s, set by the script. Per step: <step>.time_s. total.time_s.

#include <map>
#include <string>
#include <vector>

#include "session/exercise.h"
#include "session/progress.h"
#include "session/trace.h"

namespace calot {

/// Every metric a session of this scene can measure; `holds` are "step.hold".
std::vector<std::string> metric_names(const SceneDefinition& scene, const std::vector<std::string>& steps,
                                      const std::vector<std::string>& holds);

/// Metrics by name. What could not be measured (the economy of an instrument that never moved, the time of a
/// step that was never reached) is absent.
std::map<std::string, double> measure(const SceneDefinition& scene, const Traces& traces,
                                      const Progress& progress);

}  // namespace calot
