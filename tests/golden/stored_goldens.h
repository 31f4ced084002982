#pragma once
// The project's goldens, and what must not pass for one.

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "goldens/judge.h"
#include "play/play.h"
#include "render/offscreen.h"
#include "support/paths.h"

namespace calot::test {

struct Stored {
  std::string scenario, frame;
  Golden golden;
};

/// Every golden of the project.
inline std::vector<Stored> stored_goldens() {
  namespace fs = std::filesystem;
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

/// The stored golden's state with another picture: it fails by the tolerance for other machines, and so exactly.
inline void expect_caught(const Stored& stored, const Image& image, const std::string& what) {
  Golden changed = stored.golden;
  changed.image = image;
  changed.sidecar.renderer = "another renderer";
  EXPECT_FALSE(judge(stored.golden, changed).passed)
      << stored.scenario << "/" << stored.frame << " does not notice " << what;
}

/// A moved light, a brighter one and a missing instrument show in every frame.
inline void expect_mutations_caught(const std::vector<Stored>& goldens,
                                    const std::map<std::string, Scene>& scenes, int width, int height) {
  const std::pair<const char*, std::function<void(Scene&)>> mutations[] = {
      {"the light moved by 2% of its distance", [](Scene& s) { s.camera.light_offset.x() += 0.02 * 90e-3; }},
      {"the light brighter by 2%", [](Scene& s) { s.camera.light_intensity *= 1.02; }},
      {"a missing instrument",
       [](Scene& s) {
         std::erase_if(s.meshes, [](const SceneMesh& mesh) {
           return mesh.material == Material::steel || mesh.material == Material::insulation;
         });
       }},
  };
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(width, height);
  ASSERT_TRUE(renderer) << to_text(renderer.failure());
  for (const Stored& stored : goldens) {
    for (const auto& [what, mutate] : mutations) {
      Scene scene = scenes.at(stored.frame);
      mutate(scene);
      const Result<Image> image = renderer->render(scene);
      ASSERT_TRUE(image) << to_text(image.failure());
      expect_caught(stored, image.value(), what);
    }
  }
}

}  // namespace calot::test
