#pragma once
// A scenario written for one test, played by its demo to its end.

#include <gtest/gtest.h>

#include "lua/scenario_files.h"
#include "session/runner.h"

namespace calot::test {

struct PlayedText {
  SessionResult result;
  std::vector<TissueState> tissues;  ///< that it leaves
  /// The number that its steps noted under a name.
  double noted(const std::string& name) const { return result.metrics.at("note." + name); }
};

inline void play_text(const ScenarioText& text, PlayedText& out, const SessionOptions& options = {},
                      const std::map<std::string, std::string>& params = {}) {
  const Folder folder;
  LoadOptions load;
  load.params = params;
  Result<std::unique_ptr<ExerciseScript>> script = load_text(folder, text.text(), load);
  ASSERT_TRUE(script) << to_text(script.failure());
  Result<World> world = World::create(script.value()->definition().scene);
  ASSERT_TRUE(world) << to_text(world.failure());
  out.result = run_session(world.value(), *script.value(), script.value()->demo(), options);
  ASSERT_EQ(out.result.end, SessionEnd::steps_done) << to_text(out.result.failure);
  out.tissues = world.value().report().tissues;
}

}  // namespace calot::test
