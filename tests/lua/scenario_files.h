#pragma once
// Scenarios written for one test.

#include <filesystem>
#include <string>

#include "lua/load_exercise.h"
#include "support/paths.h"
#include "support/text_files.h"

namespace calot::test {

/// A sound exercise, its parts replaceable. `head` is Lua before it.
struct ScenarioText {
  std::string head = "";
  std::string params = "{}";
  std::string scene =
      "return { anatomy = calot.anatomy(\"standard\"),\n"
      "  instruments = { left = { port = \"right_subcostal\" } } }";
  std::string steps = "t:step(\"look\", \"Look\") t:wait(1 * s)";
  std::string demo = "t:wait(1 * s)";
  std::string score =
      "calot.score.weighted { { calot.score.benchmark { metric = \"total.time_s\", novice = 2, expert = 1 }, "
      "weight = 1 } }";
  std::string more = "";  ///< further keys

  std::string text() const {
    return "local calot = require \"calot\"\n"
           "local mm, s, N, deg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg\n" +
           head +
           "\nreturn calot.exercise {\n  api = 1, id = \"test\", title = \"Test\",\n  params = " + params +
           ",\n  scene = function(p)\n" + scene + "\nend,\n  steps = function(t, p)\n" + steps +
           "\nend,\n  demo = function(t, p)\n" + demo + "\nend,\n  score = " + score + ",\n" + more + "\n}\n";
  }
};

inline ScenarioText with_scene(const std::string& scene) {
  ScenarioText text;
  text.scene = scene;
  return text;
}
inline ScenarioText with_anatomy(const std::string& anatomy) {
  return with_scene("return {\n anatomy = " + anatomy +
                    ",\n instruments = { left = { port = 'right_subcostal' } } }");
}
inline ScenarioText with_steps(const std::string& steps) {
  ScenarioText text;
  text.steps = steps;
  return text;
}

inline Result<std::unique_ptr<ExerciseScript>> load_text(const Folder& folder, const std::string& text,
                                                         LoadOptions options = {}) {
  if (options.modules.empty()) options.modules = std::filesystem::path(source_dir()) / "scripts/lua";
  return load_exercise(folder.write("test.lua", text), options);
}

}  // namespace calot::test
