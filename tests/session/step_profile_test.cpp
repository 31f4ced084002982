// What steps took: quantiles, the table and the plot.

#include "session/step_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace calot {
namespace {

using testing::HasSubstr;

TEST(StepTimes, AQuantileIsTheLeastTimeThatSoManyStepsDoNotExceed) {
  std::vector<double> times(200);
  std::iota(times.begin(), times.end(), 1);  // s
  std::reverse(times.begin(), times.end());
  const StepTimes found = step_times(times, 150);
  EXPECT_EQ(found.median, 100);
  EXPECT_EQ(found.p90, 180);
  EXPECT_EQ(found.p99, 198);
  EXPECT_EQ(found.longest, 200);
  EXPECT_EQ(found.over_time, 50) << "150 s are in time";
  EXPECT_EQ(step_times({3}, 3).median, 3);
  EXPECT_EQ(step_times({}, 1).longest, 0);
}

std::vector<ProfiledStep> two_steps() {
  ProfiledStep still{0.02, 1e-5, {}, {}};
  ProfiledStep cut{0.04, 0.5, {}, {}};
  cut.statistics.newton_iterations = 40;
  cut.statistics.factorisations = 55;
  cut.statistics.assembly_s = 0.2;
  cut.statistics.solve_s = 0.1;
  cut.statistics.jaw_trials = {{"left", 3}, {"right", 12}};
  cut.statistics.furthest = {{"plate", 30}, {"duct", 10}};
  WorldEvent event;
  cut.statistics.cut_short = true;
  cut.statistics.residual = 2e-3;
  event.kind = EventKind::cut;
  event.instrument = "blades";
  cut.events = {event};
  return {still, cut};
}

TEST(StepProfile, HasARowAStepWithWhatFilledIt) {
  const std::string csv = profile_csv(two_steps());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_THAT(
      csv, HasSubstr("0.04,500.000,0,0,40,55,0,0,right 12; left 3,0.002,200.000,0.000,100.000,0.000,0.000,200.000,"
                     "plate 30; duct 10,cut blades\r\n"));
  std::vector<std::ptrdiff_t> commas;
  for (std::size_t at = 0; at < csv.size(); at = csv.find('\n', at) + 1)
    commas.push_back(std::count(csv.begin() + static_cast<std::ptrdiff_t>(at),
                                csv.begin() + static_cast<std::ptrdiff_t>(csv.find('\n', at)), ','));
  EXPECT_EQ(commas, std::vector<std::ptrdiff_t>(3, commas[0]));
}

TEST(StepProfile, ItsPlotReachesTheLongestStepAndShowsWhatAStepLasts) {
  const std::string plot = profile_plot(two_steps(), 0.02);
  EXPECT_THAT(plot, HasSubstr("as long as it lasts"));
  EXPECT_THAT(plot, HasSubstr(">1000<")) << "half a second lies below the power of ten";
  EXPECT_EQ(plot.find("nan"), std::string::npos);
  EXPECT_EQ(plot.find("inf"), std::string::npos);
  EXPECT_EQ(profile_plot({}, 0.02), "");
}

}  // namespace
}  // namespace calot
