// Rules, gates and acts of an exercise from its run to everything that is written of it.

#include <gmock/gmock.h>

#include "app/program.h"
#include "session/json.h"

namespace calot::test {
namespace {

using testing::HasSubstr;

/// The small exercise with a demo that stops once and then bails out, scored by a rule and behind a gate.
std::string ruled_scenario(const std::string& judge) {
  std::string text = small_scenario("t:step('move', 'Move about'); t:wait(2 * s)",
                                    "t:wait(0.1 * s); t:time_out('two, \"structures\"'); t:wait(0.1 * s); "
                                    "t:bail_out('subtotal')");
  const std::string part = "expert = 0 }, weight = 1 },";
  EXPECT_NE(text.find(part), std::string::npos);
  text.replace(
      text.find(part), part.size(),
      "expert = 0 }, weight = 0.5 },\n{ calot.score.rule(function(run)\n" + judge +
          "\nend), name = 'own', weight = 0.5 },\nbail_out_completes = true,\n"
          "gates = { { event = 'bail_out', cap = 30, fails = false, reason = '<b>given</b> up' } },");
  return text;
}

class RuledProgram : public ProgramTest {};

TEST_F(RuledProgram, ItsReasonsAreInReportScoreTableAndPage) {
  spill(folder_ / "small.lua",
        ruled_scenario(
            "return 1, '<i>' .. run:count('time_out') .. ' time-out, as asked', run:times('time_out')"));
  const Outcome run = calot({"run", "small.lua", "--no-render", "-o", "out"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("<i>1 time-out, as asked"));
  EXPECT_THAT(run.out, HasSubstr("<b>given</b> up (1 x bail_out at 0.2"));
  const Json report = Json::parse(slurp(folder_ / "out" / "report.json"));
  EXPECT_EQ(report["end"], "bail_out");
  EXPECT_EQ(report["events"][0]["text"], "two, \"structures\"");
  EXPECT_EQ(report["score"]["parts"][1]["explanation"], "<i>1 time-out, as asked");
  EXPECT_EQ(report["score"]["parts"][1]["event_times_s"].size(), 1u);
  EXPECT_EQ(report["score"]["gates"][0]["found"], "1 x bail_out");
  EXPECT_EQ(report["score"]["total"], 30);
  EXPECT_EQ(report["score"]["completed"], true);
  EXPECT_THAT(slurp(folder_ / "out" / "events.csv"),
              HasSubstr(",time_out,move,,,,,,,,,\"two, \"\"structures\"\"\"\r\n"));
  // From what the recording holds, and played again.
  for (const char* how : {"--json", "--replay"}) {
    const Json entry = Json::parse(calot({"score", "small.lua", "out", "--json", how}).out)["recordings"][0];
    EXPECT_EQ(entry["score"], report["score"]) << how;
    EXPECT_EQ(entry["whole"], true) << "a bail-out is an end";
  }
  EXPECT_THAT(calot({"score", "small.lua", "out", "--csv"}).out, HasSubstr("\"<i>1 time-out, as asked\""));
  ASSERT_EQ(calot({"page", "out", "--no-pictures", "-o", "page.html"}).code, 0);
  const std::string html = slurp(folder_ / "page.html");
  EXPECT_THAT(html, HasSubstr("&lt;i&gt;1 time-out, as asked"));
  EXPECT_THAT(html, HasSubstr("<strong>&lt;b&gt;given&lt;/b&gt; up</strong> (1 x bail_out)"));
  EXPECT_THAT(html, HasSubstr("subtotal"));
}

TEST_F(RuledProgram, ARulesErrorIsAnAuthorsErrorAndTheRecordingIsKept) {
  const std::string text =
      ruled_scenario("if run:count('bail_out') > 0 then error('no luck') end\nreturn 1, 'x'");
  spill(folder_ / "small.lua", text);
  const std::string line = std::to_string(
      1 + std::count(text.begin(), text.begin() + static_cast<long>(text.find("no luck")), '\n'));
  const Outcome run = calot({"run", "small.lua", "--no-render", "-o", "out"});
  EXPECT_EQ(run.code, 6);
  EXPECT_THAT(run.err, HasSubstr("small.lua:" + line + ": no luck"));
  const Outcome scored = calot({"score", "small.lua", "out"});
  EXPECT_EQ(scored.code, 6);
  EXPECT_THAT(scored.err, HasSubstr("small.lua:" + line + ": no luck"));
  spill(folder_ / "small.lua", ruled_scenario("return 1, 'mended'"));
  EXPECT_EQ(calot({"score", "small.lua", "out"}).code, 0) << "what was recorded is not lost";
}

}  // namespace
}  // namespace calot::test
