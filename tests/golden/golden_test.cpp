// The test of the test: what the golden images are there to catch, they catch. And they match.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "app/golden_store.h"
#include "app/play.h"
#include "render/offscreen.h"
#include "support/paths.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

struct Stored {
  std::string scenario, frame;
  Golden golden;
};

/// Every golden of the project.
std::vector<Stored> stored_goldens() {
  std::vector<Stored> all;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source_dir() + "/golden")) {
    if (entry.path().extension() != ".json") continue;
    fs::path stem = entry.path();
    stem.replace_extension();
    const Result<Golden> golden = read_golden(stem);
    EXPECT_TRUE(golden) << to_text(golden.failure());
    const fs::path scenario = stem.parent_path().lexically_relative(source_dir() + "/golden");
    if (golden) all.push_back({scenario, stem.filename(), golden.value()});
  }
  std::sort(all.begin(), all.end(), [](const Stored& a, const Stored& b) {
    return std::tie(a.scenario, a.frame) < std::tie(b.scenario, b.frame);
  });
  return all;
}

/// The stored golden's state and make with another picture: it fails exactly and by the tolerance for other
/// machines.
void expect_caught(const Stored& stored, const Image& image, const std::string& what) {
  for (const bool elsewhere : {false, true}) {
    Golden changed = stored.golden;
    changed.image = image;
    if (elsewhere) changed.sidecar.renderer = "another renderer";
    const Judgement judgement = judge(stored.golden, changed);
    EXPECT_FALSE(judgement.passed) << stored.scenario << "/" << stored.frame << " does not notice " << what
                                   << (elsewhere ? " on another machine" : "");
  }
}

Image filled(const Image& like, unsigned char level) {
  Image image = like;
  std::fill(image.rgb.begin(), image.rgb.end(), level);
  return image;
}

Image shifted(const Image& image, int dx, int dy) {
  Image result = image;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int from_x = std::clamp(x - dx, 0, image.width - 1),
                from_y = std::clamp(y - dy, 0, image.height - 1);
      for (int c = 0; c < 3; ++c) {
        result.rgb[3 * (y * image.width + x) + c] = image.rgb[3 * (from_y * image.width + from_x) + c];
      }
    }
  }
  return result;
}

TEST(Golden, EachFailsAgainstEveryOtherAgainstBlankAndShiftedByOnePixel) {
  const std::vector<Stored> goldens = stored_goldens();
  ASSERT_FALSE(goldens.empty()) << "accept some: calot golden accept grasp_and_traction";
  for (const Stored& stored : goldens) {
    EXPECT_TRUE(judge(stored.golden, stored.golden).passed);
    for (const Stored& other : goldens) {
      if (&other != &stored) expect_caught(stored, other.golden.image, other.scenario + "/" + other.frame);
    }
    expect_caught(stored, filled(stored.golden.image, 0), "a black frame");
    expect_caught(stored, filled(stored.golden.image, 255), "a white frame");
    expect_caught(stored, shifted(stored.golden.image, 1, 0), "a shift by one pixel to the right");
    expect_caught(stored, shifted(stored.golden.image, 0, 1), "a shift by one pixel down");
  }
}

using Mutation = std::function<void(Scene&)>;

void remove_instruments(Scene& scene) {
  std::erase_if(scene.meshes, [](const SceneMesh& mesh) {
    return mesh.material == Material::steel || mesh.material == Material::insulation;
  });
}

/// The frames of the scenarios we ship but the main one, which the next test plays.
TEST(Golden, TheOtherScenariosMatch) {
  const std::vector<Stored> goldens = stored_goldens();
  std::map<std::string, Played> sessions;
  for (const Stored& stored : goldens) {
    if (stored.scenario == "grasp_and_traction") continue;
    auto session = sessions.find(stored.scenario);
    if (session == sessions.end()) {
      PlayRequest request;
      request.scenario = source_dir() + "/scenarios/" + stored.scenario + ".lua";
      Result<Played> played = play(request);
      ASSERT_TRUE(played) << to_text(played.failure());
      session = sessions.emplace(stored.scenario, std::move(played).value()).first;
    }
    const Played& played = session->second;
    const auto drawn = std::find_if(played.frames.begin(), played.frames.end(),
                                    [&](const Frame& frame) { return frame.name == stored.frame; });
    ASSERT_NE(drawn, played.frames.end()) << stored.scenario << "/" << stored.frame;
    const Judgement judgement = judge(stored.golden, make_golden(*drawn, played.exercise, played.renderer));
    EXPECT_TRUE(judgement.passed) << stored.scenario << "/" << stored.frame << ": "
                                  << to_text(judgement.verdict) << ": " << judgement.message;
  }
  EXPECT_FALSE(sessions.empty());
}

TEST(Golden, TheMainScenarioMatchesAndAMovedLightOrAMissingInstrumentIsCaught) {
  const std::vector<Stored> goldens = stored_goldens();
  ASSERT_FALSE(goldens.empty()) << "accept some: calot golden accept grasp_and_traction";
  PlayRequest request;
  request.scenario = source_dir() + "/scenarios/grasp_and_traction.lua";
  std::map<std::string, Scene> scenes;
  request.on_frame = [&](const Scene& scene, const std::string& frame) { scenes[frame] = scene; };
  const Result<Played> played = play(request);
  ASSERT_TRUE(played) << to_text(played.failure());
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(request.width, request.height);
  ASSERT_TRUE(renderer) << to_text(renderer.failure());

  int compared = 0;
  for (const Stored& stored : goldens) {
    if (stored.scenario != "grasp_and_traction") continue;
    const auto drawn = std::find_if(played->frames.begin(), played->frames.end(),
                                    [&](const Frame& frame) { return frame.name == stored.frame; });
    ASSERT_NE(drawn, played->frames.end()) << stored.frame;
    const Judgement judgement = judge(stored.golden, make_golden(*drawn, played->exercise, played->renderer));
    EXPECT_TRUE(judgement.passed) << stored.frame << ": " << to_text(judgement.verdict) << ": "
                                  << judgement.message;
    const std::pair<const char*, Mutation> mutations[] = {
        {"the light moved by 2% of its distance",
         [](Scene& s) { s.camera.light_offset.x() += 0.02 * 90e-3; }},
        {"the light brighter by 2%", [](Scene& s) { s.camera.light_intensity *= 1.02; }},
        {"a missing instrument", remove_instruments},
    };
    for (const auto& [what, mutate] : mutations) {
      Scene scene = scenes.at(stored.frame);
      mutate(scene);
      const Result<Image> image = renderer->render(scene);
      ASSERT_TRUE(image) << to_text(image.failure());
      expect_caught(stored, image.value(), what);
    }
    ++compared;
  }
  EXPECT_GE(compared, 3);
}

}  // namespace
}  // namespace calot
