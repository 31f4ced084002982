// One table declares the API: everything else is held to it.

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>

#include "lua/api_generate.h"
#include "lua/api_table.h"
#include "lua/methods.h"
#include "lua/read_scene.h"
#include "lua/scenario_files.h"
#include "script/sandbox_library.h"
#include "support/paths.h"

namespace calot {
namespace {

using test::Folder;

// ---- generated files

struct Generated {
  const char* path;
  std::string (*text)();
};

class GeneratedFiles : public ::testing::TestWithParam<Generated> {};

TEST_P(GeneratedFiles, AreWhatTheTableGives) {
  const std::filesystem::path path = std::filesystem::path(source_dir()) / GetParam().path;
  const std::string wanted = GetParam().text();
  if (std::getenv("CALOT_WRITE_GENERATED") != nullptr) std::ofstream(path, std::ios::binary) << wanted;
  std::ifstream file(path, std::ios::binary);
  const std::string found{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_EQ(found, wanted) << "the API has changed: run this test with CALOT_WRITE_GENERATED=1 and commit "
                           << GetParam().path;
}

INSTANTIATE_TEST_SUITE_P(Api, GeneratedFiles,
                         ::testing::Values(Generated{"scripts/lua/calot.meta.lua", generate_annotations},
                                           Generated{".luacheckrc", generate_luacheckrc},
                                           Generated{"scripts/lua/README.md", generate_reference}));

TEST(Api, LuacheckFindsNothingInTheRepositorysLua) {
  if (std::system("luacheck --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "luacheck is not installed";
  const std::string command =
      "cd '" + source_dir() +
      "' && luacheck --config .luacheckrc --no-color scenarios scripts/lua > /dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

TEST(Api, LuacheckKnowsWhatTheSandboxLacks) {
  if (std::system("luacheck --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "luacheck is not installed";
  const Folder folder;
  const std::string file = folder.write("bad.lua", "print(os.time(), string.dump)\n").string();
  const std::string command = "luacheck --config '" + source_dir() +
                              "/.luacheckrc' --no-color --formatter plain " + file + " > " +
                              (folder.path() / "out").string();
  EXPECT_NE(std::system(command.c_str()), 0);
  std::ifstream out(folder.path() / "out");
  const std::string text{std::istreambuf_iterator<char>(out), std::istreambuf_iterator<char>()};
  EXPECT_THAT(text, ::testing::HasSubstr("os"));
  EXPECT_THAT(text, ::testing::HasSubstr("dump"));
}

// ---- bindings

TEST(Api, EveryDeclaredMethodIsBound) {
  for (const ApiClass& handle : api_classes())
    for (const std::string& method : method_names(handle.name))
      EXPECT_NE(method_function(handle.name, method), nullptr);
}

TEST(Api, NamesAreUniqueWithinTheirTableAndClass) {
  for (const KeyTable& table : api_tables()) {
    const std::vector<std::string> names = table.key_names();
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << table.name;
  }
  for (const ApiClass& handle : api_classes()) {
    const std::vector<std::string> names = method_names(handle.name);
    // An inherited method may be declared again (an instrument's own wait is none of t's).
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << handle.name;
  }
}

TEST(Api, EverythingIsDocumented) {
  for (const KeyTable& table : api_tables())
    for (const Key& key : table.keys) EXPECT_FALSE(key.doc.empty()) << table.name << "." << key.name;
  for (const ApiFunction& function : api_functions()) EXPECT_FALSE(function.doc.empty()) << function.name;
}

TEST(Api, TheModuleHoldsWhatIsDeclaredAndNothingElse) {
  const Folder folder;
  test::ScenarioText text;
  for (const ApiFunction& function : api_functions())
    if (function.owner == "calot" || function.owner == "score")
      text.head += "assert(type(" + function.full_name() + ") == 'function')\n";
  for (const ApiUnit& unit : api_units())
    text.head += "assert(calot.units." + unit.name + " == " + std::to_string(unit.factor * 1e6) +
                 " / 1e6, '" + unit.name + "')\n";
  for (const char* absent : {"calot.units.inch", "calot.score.guess", "calot.version", "calot.kind"})
    text.head += "assert(not pcall(function() return " + std::string(absent) + " end))\n";
  text.head += "assert(not pcall(function() calot.units.mm = 1 end))";
  // deg and mmHg have more digits than to_string writes.
  std::string code = text.text();
  for (const char* inexact : {"deg", "mmHg"}) {
    const std::size_t at = code.find("assert(calot.units." + std::string(inexact));
    code.erase(at, code.find('\n', at) - at);
  }
  const Result<std::unique_ptr<ExerciseScript>> loaded = test::load_text(folder, code);
  EXPECT_TRUE(loaded) << to_text(loaded.failure());
}

// ---- limits and defaults

/// A scene of which one number is replaced: { organs = { { ... } } } and so on, for a key of a table.
std::optional<Value> scene_with(const std::string& table, const std::string& key, double number) {
  const auto entry = [](const std::string& name, Value value) {
    Value holder;
    holder.kind = Value::Kind::table;
    holder.fields.push_back({name, std::move(value)});
    return holder;
  };
  const auto listed = [](Value value) {
    Value holder;
    holder.kind = Value::Kind::table;
    holder.items.push_back(std::move(value));
    return holder;
  };
  const auto text = [](const std::string& content) {
    Value value;
    value.kind = Value::Kind::text;
    value.text = content;
    return value;
  };
  Value value;
  value.kind = Value::Kind::number;
  value.number = number;
  Value holder = entry(key, value);
  const auto in_scene = [&](const std::string& name, Value inner) {
    Value scene = entry(name, std::move(inner));
    if (name != "anatomy") scene.fields.push_back({"anatomy", entry("base", text("standard"))});
    return scene;
  };
  const auto in_organ = [&](const std::string& name, Value inner) {
    return in_scene("anatomy", entry("organs", listed(entry(name, std::move(inner)))));
  };
  if (table == "solver" || table == "laparoscope") return in_scene(table, holder);
  if (table == "anatomy") {
    holder.fields.push_back({"base", text("standard")});
    return in_scene(table, holder);
  }
  if (table == "organ") return in_scene("anatomy", entry("organs", listed(holder)));
  if (table == "wall" || table == "bile") return in_organ(table, holder);
  if (table == "fibres") return in_organ("wall", entry(table, holder));
  if (table == "held") {
    holder.fields.push_back({"landmark", text("bed")});
    return in_organ("held", listed(holder));
  }
  if (table == "instrument") {
    holder.fields.push_back({"port", text("right_flank")});
    const KeyOwner owner = api_table(table).find(key)->owner;
    if (owner == KeyOwner::clips) holder.fields.push_back({"type", text("clip_applier")});
    if (owner == KeyOwner::needle) holder.fields.push_back({"type", text("aspiration_needle")});
    if (owner == KeyOwner::current) holder.fields.push_back({"type", text("l_hook")});
    return in_scene("instruments", entry("left", holder));
  }
  if (table == "shape_pear" || table == "shape_sphere") {
    holder.fields.push_back({"type", text(table.substr(6))});
    return in_organ("shape", holder);
  }
  return std::nullopt;  // shape_obj needs a file
}

bool complains(const Value& scene, const std::string& key) {
  FieldCheck check;
  std::vector<Problem> problems = validate(read_scene(check, scene, {}));
  for (Problem& problem : check.take()) problems.push_back(std::move(problem));
  for (const Problem& problem : problems) {
    const std::string& path = problem.place.path;
    const bool here = path.size() > key.size() && path.ends_with("." + key);
    if (here && problem.message.find("thin shell") == std::string::npos &&
        problem.message.find("wider than long") == std::string::npos)
      return true;  // relations between two keys are no limits of one
  }
  return false;
}

TEST(Api, LimitsOfTheSceneAreThoseOfItsValidation) {
  int tested = 0;
  for (const KeyTable& table : api_tables()) {
    if (!table.checked_by_validate) continue;
    for (const Key& key : table.keys) {
      if (key.kind != KeyKind::number) continue;
      const double step =
          key.name == "nodes" || key.name == "clips" ? 1 : 1e-6 * (std::abs(key.low) + std::abs(key.high));
      if (!scene_with(table.name, key.name, 0)) continue;
      const std::string name = table.name + "." + key.name;
      EXPECT_FALSE(complains(*scene_with(table.name, key.name, key.low), key.name)) << name;
      EXPECT_FALSE(complains(*scene_with(table.name, key.name, key.high), key.name)) << name;
      EXPECT_TRUE(complains(*scene_with(table.name, key.name, key.low - step), key.name)) << name;
      EXPECT_TRUE(complains(*scene_with(table.name, key.name, key.high + step), key.name)) << name;
      ++tested;
    }
  }
  EXPECT_GT(tested, 20);
}

/// Every default that the table states, written out in a scenario, leaves the definitions as they are.
TEST(Api, DefaultsAreThoseOfTheDefinitions) {
  const auto written = [](const std::string& table) {
    std::string text;
    for (const Key& key : api_table(table).keys)
      if (!key.fallback.empty() && key.name != "type" &&
          (key.owner == KeyOwner::all || key.owner == KeyOwner::jaws))
        text += key.name + " = " + key.fallback + ", ";
    return text;
  };
  test::ScenarioText text;
  text.head = "local kPa = calot.units.kPa";
  text.scene = "return { anatomy = { organs = { { " + written("organ") + "shape = { " +
               written("shape_pear") + "},\nwall = { " + written("wall") + "fibres = { " + written("fibres") +
               "} }, bile = { " + written("bile") + "}, held = { { landmark = 'bed', " + written("held") +
               "} } } },\n" + written("anatomy") + "}, laparoscope = { " + written("laparoscope") +
               "},\nsolver = { " + written("solver") + "}, instruments = { left = { port = 'right_flank', " +
               written("instrument") + "} } }";
  test::ScenarioText plain;
  plain.scene =
      "return { anatomy = { organs = { { wall = { fibres = {} }, held = { { landmark = 'bed' } } } } },\n"
      "instruments = { left = { port = 'right_flank' } } }";
  const Folder folder;
  const auto a = test::load_text(folder, text.text()), b = test::load_text(folder, plain.text());
  ASSERT_TRUE(a) << to_text(a.failure());
  ASSERT_TRUE(b) << to_text(b.failure());
  const SceneDefinition &one = a.value()->definition().scene, &other = b.value()->definition().scene;
  const OrganDefinition &organ = one.anatomy.organs[0], &same = other.anatomy.organs[0];
  const double rounding = 1e-9;  // relative, of limits written with six digits and multiplied by units
  const auto near = [&](double x, double y) { return std::abs(x - y) <= rounding * std::abs(y); };
  EXPECT_EQ(organ.nodes, same.nodes);
  EXPECT_TRUE(organ.neck.isApprox(same.neck, rounding));
  EXPECT_TRUE(organ.fundus.isApprox(same.fundus, rounding));
  EXPECT_TRUE(organ.liver_side.isApprox(same.liver_side, rounding));
  const PearShape pear = std::get<PearShape>(organ.shape), like = std::get<PearShape>(same.shape);
  EXPECT_TRUE(near(pear.length, like.length) && near(pear.width, like.width) &&
              near(pear.refine, like.refine) && near(pear.refine_radius, like.refine_radius));
  EXPECT_TRUE(near(organ.wall.thickness, same.wall.thickness) &&
              near(organ.wall.shear_modulus, same.wall.shear_modulus) &&
              near(organ.wall.overstretch, same.wall.overstretch) &&
              near(organ.wall.stiffening, same.wall.stiffening));
  ASSERT_TRUE(organ.wall.fibres && same.wall.fibres);
  EXPECT_TRUE(near(organ.wall.fibres->stiffness, same.wall.fibres->stiffness) &&
              near(organ.wall.fibres->stiffening, same.wall.fibres->stiffening) &&
              near(organ.wall.fibres->angle, same.wall.fibres->angle));
  EXPECT_TRUE(near(organ.bile.density, same.bile.density));
  EXPECT_TRUE(near(organ.held[0].radius, same.held[0].radius) &&
              near(organ.held[0].stiffness, same.held[0].stiffness));
  EXPECT_TRUE(near(one.anatomy.table_head_up, other.anatomy.table_head_up) &&
              near(one.anatomy.table_left_down, other.anatomy.table_left_down));
  EXPECT_TRUE(near(one.laparoscope.angle, other.laparoscope.angle) &&
              near(one.laparoscope.distance, other.laparoscope.distance) &&
              near(one.laparoscope.field_of_view, other.laparoscope.field_of_view));
  EXPECT_EQ(one.laparoscope.port + one.laparoscope.look_at,
            other.laparoscope.port + other.laparoscope.look_at);
  EXPECT_TRUE(near(one.solver.rate, other.solver.rate) && near(one.solver.tolerance, other.solver.tolerance));
  EXPECT_TRUE(near(one.instruments[0].force_limit, other.instruments[0].force_limit));
}

}  // namespace
}  // namespace calot
