// Organs that come, go and are divided by a scenario's steps.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lua/scenario_files.h"
#include "session/metrics.h"
#include "session/runner.h"

namespace calot {
namespace {

using test::Folder;

/// A duct held at its end, a stone tied to its start, far from all instruments, where masses count.
test::ScenarioText ducts(const std::string& steps) {
  test::ScenarioText text;
  text.scene =
      "return { anatomy = { organs = {\n"
      "  { name = 'duct', shape = { type = 'tube', points = { { 0, 0, -200 * mm }, { 40 * mm, 0, -200 * mm } "
      "} },\n"
      "    wall = { density = 1050 }, held = { { landmark = 'end', radius = 5 * mm, stiffness = 1e6 } } },\n"
      "  { name = 'stone', shape = { type = 'rigid', centre = { -3 * mm, 0, -200 * mm }, rounding = 3 * mm } "
      "} },\n"
      "  joints = { { from = 'duct.start', to = 'stone.centre' } } },\n"
      "laparoscope = { look_at = 'duct.end' }, solver = { motion = 'dynamic' },\n"
      "instruments = { left = { port = 'right_subcostal' } } }";
  text.steps = steps;
  text.demo = "t:wait(0.4 * s)";
  return text;
}

struct Outcome {
  std::string why;  ///< it failed; empty: it did not
  SessionResult result;
  std::vector<std::string> organs;  ///< at the end
};

/// Loaded, and played where that succeeds.
Outcome outcome(const test::ScenarioText& text) {
  const Folder folder;
  Result<std::unique_ptr<ExerciseScript>> script = test::load_text(folder, text.text());
  if (!script) return {to_text(script.failure()), {}, {}};
  World world = World::create(script.value()->definition().scene).value();
  Outcome out;
  out.result = run_session(world, *script.value(), script.value()->demo(), {});
  if (out.result.end == SessionEnd::failed) out.why = to_text(out.result.failure);
  for (const OrganState& organ : world.report().organs) out.organs.push_back(organ.name);
  return out;
}

TEST(ChangingOrgansInSteps, AreDividedRemovedTiedAndAdded) {
  const Outcome played = outcome(ducts(
      "t:step('cut', 'Cut')\n t:wait(0.06 * s)\n"
      "local patient, specimen, share = t:divide('duct', 0.5)\n"
      "assert(patient == 'duct.patient' and specimen == 'duct.specimen' and math.abs(share - 0.5) < 0.04)\n"
      "assert(math.abs(t:place('duct.patient.start')[1] - 20 * mm) < 10 * mm)\n"
      "t:untie('duct.specimen', 'stone')\n"
      "t:tie { from = 'duct.specimen.end', to = 'duct.patient.end', stiffness = 100 }\n"
      "t:wait(0.04 * s)\n t:remove('stone', 'taken out')\n"
      "t:add { name = 'other', shape = { type = 'rigid', centre = { 0, 40 * mm, -200 * mm } } }\n"
      "t:wait(0.04 * s)"));
  EXPECT_EQ(played.why, "");
  EXPECT_EQ(played.result.end, SessionEnd::steps_done);
  EXPECT_EQ(played.organs, (std::vector<std::string>{"duct.patient", "duct.specimen", "other"}));
}

TEST(ChangingOrgansInSteps, AreReleasedBoundByTissueAndOpened) {
  const Outcome played = outcome(
      ducts("t:step('cut', 'Cut')\n t:wait(0.04 * s)\n"
            "t:add_tissue { name = 'bands', from = 'duct', to = 'stone', within = 20 * mm, strands = 8,\n"
            "  break_energy = 2000 }\n"
            "assert(t:torn('bands') == 0)\n"
            "local share = t:bleed('duct', 0.5, 2 * mm)\n"
            "assert(math.abs(share - 0.5) < 0.1)\n"
            "t:wait(0.04 * s)\n assert(t:lost('bile', 'duct') > 0 and t:count('bile_leak', 'duct') == 1)\n"
            "t:remove_tissue('bands')\n assert(t:torn('bands') == 1)\n"
            "local from = t:place('duct.end')\n"
            "t:release('duct', 'bed')\n t:wait(0.1 * s)\n"
            "assert(t:place('duct.end')[3] < from[3] - 5 * mm)"));
  EXPECT_EQ(played.why, "");
  EXPECT_EQ(played.result.end, SessionEnd::steps_done);
}

TEST(ChangingOrgansInSteps, WhatCannotBeReleasedOrBoundIsSaidByCheck) {
  for (const auto& [use, text] : std::vector<std::pair<std::string, std::string>>{
           {"t:release('duct', 'hand')", "nothing called \"hand\" holds 'duct'"},
           {"t:release('stone', 'bed')", "nothing holds it"},
           {"t:add_tissue { name = 'bands', from = 'duct', to = 'stones' }", "unknown organ \"stones\""},
           {"t:add_tissue { name = 'duct', from = 'duct', to = 'stone' }", "an organ is called \"duct\" too"},
           {"t:remove_tissue('bands')", "unknown tissue \"bands\""},
           {"t:bleed('stone', 0.5)", "'stone' cannot be opened"},
           {"t:bleed('duct', 0.5, 0)", "width"}}) {
    const std::string why = outcome(ducts("t:step('cut', 'Cut')\n" + use)).why;
    EXPECT_NE(why.find(text), std::string::npos) << use << ": " << why;
  }
}

TEST(ChangingOrgansInSteps, WhatIsDoneTwiceIsRefusedWithWhatCameOfTheFirst) {
  for (const auto& [act, text] : std::vector<std::pair<std::string, std::string>>{
           {"t:release('duct', 'bed')", "\"bed\" has let go of 'duct' already"},
           {"t:remove_tissue('bands')", "bands was removed at"},
           {"t:bleed('duct', 0.5)", "'duct' is open already at 0.5"}}) {
    const std::string why =
        outcome(
            ducts(
                "t:step('cut', 'Cut')\n t:wait(0.04 * s)\n"
                "t:add_tissue { name = 'bands', from = 'duct', to = 'stone', within = 20 * mm, strands = 8,\n"
                "  break_energy = 2000 }\n" +
                act + "\n t:wait(0.04 * s)\n" + act))
            .why;
    EXPECT_NE(why.find(text), std::string::npos) << act << ": " << why;
  }
  const std::string why =
      outcome(ducts("t:step('cut', 'Cut')\n"
                    "t:add { name = 'b', shape = { type = 'rigid', path = 'b.obj', scale = 1e-3 } }"))
          .why;
  EXPECT_NE(why.find("what steps add is read from no mesh file"), std::string::npos) << why;
}

TEST(ChangingOrgansInSteps, AreClippedAndCutInAFieldThatIsPrepared) {
  const Outcome played = outcome(ducts(
      "t:step('prepared', 'Prepared')\n"
      "for _, share in ipairs { 0.2, 0.3 } do t:clip('duct', share, 'M') end\n"
      "t:clip('duct', 0.6)\n t:divide('duct', 0.45)\n"
      "local first, second = t:clips('duct.specimen'), t:clips('duct.patient')\n"
      "assert(#first == 2 and first[1].size == 'M' and first[1].opening == 0)\n"
      "assert(math.abs(first[1].place - 0.2 / 0.45) < 0.05 and math.abs(first[2].place - 0.3 / 0.45) < "
      "0.05)\n"
      "assert(#second == 1 and second[1].size == 'ML' and math.abs(second[1].place - 0.15 / 0.55) < 0.05)\n"
      "assert(t:count('clip') == 0 and t:count('cut') == 0)\n"
      "t:wait(0.04 * s)"));
  EXPECT_EQ(played.why, "");
  EXPECT_EQ(played.result.end, SessionEnd::steps_done);
}

TEST(ChangingOrgansInSteps, WhatIsCutOffFallsWithItsStone) {
  // Half a metre away the stone's coordinates are rounded to 1e-16 m: times its stiffness, 1e-4 of its weight.
  const Outcome played = outcome(ducts(
      "t:step('cut', 'Cut')\n t:divide('duct', 0.45)\n"
      "local from = t:place('stone.centre')\n"
      "t:wait(0.3 * s)\n"
      "local to = t:place('stone.centre')\n"
      "local fallen = math.sqrt((to[1] - from[1])^2 + (to[2] - from[2])^2 + (to[3] - from[3])^2)\n"
      // Implicit Euler falls by g h^2 n (n + 1) / 2: in 14 steps 0.412 m; the piece swings about its stone, 18 mm long.
      "assert(math.abs(fallen - 0.412) < 0.018, fallen)"));
  EXPECT_EQ(played.why, "");
  EXPECT_EQ(played.result.end, SessionEnd::steps_done);
}

TEST(ChangingOrgansInSteps, PlayedTwiceHaveTheSameBits) {
  const test::ScenarioText text =
      ducts("t:step('cut', 'Cut') t:wait(0.04 * s) t:divide('duct', 0.5) t:wait(0.06 * s)");
  const std::vector<std::uint64_t> first = outcome(text).result.state_hashes;
  EXPECT_GT(first.size(), 4u);
  EXPECT_EQ(outcome(text).result.state_hashes, first);
}

TEST(ChangingOrgansInSteps, WhatIsGoneSaysWhenAndWhyAtTheAuthorsLine) {
  const std::string gone = "duct was divided at 0.06 s (its pieces are duct.patient and duct.specimen)";
  const std::string divided =
      "t:step('cut', 'Cut')\n t:wait(0.06 * s)\n t:divide('duct', 0.5) t:wait(0.04 * s)\n";
  for (const char* use : {"t:clips('duct')", "t:place('duct.start')", "t:divide('duct', 0.5)",
                          "t:remove('duct')", "t.left:holds('duct')", "t.left:distance('duct.end')"}) {
    const std::string why = outcome(ducts(divided + use)).why;
    EXPECT_NE(why.find(gone), std::string::npos) << use << ": " << why;
    EXPECT_NE(why.find(".lua:20: "), std::string::npos) << use << ": " << why;
  }
  const std::string why = outcome(ducts("t:step('cut', 'Cut')\n t:remove('stone', 'taken out')\n"
                                        "t:wait(0.04 * s) t:place('stone.centre')"))
                              .why;
  EXPECT_NE(why.find("stone was removed: taken out at 0.02 s"), std::string::npos) << why;
}

TEST(ChangingOrgansInSteps, WhereAClipLiesNoneIsSetAndNothingDivided) {
  for (const std::string again : {"t:clip('duct', 0.5)", "t:clip('duct', 0.51)", "t:divide('duct', 0.5)"}) {
    const Outcome played = outcome(ducts("t:step('a', 'A') t:clip('duct', 0.5) t:wait(0.04 * s)\n" + again));
    EXPECT_THAT(played.why, ::testing::HasSubstr("a clip lies there")) << again;
    EXPECT_THAT(played.why, ::testing::ContainsRegex(".lua:18: ")) << again;
  }
  for (const std::string beside : {"t:clip('duct', 0.3)", "t:divide('duct', 0.7)"})
    EXPECT_EQ(outcome(ducts("t:step('a', 'A') t:clip('duct', 0.5) t:wait(0.04 * s)\n" + beside)).why, "");
}

TEST(ChangingOrgansInSteps, MistakesAreFoundWithoutPlaying) {
  struct Case {
    const char *steps, *message;
  };
  for (const Case& mistake :
       {Case{"t:divide('dukt', 0.5)", "unknown organ \"dukt\" (did you mean \"duct\"?)"},
        Case{"t:divide('stone', 0.5)", "'stone' cannot be divided: its shape is \"rigid\""},
        Case{"t:divide('duct', 5)", "t:divide: share"}, Case{"t:clip('dukt', 0.5)", "unknown organ \"dukt\""},
        Case{"t:clip('stone', 0.5)", "'stone' cannot be clipped: its shape is \"rigid\""},
        Case{"t:clip('duct', 0.5, 'XL')", "XL"},
        Case{"t:divide('duct', 0.5) t:place('duct.patiant.end')", "\"duct.patient.end\""},
        Case{"t:wait_until(function() t:remove('stone') return true end)", "inside a predicate"},
        Case{"t:add { name = 'other', shape = { type = 'rigid', density = -1 } }", "organ.shape.density"},
        Case{"t:add { nmae = 'other' }", "unknown key"},
        Case{"t:tie { from = 'duct.start', to = 'stone.middle' }", "unknown landmark \"stone.middle\""},
        Case{"t:tie { from = 'duct.start' }", "\"to\" is missing"},
        Case{"t:untie('duct', 'stein')", "unknown organ \"stein\""}}) {
    const Folder folder;
    const Result<std::unique_ptr<ExerciseScript>> script =
        test::load_text(folder, ducts(std::string("t:step('a', 'A')\n") + mistake.steps).text());
    ASSERT_FALSE(script) << mistake.steps;
    EXPECT_EQ(script.failure().kind, FailureKind::scenario);
    const std::string why = to_text(script.failure());
    EXPECT_NE(why.find(mistake.message), std::string::npos) << why;
    EXPECT_NE(why.find(".lua:18: "), std::string::npos) << why;
  }
}

TEST(ChangingOrgansInSteps, PiecesHaveMetricsThatAScoreKnowsBeforeItIsPlayed) {
  test::ScenarioText text = ducts("t:step('cut', 'Cut') t:divide('duct', 0.5) t:wait(0.04 * s)");
  text.score =
      "calot.score.weighted { { calot.score.benchmark { metric = 'duct.specimen.max_stretch', novice = 2, "
      "expert = 1 }, weight = 1 } }";
  const Outcome played = outcome(text);
  EXPECT_EQ(played.why, "");
  ASSERT_GT(played.result.traces.organs.size(), 3u);
  EXPECT_EQ(played.result.traces.organ_names[3], "duct.specimen");
  EXPECT_FALSE(played.result.traces.organs[3].empty());
}

TEST(ChangingOrgansInDemo, ApproachPiecesThatStepsMake) {
  test::ScenarioText text = ducts("t:step('cut', 'Cut') t:divide('duct', 0.5) t:wait(0.04 * s)");
  text.demo = "t:wait(0.06 * s) t.left:approach('duct.patient.start')";
  EXPECT_EQ(outcome(text).why, "");
  // Also where the demo's places are tried in a world at rest.
  const Folder folder;
  const Result<std::unique_ptr<ExerciseScript>> script = test::load_text(folder, text.text());
  ASSERT_TRUE(script) << to_text(script.failure());
  const World world = World::create(script.value()->definition().scene).value();
  for (const Problem& problem : script.value()->rehearse(world)) ADD_FAILURE() << to_text(problem);
}

}  // namespace
}  // namespace calot
