// Whatever hands do to the field of liver_bed.lua: a gallbladder in its areolar plane, beside the stumps of duct and artery.

#include <gtest/gtest.h>

#include "lua/scenario_files.h"
#include "sim/random_acts.h"
#include "support/long_run.h"

namespace calot {
namespace {

// Four seconds an act, and a suite has an hour.
TEST(BedField, ActsOfWhateverHandsAreFollowedOrSayWhy) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of steps of a whole field");
  LoadOptions options;
  options.modules = std::filesystem::path(source_dir()) / "scripts/lua";
  const auto loaded = load_exercise(source_dir() + "/scenarios/liver_bed.lua", options);
  ASSERT_TRUE(loaded) << to_text(loaded.failure());
  test::perform(loaded.value()->definition().scene, 11, test::cases(15, 700), 0.1);
}

}  // namespace
}  // namespace calot
