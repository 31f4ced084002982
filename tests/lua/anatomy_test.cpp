// The operating field that scripts/lua/anatomy.lua makes.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/rng.h"
#include "base/units.h"
#include "field/field.h"
#include "lua/scenario_files.h"
#include "session/runner.h"
#include "support/long_run.h"
#include "world/world.h"

namespace calot {
namespace {

using test::Folder;
using test::load_text;
using units::mL;
using units::mm;

std::string field(const std::string& anatomy, const std::string& look_at = "cystic_duct.middle") {
  test::ScenarioText text;
  text.head = "local anatomy = require 'anatomy'\n";
  text.scene = "return { anatomy = " + anatomy +
               ",\n solver = { motion = 'dynamic' }, laparoscope = { look_at = '" + look_at +
               "' },\n"
               " instruments = { left = { port = 'right_lateral' } } }";
  return text.text();
}

SceneDefinition scene_of(const std::string& anatomy, const std::string& look_at = "cystic_duct.middle") {
  const Folder folder;
  const auto loaded = load_text(folder, field(anatomy, look_at));
  EXPECT_TRUE(loaded) << to_text(loaded.failure());
  return loaded ? loaded.value()->definition().scene : SceneDefinition{};
}

/// m, the farthest that any point of an organ's skin is from where it was drawn.
double moved(const Organ& organ) {
  const std::vector<Vec3> now = organ.body->skin_positions(organ.state.x);
  double most = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    most = std::max(most, (now[i] - organ.body->skin_rest()[i]).norm());
  return most;
}

TEST(Anatomy, TheStandardFieldComesToRest) {
  CALOT_SLOW_WHEN_SANITIZED("a whole field");
  Result<World> world = World::create(scene_of("anatomy.standard()"));
  ASSERT_TRUE(world) << to_text(world.failure());
  std::vector<Vec3> before;
  for (const Organ& organ : world->field().organs) {
    // As drawn, but for what weight and filling do to it; a gallbladder swells by its pressure.
    EXPECT_LT(moved(organ), 7 * mm) << organ.definition.name;
    before.push_back(organ.body->skin_positions(organ.state.x).front());
  }
  for (const Tissue& tissue : world->field().tissues) EXPECT_EQ(tissue.torn(), 0) << tissue.definition.name;
  const double volume = world->report().organs[0].volume;
  EXPECT_GT(volume, 25 * mL);  // what gallbladders hold
  EXPECT_LT(volume, 80 * mL);
  StepInput still;
  for (const InstrumentState& tool : world->report().instruments) still.instruments.push_back(tool.pose);
  for (int step = 0; step < 10; ++step) ASSERT_TRUE(world->step(still));
  for (std::size_t k = 0; k < before.size(); ++k) {
    const Organ& organ = world->field().organs[k];
    EXPECT_LT((organ.body->skin_positions(organ.state.x).front() - before[k]).norm(), 0.05 * mm)
        << organ.definition.name;
  }
}

TEST(Anatomy, AGallbladderThatHardlyHoldsRestsWhereGravityPutsIt) {
  CALOT_SLOW_WHEN_SANITIZED("a whole field");
  // Without any plate it finds its rest by falling, which takes a quarter of a minute.
  const std::string gone =
      test::long_run() ? "without = { 'cystic_plate' }" : "prepared = { cystic_plate = 0.85 }";
  Result<World> world = World::create(scene_of("anatomy.standard { assistant = false, " + gone + " }"));
  ASSERT_TRUE(world) << to_text(world.failure());
  EXPECT_GT(moved(world->field().organs[0]), 50 * mm) << "nobody holds it up";
  const Vec3 fundus = world->landmark("gallbladder.fundus"), neck = world->landmark("gallbladder.neck");
  StepInput still;
  for (const InstrumentState& tool : world->report().instruments) still.instruments.push_back(tool.pose);
  for (int k = 0; k < 50; ++k) {
    const Result<StepReport> report = world->step(still);
    ASSERT_TRUE(report) << to_text(report.failure());
    for (const Organ& organ : world->field().organs) ASSERT_TRUE(organ.state.x.allFinite());
  }
  EXPECT_LT((world->landmark("gallbladder.fundus") - fundus).norm(), 0.5 * mm);
  EXPECT_LT((world->landmark("gallbladder.neck") - neck).norm(), 0.5 * mm);
}

/// m, up from the origin, of an organ's skin on average.
double height_of(const World& world, const Organ& organ) {
  Vec3 sum = Vec3::Zero();
  const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
  for (const Vec3& p : skin) sum += p;
  return world.up().dot(sum) / static_cast<double>(skin.size());
}

// Of the field in which it is taken off its bed, with fewer nodes and strands: a rest takes seconds.
TEST(Anatomy, TheMoreOfThePlaneIsGoneTheLowerTheGallbladderRests) {
  CALOT_SLOW_WHEN_SANITIZED("three whole fields");
  double before = std::numeric_limits<double>::infinity();
  for (const char* gone : {"0.3", "0.6", "0.85"}) {
    Result<World> made = World::create(
        scene_of("anatomy.standard { assistant = false, areolar_plane = true, nodes = 120, strands = 0.5,\n"
                 " without = { 'cystic_node', 'hilar_fat', 'triangle_fat', 'artery_fat', 'cystic_artery', "
                 "'cystic_duct',\n"
                 " 'right_hepatic_artery' }, prepared = { cystic_plate = " +
                     std::string(gone) + " } }",
                 "gallbladder.fundus"));
    ASSERT_TRUE(made) << gone << ": " << to_text(made.failure());
    World& world = made.value();
    const Organ& gallbladder = world.field().organs[0];
    const double height = height_of(world, gallbladder);
    EXPECT_LT(height, before - 1 * mm) << gone;
    before = height;
    StepInput still;
    for (const InstrumentState& tool : world.report().instruments) still.instruments.push_back(tool.pose);
    for (int step = 0; step < 10; ++step) {
      const Result<StepReport> report = world.step(still);
      ASSERT_TRUE(report) << gone << ": " << to_text(report.failure());
      EXPECT_TRUE(report->balanced) << gone;
      for (const Organ& organ : world.field().organs) EXPECT_TRUE(organ.state.x.allFinite()) << gone;
    }
    EXPECT_NEAR(height_of(world, gallbladder), height, 0.05 * mm) << gone;
  }
}

TEST(Anatomy, EveryVariantIsAnAnatomyOfItsOwn) {
  const std::vector<std::string> variants = {
      "short_cystic_duct", "low_union",    "double_cystic_artery", "hepatic_artery_near_neck",
      "hydrops",           "phrygian_cap", "dilated_common_duct",  "aberrant_right_duct"};
  const SceneDefinition standard = scene_of("anatomy.standard()");
  for (const std::string& name : variants) {
    const SceneDefinition scene = scene_of("anatomy.variant('" + name + "')");
    bool same = scene.anatomy.organs.size() == standard.anatomy.organs.size();
    for (std::size_t i = 0; same && i < scene.anatomy.organs.size(); ++i)
      same = scene.anatomy.organs[i].shape == standard.anatomy.organs[i].shape;
    EXPECT_FALSE(same) << name;
  }
}

TEST(Anatomy, ADuctIsAsWideAlongItAsItsListSays) {
  for (const OrganDefinition& organ : scene_of("anatomy.variant('dilated_common_duct')").anatomy.organs) {
    if (organ.name != "common_duct") continue;
    const auto& shape = std::get<TubeShape>(organ.shape);
    ASSERT_EQ(shape.radii.size(), shape.points.size());
    EXPECT_DOUBLE_EQ(shape.start_radius(), 3 * mm);
    EXPECT_DOUBLE_EQ(shape.radii[3], 5 * mm);
  }
}

TEST(Anatomy, TheCysticArteryEndsOnTheGallbladdersWallWhereverItIsLedTo) {
  // On the wall, and 3 and 7 mm off it.
  for (const char* enters : {"{ -3.5, -13.5, 2 }", "{ -2, -17, 10 }", "{ 2, -15, 15 }"}) {
    std::vector<Vec3> overlaps;
    const Result<World> world = World::as_drawn(
        scene_of(fmt::format("anatomy.standard {{ cystic_artery_enters = {} }}", enters)), overlaps);
    ASSERT_TRUE(world) << to_text(world.failure());
    const Vec3 end = world->landmark("cystic_artery.end");
    double nearest = 1;
    for (const Vec3& point : world->skin_positions(world->organ("gallbladder").value()))
      nearest = std::min(nearest, (point - end).norm());
    // Skin points are up to 2 mm apart, and the wall is smoother than the shape that it is made of.
    EXPECT_LT(nearest, 1.5 * mm) << enters;
  }
}

TEST(Anatomy, SaysWhatItIsCalledWhenWhatShouldBeKeptIsHurt) {
  std::map<std::string, OrganDefinition> organs;
  for (const OrganDefinition& organ : scene_of("anatomy.standard()").anatomy.organs)
    organs[organ.name] = organ;
  const OrganDefinition& common = organs.at("common_duct");
  EXPECT_EQ(common.injury.cut + ", " + common.injury.partly, "Strasberg E1, Strasberg D");
  EXPECT_EQ(common.keep_clear, 3 * mm);
  EXPECT_EQ(organs.at("cystic_duct").injury.unclipped, "Strasberg A");
  EXPECT_EQ(organs.at("cystic_duct").injury.cut, "") << "it is what is to be divided";
  EXPECT_NE(organs.at("right_hepatic_artery").injury.closed, "");
}

TEST(Anatomy, TheSameSeedIsTheSamePatient) {
  const auto width = [](std::uint64_t seed) {
    const Folder folder;
    LoadOptions options;
    options.seed = seed;
    const auto loaded = load_text(folder, field("anatomy.varied()"), options);
    EXPECT_TRUE(loaded) << to_text(loaded.failure());
    return std::get<SweptShape>(loaded.value()->definition().scene.anatomy.organs[0].shape)
        .along.back()
        .radius;
  };
  EXPECT_EQ(width(3), width(3));
  EXPECT_NE(width(3), width(4));
}

/// Null: there is none of that name.
const TissueDefinition* tissue_called(const SceneDefinition& scene, const std::string& name) {
  for (const TissueDefinition& tissue : scene.anatomy.tissue)
    if (tissue.name == name) return &tissue;
  return nullptr;
}

TEST(Anatomy, AnAreolarPlaneLooksLikeOneAndAnUsualPlateLikeFat) {
  const auto looks = [](const std::string& anatomy) {
    return tissue_called(scene_of(anatomy), "cystic_plate")->looks;
  };
  EXPECT_EQ(looks("anatomy.standard {}"), TissueLooks::fat);
  EXPECT_EQ(looks("anatomy.standard { areolar_plane = true }"), TissueLooks::areolar);
}

TEST(Anatomy, ATissueThatIsPreparedEndsWhereItIsClearedToWithFewerStrandsOfTheSameArea) {
  const SceneDefinition scene = scene_of(
      "anatomy.standard { prepared = { triangle_fat = 0.5, cystic_plate = { 0.75, 1 }, artery_fat = 1, "
      "hilar_fat = 0 } }");
  const TissueDefinition* fat = tissue_called(scene, "triangle_fat");
  ASSERT_TRUE(fat != nullptr);
  EXPECT_DOUBLE_EQ(fat->start, 0.45);
  EXPECT_DOUBLE_EQ(fat->stop, 0.9);
  EXPECT_EQ(fat->strands, 8);
  const TissueDefinition* plate = tissue_called(scene, "cystic_plate");
  ASSERT_TRUE(plate != nullptr);
  EXPECT_DOUBLE_EQ(plate->start, 0.2);
  EXPECT_DOUBLE_EQ(plate->stop, 0.8);
  EXPECT_EQ(plate->strands, 45);
  EXPECT_EQ(tissue_called(scene, "artery_fat"), nullptr) << "all of it is gone";
  EXPECT_EQ(tissue_called(scene, "hilar_fat")->strands, 14) << "nothing of it is";
}

TEST(Anatomy, OfATubeThatWasDividedAStumpIsLeftThatNothingHoldsAtItsEnd) {
  const auto called = [](const SceneDefinition& scene, const std::string& name) {
    const auto found = std::find_if(scene.anatomy.organs.begin(), scene.anatomy.organs.end(),
                                    [&](const OrganDefinition& organ) { return organ.name == name; });
    return found == scene.anatomy.organs.end() ? nullptr : &*found;
  };
  const std::string rest = "without = { 'artery_fat', 'triangle_fat' } }";
  const SceneDefinition whole = scene_of("anatomy.standard { " + rest),
                        divided = scene_of(
                            "anatomy.standard { prepared = { cystic_duct = 0.4, "
                            "cystic_artery = { 0.5, 1 }, right_hepatic_artery = 0 }, " +
                            rest);
  const auto long_is = [&](const SceneDefinition& scene, const char* name) {
    const std::vector<Vec3>& points = std::get<TubeShape>(called(scene, name)->shape).points;
    double sum = 0;
    for (std::size_t k = 1; k < points.size(); ++k) sum += (points[k] - points[k - 1]).norm();
    return sum;
  };
  EXPECT_NEAR(long_is(divided, "cystic_duct") / long_is(whole, "cystic_duct"), 0.6, 0.02);
  EXPECT_NEAR(long_is(divided, "cystic_artery") / long_is(whole, "cystic_artery"), 0.5, 0.02);
  EXPECT_EQ(long_is(divided, "right_hepatic_artery"), long_is(whole, "right_hepatic_artery"));
  const auto joined = [](const SceneDefinition& scene, const std::string& landmark) {
    return std::any_of(
        scene.anatomy.joints.begin(), scene.anatomy.joints.end(),
        [&](const JointDefinition& joint) { return joint.from == landmark || joint.to == landmark; });
  };
  for (const char* end : {"cystic_duct.start", "cystic_artery.end"}) {
    EXPECT_TRUE(joined(whole, end));
    EXPECT_FALSE(joined(divided, end)) << end;
  }
  for (const char* end : {"cystic_duct.end", "cystic_artery.start"}) EXPECT_TRUE(joined(divided, end)) << end;
}

TEST(Anatomy, AStumpIsNotHeldWhereItWasDivided) {
  const SceneDefinition divided = scene_of(
      "anatomy.standard { prepared = { right_hepatic_artery = { 0.5, 1 } }, "
      "without = { 'hilar_fat' } }");
  const auto artery =
      std::find_if(divided.anatomy.organs.begin(), divided.anatomy.organs.end(),
                   [](const OrganDefinition& organ) { return organ.name == "right_hepatic_artery"; });
  ASSERT_NE(artery, divided.anatomy.organs.end());
  const auto is_held_at = [&](const std::string& end) {
    return std::any_of(artery->held.begin(), artery->held.end(),
                       [&](const HeldRegion& held) { return held.landmark == end; });
  };
  EXPECT_TRUE(is_held_at("start"));
  EXPECT_FALSE(is_held_at("end"));
}

TEST(Anatomy, AParameterThatItDoesNotHaveIsNamed) {
  for (const auto& [wrong, what] :
       {std::pair{"{ prepared = { gallbladder = 0.5 } }", "is no tissue and no tube"},
        std::pair{"{ prepared = { cystic_duct = 2 } }", "a share of its way"},
        std::pair{"{ prepared = { triangel_fat = 1 } }", "no \"triangel_fat\" to leave out"},
        std::pair{"{ prepared = { triangle_fat = { 0.3, 0.6 } } }", "up to one of its ends"},
        std::pair{"{ prepared = { triangle_fat = 1.5 } }", "a share of its way"},
        std::pair{"{ prepared = { cystic_duct = 0.4 } }", "\"triangle_fat\" begins on \"cystic_duct\""}}) {
    const Folder folder;
    const auto loaded = load_text(folder, field(std::string("anatomy.standard ") + wrong));
    ASSERT_FALSE(loaded);
    EXPECT_THAT(to_text(loaded.failure()), ::testing::HasSubstr(what));
    EXPECT_GT(loaded.failure().problems[0].place.line, 0);
  }
  for (const char* wrong : {"anatomy.standard { cystic_duct_lenght = 1 }", "anatomy.variant('low_onion')"}) {
    const Folder folder;
    const auto loaded = load_text(folder, field(wrong));
    ASSERT_FALSE(loaded);
    EXPECT_THAT(to_text(loaded.failure()),
                ::testing::AnyOf(::testing::HasSubstr("no parameter \"cystic_duct_lenght\""),
                                 ::testing::HasSubstr("no variant \"low_onion\"")));
  }
}

TEST(Anatomy, AnAuthorAddsAVesselByWhatTheModuleIsMadeOf) {
  const SceneDefinition scene = scene_of(
      "(function()\n local field = anatomy.standard()\n"
      "field.organs[#field.organs + 1] = anatomy.tube('own', { anatomy.place(4, -20, 0), anatomy.place(8, "
      "-28, "
      "-6) },\n 2 * mm, 0.4 * mm, { { landmark = 'end' } }, { carries = 'blood', nodes = 7 })\n"
      "field.joints[#field.joints + 1] = anatomy.joint('own.start', 'gallbladder.neck', 4 * mm)\n"
      "return field end)()");
  const SceneDefinition standard = scene_of("anatomy.standard()");
  ASSERT_EQ(scene.anatomy.organs.size(), standard.anatomy.organs.size() + 1);
  const OrganDefinition& own = scene.anatomy.organs.back();
  const auto& tube = std::get<TubeShape>(own.shape);
  EXPECT_EQ(own.name, "own");
  EXPECT_DOUBLE_EQ(tube.radius, 1e-3);
  EXPECT_NEAR((tube.points[1] - tube.points[0]).norm(), Vec3(4e-3, 8e-3, 6e-3).norm(), 1e-9) << "by mm";
  EXPECT_EQ(scene.anatomy.joints.back().from, "own.start");
  EXPECT_DOUBLE_EQ(scene.anatomy.joints.back().radius, 4e-3);
}

TEST(Anatomy, WhatIsNoValueOfAParameterIsRefusedAtTheAuthorsLine) {
  struct Wrong {
    std::string given, what;
  };
  const std::vector<Wrong> wrong{
      {"cystic_duct_diameter = 0", "cystic_duct_diameter is a length above 0, up to 20 mm, not 0"},
      {"gallbladder_width = -33 * mm", "gallbladder_width is a length above 0, up to 100 mm, not -0.033"},
      {"strands = 0/0", "strands is a number above 0, not nan"},
      {"strength = 1/0", "strength is a number above 0, not inf"},
      {"strands = 'x'", "strands is a number above 0, not \"x\""},
      {"nodes = 200.5", "nodes is a whole number above 0, not 200.5"},
      {"union = 1", "union is a share between 0 and 1, not 1"},
      {"aberrant_union = true", "aberrant_union is a share between 0 and 1, not true"},
      {"common_duct_widest = true", "common_duct_widest is a number above 0, or false, not true"},
      {"phrygian_cap = 1", "phrygian_cap is true or false, not 1"},
      {"union_lies = { 1, 2 }", "union_lies is three numbers"},
      {"cystic_artery_enters = { 1, 2, 0/0 }", "cystic_artery_enters is three numbers"},
      {"looks = 3", "looks is a name in quotes, not 3"},
      {"without = 'bile'", "without is a list of names { \"...\" }, not \"bile\""},
      {"prepared = { 0.5 }", "prepared is a table of what has names"}};
  for (const std::string makes :
       {"anatomy.standard {", "anatomy.variant('low_union',\n {", "anatomy.varied {"}) {
    const std::string end = makes.find('(') == std::string::npos ? " }" : " })";
    for (const Wrong& one : wrong) {
      const Folder folder;
      const auto loaded = load_text(folder, field(makes + one.given + end));
      ASSERT_FALSE(loaded) << one.given;
      const Problem& problem = loaded.failure().problems[0];
      EXPECT_THAT(problem.message, ::testing::HasSubstr(one.what));
      EXPECT_THAT(problem.message, ::testing::Not(::testing::HasSubstr("anatomy.lua")))
          << "the author's part";
      EXPECT_THAT(problem.place.file, ::testing::Not(::testing::HasSubstr("anatomy.lua")));
      EXPECT_GT(problem.place.line, 0);
    }
  }
}

/// A parameter of anatomy.standard, or nearly, and a value that may or may not be one of its own.
std::string random_option(Rng& rng) {
  static const std::vector<std::string> keys{"gallbladder_length",
                                             "gallbladder_width",
                                             "fill_pressure",
                                             "phrygian_cap",
                                             "cystic_duct_length",
                                             "cystic_duct_diameter",
                                             "common_duct_diameter",
                                             "common_duct_widest",
                                             "union",
                                             "union_lies",
                                             "cystic_artery_length",
                                             "cystic_artery_diameter",
                                             "cystic_artery_enters",
                                             "second_cystic_artery",
                                             "hepatic_ducts",
                                             "hepatic_artery_near_neck",
                                             "aberrant_duct",
                                             "aberrant_union",
                                             "node_diameter",
                                             "assistant",
                                             "looks",
                                             "nodes",
                                             "strands",
                                             "strength",
                                             "without",
                                             "prepared"};
  static const std::vector<std::string> values{"0/0",
                                               "-1 * mm",
                                               "0",
                                               "1e-9",
                                               "1e9",
                                               "1/0",
                                               "'x'",
                                               "true",
                                               "false",
                                               "{}",
                                               "{ 1 }",
                                               "{ 1, 2, 0/0 }",
                                               "0.5",
                                               "3.5",
                                               "200",
                                               "12 * mm",
                                               "80",
                                               "1 * mm",
                                               "300 * mm",
                                               "{ 'liver' }",
                                               "{ 'livr' }",
                                               "'pale'",
                                               "{ cystic_plate = 0.5 }",
                                               "{ cystic_plate = { 0.5, 2 } }",
                                               "{ plate = 0.5 }",
                                               "function() end",
                                               "{ 5, 5, 5 }",
                                               "{ 900, 0, 0 }"};
  std::string key = keys[rng.next() % keys.size()];
  if (rng.uniform() < 0.15) key.erase(rng.next() % key.size(), 1);
  return key + " = " + values[rng.next() % values.size()];
}

TEST(Anatomy, WhateverItIsGivenIsTakenOrRefusedAtTheAuthorsLine) {
  Rng rng(39);
  int refused = 0;
  for (int k = 0; k < 200; ++k) {
    const std::string option = random_option(rng);
    SCOPED_TRACE(option);
    const Folder folder;
    const auto loaded = load_text(folder, field("anatomy.standard {\n " + option + " }"));
    if (loaded) continue;
    ++refused;
    EXPECT_EQ(loaded.failure().kind, FailureKind::scenario);
    for (const Problem& problem : loaded.failure().problems) {
      EXPECT_THAT(problem.place.file, ::testing::EndsWith("test.lua")) << to_text(loaded.failure());
      EXPECT_GT(problem.place.line, 0) << to_text(loaded.failure());
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_LT(refused, 195) << "nothing is taken";
}

TEST(Anatomy, AllThatIsWrongWithAFieldIsSaidAtOnce) {
  const Folder folder;
  const auto loaded =
      load_text(folder, field("anatomy.variant('low_union', { nodes = 0, strenght = 2, union = 2 })"));
  ASSERT_FALSE(loaded);
  const std::string said = to_text(loaded.failure());
  for (const char* what : {"nodes is", "no parameter \"strenght\"", "union is"})
    EXPECT_THAT(said, ::testing::HasSubstr(what));
}

TEST(Anatomy, WhatIsNoTableOfParametersIsRefused) {
  for (const std::string call :
       {"anatomy.standard(3)", "anatomy.variant('low_union', 'x')", "anatomy.varied(3)"}) {
    const Folder folder;
    const auto loaded = load_text(folder, field(call));
    ASSERT_FALSE(loaded) << call;
    EXPECT_THAT(loaded.failure().problems[0].place.file, ::testing::Not(::testing::HasSubstr("anatomy.lua")));
  }
}

TEST(Anatomy, RadiiThatAreNoneOrGivenTwiceAreRefusedAtTheirLine) {
  for (const auto& [radii, what] :
       {std::pair{"radius = 2 * mm, radii = { 2 * mm, 1 * mm }", "radius and radii are both given"},
        std::pair{"radii = { 2 * mm, 'wide' }", "this is no radius"}}) {
    const Folder folder;
    const auto loaded = load_text(
        folder,
        test::with_scene(std::string("return { anatomy = { organs = { { name = 'duct', shape = { type = "
                                     "'tube', points = { { 20 * mm, 0, 0 }, { 50 * mm, 0, 0 } }, ") +
                         radii + " } } } } }")
            .text());
    ASSERT_FALSE(loaded) << radii;
    EXPECT_THAT(to_text(loaded.failure()), ::testing::HasSubstr(what));
    EXPECT_GT(loaded.failure().problems[0].place.line, 0);
  }
}

TEST(Anatomy, ADuctThatEndsNowhereIsRefused) {
  const Folder folder;
  test::ScenarioText text = test::with_scene(
      "return { anatomy = { organs = { { name = 'stone', shape = { type = 'rigid', centre = { 0, 0, -200 * "
      "mm } } },\n"
      " { name = 'duct', shape = { type = 'tube', points = { { 20 * mm, 0, -200 * mm }, { 50 * mm, 0, -200 * "
      "mm } } },\n"
      "   held = { { landmark = 'end' } } } },\n"
      " joints = {\n { from = 'duct.start', to = 'stone.centre' } } },\n"
      " laparoscope = { look_at = 'duct.end' } }");
  const auto loaded = load_text(folder, text.text());
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  const Result<World> world = World::create(loaded.value()->definition().scene);
  ASSERT_FALSE(world);
  const Failure failure = loaded.value()->located(world.failure());
  EXPECT_EQ(failure.problems[0].place.path, "scene.anatomy.joints[1]");
  EXPECT_GT(failure.problems[0].place.line, 0);
  EXPECT_THAT(to_text(failure),
              ::testing::HasSubstr("duct.start ends nowhere: it lies 15.1 mm from 'stone'"));
}

TEST(Anatomy, APouchThatGivesWayBetweenFastJawsIsTakenHoldOf) {
  CALOT_SLOW_WHEN_SANITIZED("a whole field");
  // As the jaws close its fold comes to a load at which the tangent is all but singular: no answer of the first order can
  // be believed there.
  test::ScenarioText text;
  text.head = "local anatomy = require 'anatomy'\n";
  text.scene =
      "return { anatomy = anatomy.standard { cystic_artery_enters = { -2, -17, 10 },\n"
      "  cystic_artery_length = 24 * mm, without = { 'cystic_node', 'hilar_fat' },\n"
      "  prepared = { triangle_fat = 0.75 } },\n"
      " instruments = { left = { port = 'right_subcostal' } }, solver = { motion = 'dynamic' },\n"
      " laparoscope = { look_at = 'cystic_duct.middle' } }";
  text.steps =
      "t:step('take', 'Take the pouch', { limit = 3 * s })\n"
      "t:wait_until(function() return t.left:holds('gallbladder') end)";
  text.demo =
      "t.left:approach('gallbladder.infundibulum', { speed = 100 * mm / s, depth = 4 * mm })\n"
      "t.left:close()";
  const Folder folder;
  const auto script = load_text(folder, text.text());
  ASSERT_TRUE(script) << to_text(script.failure());
  World world = World::create(script.value()->definition().scene).value();
  const SessionResult result = run_session(world, *script.value(), script.value()->demo(), {});
  EXPECT_EQ(result.end, SessionEnd::steps_done) << to_text(result.failure);
  EXPECT_EQ(result.metrics.at("left.grasps"), 1);
}

}  // namespace
}  // namespace calot
