// What the demos of our exercises stand for besides the expert's: each error is an event and costs the exercise, and
// who bails out does well exactly where the tissue does not yield.

#include <gtest/gtest.h>

#include "app/play.h"
#include "session/progress.h"
#include "support/long_run.h"
#include "support/paths.h"

namespace calot {
namespace {

struct Happens {
  const char* event;
  const char* organ;  ///< empty: any
};

struct Told {
  const char* name;
  const char* scenario;
  std::map<std::string, std::string> params;
  bool passes;
  std::vector<Happens> happens;
  std::vector<Happens> does_not;
  bool is_long = false;  ///< takes half a minute: left to long runs
};

void PrintTo(const Told& told, std::ostream* out) { *out << told.name; }

class Demo : public ::testing::TestWithParam<Told> {};
INSTANTIATE_TEST_SUITE_P(
    Told, Demo,
    ::testing::Values(Told{"ClumsyFromExposureOn",
                           "critical_view",
                           {{"demo", "clumsy"}},
                           false,
                           {{"perforation", "gallbladder"},
                            {"bile_leak", "gallbladder"},
                            {"injury", "common_duct"},
                            {"clip_dropped", ""},
                            {"cut_unclipped", "cystic_duct"}},
                           {{"time_out", ""}}},
                      Told{"ClumsyDuct",
                           "clip_and_divide",
                           {{"demo", "clumsy"}},
                           false,
                           {{"cut_unclipped", "cystic_duct"}, {"clip_dropped", ""}, {"bile_leak", ""}},
                           {{"time_out", ""}}},
                      Told{"ClumsyArtery",
                           "clip_and_divide",
                           {{"demo", "clumsy"}, {"structure", "cystic_artery"}},
                           false,
                           {{"cut_unclipped", "cystic_artery"}, {"bleeding", ""}},
                           {{"bile_leak", ""}}},
                      Told{"HastyDissection",
                           "dissect_to_critical_view",
                           {{"demo", "clumsy"}},
                           false,
                           {{"dry_activation", ""}},
                           {{"parted", "artery_fat"}},
                           true},
                      Told{"BailsOutOfTissueThatYields",
                           "dissect_to_critical_view",
                           {{"demo", "bail_out"}},
                           false,
                           {{"bail_out", ""}, {"divided", "artery_fat"}},
                           {{"parted", "artery_fat"}},
                           true},
                      Told{"BailsOutOfAFrozenTriangle",
                           "dissect_to_critical_view",
                           {{"demo", "bail_out"}, {"field", "frozen"}},
                           true,
                           {{"bail_out", ""}, {"activation", ""}},
                           {{"divided", ""}},
                           true},
                      Told{"TriesOnInAFrozenTriangle",
                           "dissect_to_critical_view",
                           {{"field", "frozen"}},
                           false,
                           {{"activation", ""}, {"step_timeout", ""}},
                           {{"bail_out", ""}, {"parted", ""}},
                           true}),
    [](const ::testing::TestParamInfo<Told>& one) { return one.param.name; });

bool has(const Progress& progress, const Happens& wanted) {
  for (const SessionEvent& event : progress.events())
    if (is_event(event, wanted.event, wanted.organ)) return true;
  return false;
}

TEST_P(Demo, IsToldByItsEventsAndItsScore) {
  const Told& told = GetParam();
  if (told.is_long && !test::long_run()) GTEST_SKIP() << "plays for half a minute";
  PlayRequest request;
  request.scenario = source_dir() + "/scenarios/" + told.scenario + ".lua";
  request.params = told.params;
  request.render = false;
  request.threads = 2;
  const Result<Played> played = play(request);
  ASSERT_TRUE(played) << to_text(played.failure());
  EXPECT_NE(played->session.end, SessionEnd::failed) << to_text(played->session.failure);
  for (const Happens& wanted : told.happens)
    EXPECT_TRUE(has(played->session.progress, wanted)) << "no " << wanted.event << " of " << wanted.organ;
  for (const Happens& unwanted : told.does_not)
    EXPECT_FALSE(has(played->session.progress, unwanted)) << unwanted.event << " of " << unwanted.organ;
  EXPECT_EQ(played->report.score.passed, told.passes) << played->report.score.total;
  if (told.passes)
    EXPECT_GT(played->report.score.total, 95);
  else
    EXPECT_LT(played->report.score.total, played->exercise.score.pass);
}

}  // namespace
}  // namespace calot
