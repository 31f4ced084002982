// What authors give to the functions of scripts/lua is refused at their line.

#include <gmock/gmock.h>

#include "lua/scenario_files.h"

namespace calot::module_errors_test {
namespace {

using test::Folder;
using test::line_of;
using test::load_text;
using test::ScenarioText;

Failure failure_of(const std::string& text) {
  const Folder folder;
  Result<std::unique_ptr<ExerciseScript>> loaded = load_text(folder, text);
  if (loaded) {
    ADD_FAILURE() << "loaded without a complaint:\n" << text;
    return {};
  }
  return loaded.failure();
}

/// A demo that does this, with the modules at hand.
ScenarioText with_modules(const std::string& demo) {
  ScenarioText text;
  text.demo = demo;
  text.head = "local technique, anatomy = require 'technique', require 'anatomy'\n";
  return text;
}

TEST(ModuleErrors, SayWhichArgumentIsWrongAndWhatItIsToBe) {
  for (const auto& [use, said] : std::vector<std::pair<std::string, std::string>>{
           {"technique.hand(t, 3, { 0, 0, 0 })", "technique.hand: name is a name in quotes, not 3"},
           {"technique.hand(t, 'left', { 0, 0, 0 / 0 })",
            "port is three numbers { x, y, z }, not this table"},
           {"technique.hand(t, 'left', { 0, 0, 0 }).about('duct', 'x', 0)",
            "left's hand.about: share is a share of a way, 0 to 1, not \"x\""},
           {"technique.hand(t, 'left', { 0, 0, 0 }).about('duct', 0.5, 5)", "(did you mean 5 * mm?)"},
           {"technique.hand(t, 'left', { 0, 0, 0 }).about('duct', 0.5, 0, 40)",
            "(did you mean 40 * mm / s?)"},
           {"technique.hand(t, 'left', { 0, 0, 0 }).set_clips('duct', {}, 1, 0)",
            "shares is a list of shares"},
           {"technique.hand(t, 'left', { 0, 0, 0 }):back(0.01)", "call it with a dot, not with a colon"},
           {"technique.hand(t, 'left', { 0, 0, 0 }).back()", "way is a way of up to 300 mm, not nil"},
           {"technique.draw_slack(t, t.left, -1)", "slack is a number above 0, not -1"},
           {"technique.roll_across('right_subcostal', { 0, 0, 1 }, { 1, 0, 0 })", "port is three numbers"},
           {"technique.roll_across({ 0, 0, 1 }, { 0, 0, 1 }, { 1, 0, 0 })", "port and at are one place"},
           {"technique.unit({ 0, 0, 0 })", "a is three numbers { x, y, z }, not all 0"},
           {"technique.plus({ 0, 0, 0 }, { 0, 0, 1 }, 1, 2)", "3 arguments are enough, not 4"},
           {"technique.shut('duct')",
            "t is the exercise's t, not \"duct\"; tube is a name in quotes, not nil"},
           {"technique.take(t, 'hook', 'fat', {})", "tool is an instrument, such as t.left, not \"hook\""},
           {"technique.hook(t, t.left, 'fat', { port = { 0, 0, 1 }, hardest = 1, between = { 'liver' } })",
            "between is two names { \"...\", \"...\" }, not this table"},
           {"technique.drawing_hand(t, t.left, 'fat', { along = { 0, 0, 0 }, firmly = 1, least = 1, most = 2 "
            "})",
            "along is three numbers { x, y, z }, not all 0, not this table; technique.drawing_hand needs "
            "distance"},
           {"technique.hnad(t)", "technique has no hnad (did you mean \"hand\"?)"},
           {"anatomy.place({ 4, -20, 0 })", "x is a number, not this table; y is a number, not nil"},
           {"anatomy.along('cystic_duct', 0.5)", "points is a list of two places or more"},
           {"anatomy.tube('own', { { 0, 0, 0 }, { 0, 0, 1 } }, 2, 0.001)", "(did you mean 2 * mm?)"},
           {"anatomy:standard()", "anatomy.standard: call it with a dot"},
           {"anatomy.standard { cystic_duct_lenght = 1 }", "(did you mean \"cystic_duct_length\"?)"},
           {"anatomy.standard { cystic_duct_length = 12 }", "(did you mean 12 * mm?)"},
           {"anatomy.standard { fill_pressure = 12 }", "(did you mean 12 * mmHg?)"},
           {"anatomy.standard { without = { 'triangel_fat' } }", "(did you mean \"triangle_fat\"?)"},
           {"anatomy.standard { prepared = { triangle_fat = 0.5 }, without = { 'triangle_fat' } }",
            "\"triangle_fat\" is in prepared and in without"},
           {"anatomy.variant('low_uniom')", "(did you mean \"low_union\"?)"},
           {"anatomy.variant()", "anatomy.variant takes a name first"},
           {"anatomy.varied { unoin = 3 }",
            "anatomy.varied has no parameter \"unoin\" (did you mean \"union\"?)"}}) {
    const ScenarioText text = with_modules("t:wait(0.1 * s)\n" + use);
    const Failure failure = failure_of(text.text());
    EXPECT_EQ(failure.problems[0].place.line, line_of(text.text(), use)) << to_text(failure);
    EXPECT_THAT(to_text(failure), ::testing::HasSubstr(said));
  }
}

TEST(ModuleErrors, WithinAModuleAreAtTheExercisesLineAndSayWhereInTheModule) {
  for (const auto& [use, said] : std::vector<std::pair<std::string, std::string>>{
           {"technique.angle_of_ducts(t)", "unknown landmark \"cystic_duct.start\""},
           {"technique.hand(t, 'lef', { 0, 0, 0 })", "t has no \"lef\" (did you mean \"left\"?)"},
           {"technique.draw_slack(t, t.left, 100)", "aspirate"}}) {
    for (const char* wait : {"", "t:wait(0.1 * s)\n"}) {
      const ScenarioText text = with_modules(wait + use);
      const Failure failure = failure_of(text.text());
      EXPECT_EQ(failure.problems[0].place.line, line_of(text.text(), use)) << to_text(failure);
      EXPECT_THAT(failure.problems[0].place.file, ::testing::Not(::testing::HasSubstr("technique.lua")));
      EXPECT_THAT(to_text(failure), ::testing::HasSubstr(said));
      EXPECT_THAT(to_text(failure), ::testing::ContainsRegex("inside [^ ]*technique.lua:[0-9]+"));
    }
  }
}

TEST(ModuleErrors, ALimitReachedInsideAModuleNamesTheLoopThatCallsIt) {
  const ScenarioText text = with_modules(
      "local x = { 0, 0, 1 }\nwhile true do technique.roll_across(x, { 0, 0, 0 }, { 1, 0, 0 }) end");
  const Failure failure = failure_of(text.text());
  EXPECT_EQ(failure.kind, FailureKind::resource) << to_text(failure);
  EXPECT_EQ(failure.problems[0].place.line, line_of(text.text(), "while true")) << to_text(failure);
}

TEST(ModuleErrors, OfATechniquesParametersAreAllSaidAtTheExercisesLine) {
  ScenarioText text = with_modules(
      "technique.take(t, t.left, 'fat', { port = { 0, 0, 0 / 0 }, tires = 3, hardest = -1,\n"
      "  wanted = true, keep_off = { { organ = 'duct' } } })");
  Failure failure = failure_of(text.text());
  const std::string said = to_text(failure);
  EXPECT_EQ(failure.problems[0].place.line, line_of(text.text(), "technique.take")) << said;
  for (const char* what : {"port is three numbers { x, y, z }, not this table", "no parameter \"tires\"",
                           "technique.take needs tries, a whole number above 0",
                           "hardest is a number above 0, not -1", "wanted is a function, not true"})
    EXPECT_THAT(said, ::testing::HasSubstr(what));
  text = with_modules(
      "technique.take(t, t.left, 'fat', { port = { 0, 0, 0 }, tries = 3, hardest = 1,\n"
      "  keep_off = { { organ = 'duct' } } })");
  failure = failure_of(text.text());
  EXPECT_EQ(failure.problems[0].place.line, line_of(text.text(), "technique.take")) << to_text(failure);
  EXPECT_THAT(to_text(failure), ::testing::HasSubstr("keep_off needs clear"));
}

}  // namespace
}  // namespace calot::module_errors_test
