// What a sound scenario becomes: definitions, parameters, modules.

#include <gmock/gmock.h>

#include "base/log.h"
#include "lua/scenario_files.h"
#include "support/paths.h"

namespace calot {
namespace {

using test::Folder;
using test::load_text;
using test::ScenarioText;
using test::with_anatomy;
using test::with_scene;
using test::with_steps;

ScenarioText with_head(const std::string& head) {
  ScenarioText text;
  text.head = head;
  return text;
}

// ---- parameters

ScenarioText with_parameters() {
  ScenarioText text;
  text.params =
      "{ anatomy = { type = 'choice', default = 'standard', choices = { 'standard', 'hydrops' } },\n"
      "  limit = { type = 'number', default = 3, min = 1, max = 5 }, hard = { type = 'boolean', default = "
      "false } }";
  text.scene =
      "return { anatomy = calot.anatomy(p.anatomy),\n"
      "  instruments = { left = { port = 'right_subcostal', force_limit = p.hard and p.limit * N or 8 * N } "
      "} }";
  return text;
}

TEST(Parameters, HaveTheirDefaultsOrTheUsersValues) {
  const Folder folder;
  Result<std::unique_ptr<ExerciseScript>> plain = load_text(folder, with_parameters().text());
  ASSERT_TRUE(plain) << to_text(plain.failure());
  EXPECT_EQ(plain.value()->definition().scene.instruments[0].force_limit, 8);
  EXPECT_EQ(plain.value()->definition().params.at("anatomy"), "standard");
  LoadOptions options;
  options.params = {{"hard", "true"}, {"limit", "2.5"}, {"anatomy", "hydrops"}};
  Result<std::unique_ptr<ExerciseScript>> chosen = load_text(folder, with_parameters().text(), options);
  ASSERT_TRUE(chosen) << to_text(chosen.failure());
  EXPECT_EQ(chosen.value()->definition().scene.instruments[0].force_limit, 2.5);
  EXPECT_TRUE(chosen.value()->definition().scene.anatomy.organs[0].bile.fill_volume);
  EXPECT_EQ(chosen.value()->definition().params.at("limit"), "2.5");
}

TEST(Parameters, ReachStepsDemoAndTheScoresFunction) {
  ScenarioText text = with_parameters();
  text.steps = "t:step('on_' .. p.anatomy, 'A') t:note('limit', p.limit, 'N')";
  text.demo = "assert(p.anatomy == 'hydrops') t:wait(p.limit * s)";
  text.score =
      "function(p) return calot.score.weighted { { calot.score.benchmark { metric = 'note.limit', novice = "
      "0,\n"
      "expert = p.limit }, weight = 1 }, pass = p.hard and 90 or 70 } end";
  const Folder folder;
  LoadOptions options;
  options.params = {{"hard", "true"}, {"limit", "2.5"}, {"anatomy", "hydrops"}};
  const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(folder, text.text(), options);
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  const ExerciseDefinition& exercise = loaded.value()->definition();
  EXPECT_THAT(exercise.step_names, ::testing::ElementsAre("on_hydrops"));
  EXPECT_THAT(exercise.note_names, ::testing::ElementsAre("limit"));
  EXPECT_EQ(exercise.score.pass, 90);
  EXPECT_EQ(exercise.score.parts.at(0).expert, 2.5);
  EXPECT_EQ(exercise.score.parts.at(0).place.line, test::line_of(text.text(), "return calot.score"));
}

TEST(Parameters, AreDeclaredWithTheirTypesAndDefaults) {
  const Folder folder;
  LoadOptions options;
  options.params = {{"limit", "2.5"}};
  const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(folder, with_parameters().text(), options);
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  const std::vector<ParameterDefinition>& list = loaded.value()->definition().parameters;
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0].name, "anatomy");
  EXPECT_THAT(list[0].choices, ::testing::ElementsAre("standard", "hydrops"));
  EXPECT_EQ(list[2].name, "limit");
  EXPECT_EQ(list[2].fallback, "3");
  EXPECT_EQ(list[2].value, "2.5");
  EXPECT_EQ(list[2].high, 5);
}

TEST(Parameters, ThatAreUnknownOrUnfitAreUsageFailures) {
  for (const auto& [name, value] : std::map<std::string, std::string>{
           {"anatmy", "hydrops"}, {"anatomy", "hydropic"}, {"limit", "9"}, {"hard", "yes"}}) {
    LoadOptions options;
    options.params = {{name, value}};
    const Folder folder;
    const Result<std::unique_ptr<ExerciseScript>> loaded =
        load_text(folder, with_parameters().text(), options);
    ASSERT_FALSE(loaded) << name;
    EXPECT_EQ(loaded.failure().kind, FailureKind::usage) << name;
    EXPECT_FALSE(loaded.failure().problems[0].hint.empty()) << name;
  }
}

// ---- require

TEST(Modules, OfTheScenariosFolderAndTheProjectAreFound) {
  const Folder folder, project;
  folder.write("own/part.lua", "return { weight = 1 }");
  project.write("shared.lua", "return { metric = 'total.time_s' }");
  ScenarioText text;
  text.head = "local own, shared = require 'own.part', require 'shared'";
  text.score =
      "calot.score.weighted { { calot.score.benchmark { metric = shared.metric, novice = 2, expert = 1 }, "
      "weight = own.weight } }";
  LoadOptions options;
  options.modules = project.path();
  const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(folder, text.text(), options);
  EXPECT_TRUE(loaded) << to_text(loaded.failure());
}

TEST(Modules, OutsideAreOutOfReachThroughLinksToo) {
  const Folder folder, outside;
  outside.write("secret.lua", "return 1");
  std::filesystem::create_symlink(outside.path() / "secret.lua", folder.path() / "secret.lua");
  std::filesystem::create_directory_symlink(outside.path(), folder.path() / "there");
  for (const char* name : {"secret", "there.secret"}) {
    Result<std::unique_ptr<ExerciseScript>> loaded =
        load_text(folder, with_head("local x = require '" + std::string(name) + "'").text());
    ASSERT_FALSE(loaded);
    EXPECT_THAT(to_text(loaded.failure()), ::testing::HasSubstr("link out"));
  }
}

TEST(Modules, ThatRequireEachOtherAreRefused) {
  const Folder folder;
  folder.write("a.lua", "return require 'b'");
  folder.write("b.lua", "return require 'a'");
  const Result<std::unique_ptr<ExerciseScript>> loaded =
      load_text(folder, with_head("local a = require 'a'").text());
  ASSERT_FALSE(loaded);
  EXPECT_THAT(to_text(loaded.failure()), ::testing::HasSubstr("requires itself"));
  EXPECT_THAT(to_text(loaded.failure()), ::testing::HasSubstr("b.lua:1"));
}

TEST(Modules, AreRunOnceAndCountInTheSourceHash) {
  const Folder folder;
  const std::string text = with_head("local a, b = require 'a', require 'a' assert(a == b)").text();
  folder.write("a.lua", "return {}");
  const Result<std::unique_ptr<ExerciseScript>> one = load_text(folder, text);
  folder.write("a.lua", "return { 1 }");
  const Result<std::unique_ptr<ExerciseScript>> other = load_text(folder, text);
  ASSERT_TRUE(one && other);
  EXPECT_NE(one.value()->definition().source_hash, other.value()->definition().source_hash);
}

// ---- what is read

TEST(Exercise, OfTheRepositoryLoads) {
  LoadOptions options;
  options.modules = std::filesystem::path(source_dir()) / "scripts/lua";
  const std::filesystem::path folder = std::filesystem::path(source_dir()) / "scenarios";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".lua") continue;
    const Result<std::unique_ptr<ExerciseScript>> loaded = load_exercise(entry.path(), options);
    EXPECT_TRUE(loaded) << to_text(loaded.failure());
  }
}

TEST(Exercise, DeclaresItsStepsAndHoldsWithoutBeingPlayed) {
  const Folder folder;
  const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(
      folder,
      with_steps("t:step('a', 'A', { limit = 5 * s })\n t:wait_until(function() return true end)\n"
                 "for i = 1, 2 do t:step('b' .. i, 'B') t:hold('c', function() return true end, 1 * s) end\n"
                 "while not t.left:holds('gallbladder') do t:wait(0.1 * s) end\n"
                 "while t.left:holds('gallbladder') do t:wait(0.1 * s) end t:step('d', 'D')")
          .text());
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  EXPECT_THAT(loaded.value()->definition().step_names, ::testing::ElementsAre("a", "b1", "b2", "d"));
  EXPECT_THAT(loaded.value()->definition().hold_names, ::testing::ElementsAre("b1.c", "b2.c"));
}

TEST(Exercise, IsPlayedInAStateThatNoCheckHasTouched) {
  const Folder folder;
  std::vector<std::string> printed;
  LogSink before = set_log_sink([&](LogLevel, const std::string& text) { printed.push_back(text); });
  ScenarioText text;
  text.head = "local count = 0 print('once')";
  text.steps = "count = count + 1 assert(count == 1) t:step('a' .. count, 'A') t:wait(1 * s)";
  const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(folder, text.text());
  set_log_sink(std::move(before));
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  EXPECT_THAT(printed, ::testing::ElementsAre("once"));
}

TEST(Exercise, OverridesOfAnAnatomyKeepTheRest) {
  const Folder folder;
  const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(
      folder, with_anatomy(
                  "calot.anatomy('standard', { table_head_up = 0, organs = { { shape = { width = 30 * mm },\n"
                  "bile = { fill_volume = 45 * calot.units.mL } } } })")
                  .text());
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  const Result<AnatomyDefinition> standard = named_anatomy("standard");
  const AnatomyDefinition& anatomy = loaded.value()->definition().scene.anatomy;
  const PearShape pear = std::get<PearShape>(anatomy.organs[0].shape);
  EXPECT_EQ(pear.width, 30e-3);
  EXPECT_EQ(pear.length, std::get<PearShape>(standard->organs[0].shape).length);
  EXPECT_EQ(pear.refine, std::get<PearShape>(standard->organs[0].shape).refine);
  EXPECT_EQ(anatomy.organs[0].held.size(), standard->organs[0].held.size());
  EXPECT_EQ(anatomy.table_head_up, 0);
  EXPECT_EQ(anatomy.table_left_down, standard->table_left_down);
  EXPECT_FALSE(anatomy.organs[0].bile.fill_pressure);
  EXPECT_NEAR(*anatomy.organs[0].bile.fill_volume, 45e-6, 1e-18);  // rounding of 45 * 1e-6
}

TEST(Exercise, TissueIsReadWithItsDefaults) {
  const Folder folder;
  const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(
      folder,
      with_anatomy("calot.anatomy('standard', { organs = { {}, { name = 'duct', shape = { type = 'tube', "
                   "points = { { 0, 0, 0 }, { 30 * mm, 0, 0 } } }, held = { { landmark = 'start' } } } },\n"
                   "tissue = { { name = 'plate', from = 'duct', to = 'gallbladder', within = 4 * mm, start = "
                   "0.2, stop = 0.8, strands = 250, strength = 20 * calot.units.kPa } } })")
          .text());
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  const AnatomyDefinition& anatomy = loaded.value()->definition().scene.anatomy;
  ASSERT_EQ(anatomy.tissue.size(), 1u);
  const TissueDefinition &tissue = anatomy.tissue[0], standard;
  EXPECT_EQ(tissue.name, "plate");
  EXPECT_EQ(tissue.from, "duct");
  EXPECT_EQ(tissue.to, "gallbladder");
  EXPECT_EQ(tissue.within, 4e-3);
  EXPECT_EQ(tissue.start, 0.2);
  EXPECT_EQ(tissue.stop, 0.8);
  EXPECT_EQ(tissue.strands, 250);
  EXPECT_EQ(tissue.strength, 20e3);
  EXPECT_EQ(tissue.break_energy, standard.break_energy);
}

TEST(Exercise, InstrumentsAreInTheOrderOfTheirNamesAndPortsAreAdded) {
  const Folder folder;
  const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(
      folder,
      with_scene("return { anatomy = calot.anatomy('standard'), ports = { extra = { 0, 50 * mm, 0 } },\n"
                 "instruments = { right = { port = 'epigastric' }, left = { port = 'extra' } } }")
          .text());
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  const SceneDefinition& scene = loaded.value()->definition().scene;
  EXPECT_EQ(scene.instruments[0].name, "left");
  EXPECT_EQ(scene.instruments[1].name, "right");
  EXPECT_EQ(scene.ports.size(), default_ports().size() + 1);
}

}  // namespace
}  // namespace calot
