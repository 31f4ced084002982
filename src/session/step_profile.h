#pragma once
// What each step of a session took: a table and a plot, for who looks for what makes steps long.

#include <string>
#include <vector>

#include "tools/step_report.h"

namespace calot {

struct ProfiledStep {
  double time = 0;    ///< s, at the step's end
  double wall_s = 0;  ///< inside World::step
  SolveStatistics statistics;
  std::vector<WorldEvent> events;
};

/// Of the wall times of steps: a quantile is the least time that so many of them do not exceed. 0 without steps.
struct StepTimes {
  double median = 0, p90 = 0, p99 = 0, longest = 0;  ///< s
  int over_time = 0;                                 ///< steps that took longer than they last
};
/// `step`: s that each lasts.
StepTimes step_times(std::vector<double> wall_s, double step);

/// RFC 4180, a row a step: time_s, wall_ms, parts, solves, newton_steps, factorisations, shifts, friction_rounds, trials (by
/// tool: its jaws' angles), cut_short_at (how far from balance a step was that had spent its budget or found none, 0: not at all; else empty), assembly_ms, factorisation_ms, solve_ms, contact_ms, extension_ms (in it is time that
/// the four before count, too), other_ms (wall_ms less those four), furthest (Newton steps by what was furthest from balance), events. Lists are as "left 12; right 3".
std::string profile_csv(const std::vector<ProfiledStep>& steps);

/// SVG: the time of each step on a logarithmic scale, over the session's, with the time that a step lasts (s) as a line.
std::string profile_plot(const std::vector<ProfiledStep>& steps, double step);

}  // namespace calot
