// The mistakes that hurt a patient, as the clumsy demos make them: each is an event, costs the exercise, and is seen in
// the picture. Each demo is played once.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

#include "play/play.h"
#include "render/offscreen.h"
#include "support/long_run.h"
#include "support/paths.h"
#include "view/build_scene.h"
#include "view/clip_mesh.h"

namespace calot {
namespace {

/// What is seen of an error: the scene some time after it, and the same without what the error brought.
struct Sight {
  Scene with, without;
};

/// Takes what an error brought out of a scene.
using Eraser = std::function<void(Scene&, const World&)>;

struct Mistake {
  EventKind kind;
  std::string organ;  ///< or a piece of it; empty: any or none
  Eraser erase;
};

template <Material liquid>
void erase(Scene& scene, const World&) {
  std::erase_if(scene.meshes, [](const SceneMesh& mesh) { return mesh.material == liquid; });
}

void erase_meshes(const std::vector<SceneMesh>& unwanted, Scene& scene) {
  for (const SceneMesh& one : unwanted)
    std::erase_if(scene.meshes, [&](const SceneMesh& mesh) { return mesh.positions == one.positions; });
}

void erase_clips(Scene& scene, const World& world) {
  for (const Organ& organ : world.field().organs) erase_meshes(clip_meshes(organ), scene);
}

void erase_fallen_clips(Scene& scene, const World& world) {
  erase_meshes(fallen_clips(world.field()), scene);
}

void erase_burns(Scene& scene, const World&) {
  for (SceneMesh& mesh : scene.meshes) mesh.burnt.clear();
}

/// A demo, played once, and what was seen 0.4 s after the first of each mistake.
struct Playback {
  Playback(const std::string& scenario, std::map<std::string, std::string> params,
           const std::vector<Mistake>& mistakes = {})
      : sights(mistakes.size()) {
    PlayRequest request;
    request.scenario = source_dir() + "/scenarios/" + scenario;
    request.params = std::move(params);
    request.render = false;
    std::optional<SceneBuilder> builder;
    request.on_state = [&](const World& world, const Progress& progress) {
      if (!builder) builder.emplace(world);
      builder->follow(world);
      for (std::size_t i = 0; i < mistakes.size(); ++i) {
        if (sights[i]) continue;
        for (const SessionEvent& event : progress.events()) {
          if (!is_event(event, to_text(mistakes[i].kind), mistakes[i].organ)) continue;
          if (world.report().time < event.time + 0.4) break;
          sights[i].emplace(Sight{builder->build(world), builder->build(world)});
          mistakes[i].erase(sights[i]->without, world);
          break;
        }
      }
    };
    Result<Played> result = play(request);
    if (result)
      played = std::move(result.value());
    else
      failure = to_text(result.failure());
  }

  int count(EventKind kind, const std::string& organ = "") const {
    const std::vector<SessionEvent>& events = played->session.progress.events();
    return static_cast<int>(std::count_if(events.begin(), events.end(), [&](const SessionEvent& event) {
      return is_event(event, to_text(kind), organ);
    }));
  }
  /// Whether a gate was tripped, or a part lost points, by an event of that kind.
  bool costs(EventKind kind) const {
    const Score& score = played->report.score;
    const std::string name(to_text(kind));
    return std::any_of(score.gates.begin(), score.gates.end(),
                       [&](const TrippedGate& gate) {
                         return gate.event == name || gate.explanation.find(name) != std::string::npos;
                       }) ||
           std::any_of(score.parts.begin(), score.parts.end(), [&](const ScoredPart& part) {
             return part.fraction < 1 && part.explanation.find(name) != std::string::npos;
           });
  }

  std::vector<std::optional<Sight>> sights;
  std::optional<Played> played;
  std::string failure;
};

/// How many pixels differ visibly between two scenes.
int visible_pixels(const Sight& sight) {
  const int width = 960, height = 540;
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(width, height);
  EXPECT_TRUE(renderer) << to_text(renderer.failure());
  if (!renderer) return 0;
  const Result<Image> with = renderer->render(sight.with), without = renderer->render(sight.without);
  EXPECT_TRUE(with && without);
  if (!with || !without) return 0;
  int count = 0;
  for (std::size_t i = 0; i < with->rgb.size(); i += 3) {
    int apart = 0;
    for (std::size_t c = 0; c < 3; ++c)
      apart = std::max(apart, std::abs(with->rgb[i + c] - without->rgb[i + c]));
    if (apart > 24) ++count;  // of 255: plain to the eye
  }
  return count;
}

constexpr int plain_to_see = 60;  // pixels: a stroke of 20 by 3

}  // namespace

TEST(OperationErrors, EachMistakeOfTheDivisionIsAnEventCostsPointsAndIsSeen) {
  const std::vector<Mistake> mistakes{
      {EventKind::perforation, "gallbladder", erase<Material::bile>},
      {EventKind::injury, "common_duct", erase_clips},
      {EventKind::clip_dropped, "", erase_fallen_clips},
      {EventKind::injury, "common_duct",
       erase_burns},  // when the hook is out of the way, and the bile has run off
      {EventKind::cut_unclipped, "cystic_duct", erase<Material::bile>},
  };
  const Playback clumsy("critical_view.lua", {{"demo", "clumsy"}}, mistakes);
  ASSERT_TRUE(clumsy.played) << clumsy.failure;
  EXPECT_EQ(clumsy.played->session.end, SessionEnd::steps_done) << to_text(clumsy.played->session.failure);
  for (std::size_t i = 0; i < mistakes.size(); ++i) {
    const std::string name(to_text(mistakes[i].kind));
    EXPECT_GT(clumsy.count(mistakes[i].kind, mistakes[i].organ), 0) << name;
    if (event_row(mistakes[i].kind).error) {
      EXPECT_TRUE(clumsy.costs(mistakes[i].kind)) << name;
    }
    ASSERT_TRUE(clumsy.sights[i]) << name;
    EXPECT_GT(visible_pixels(*clumsy.sights[i]), plain_to_see) << name;
  }
  EXPECT_FALSE(clumsy.played->report.score.passed());
  EXPECT_LE(clumsy.played->report.score.total, 40) << "the cap of what hurts a patient";
}

TEST(OperationErrors, AnArteryThatIsCutUnclippedBleedsAndIsSeenToDoSo) {
  const std::vector<Mistake> mistakes{{EventKind::cut_unclipped, "cystic_artery", erase<Material::blood>}};
  const Playback clumsy("clip_and_divide.lua", {{"demo", "clumsy"}, {"structure", "cystic_artery"}},
                        mistakes);
  ASSERT_TRUE(clumsy.played) << clumsy.failure;
  EXPECT_GT(clumsy.count(EventKind::bleeding), 0);
  EXPECT_TRUE(clumsy.costs(EventKind::cut_unclipped));
  ASSERT_TRUE(clumsy.sights[0]);
  EXPECT_GT(visible_pixels(*clumsy.sights[0]), plain_to_see);
  EXPECT_FALSE(clumsy.played->report.score.passed());
}

TEST(OperationErrors, WhoBeginsAtTheFundusFreesItWhileDuctAndArteryStand) {
  if (!test::long_run()) GTEST_SKIP() << "dissects for three minutes";
  const Playback fundus_first("fundus_first.lua", {});
  ASSERT_TRUE(fundus_first.played) << fundus_first.failure;
  EXPECT_GE(fundus_first.played->session.metrics.at("note.fundus_free_pct"), 95);
  EXPECT_GE(fundus_first.played->session.metrics.at("cystic_plate.torn_pct"), 50);
  EXPECT_EQ(fundus_first.played->session.metrics.at("triangle_fat.torn_pct"), 0);
  for (EventKind kind : {EventKind::perforation, EventKind::cut, EventKind::injury, EventKind::overforce})
    EXPECT_EQ(fundus_first.count(kind), 0) << static_cast<int>(kind);
  EXPECT_GT(fundus_first.played->report.score.total, 95);
}

TEST(OperationErrors, WhoBailsOutOfAFrozenTrianglePasses) {
  if (!test::long_run()) GTEST_SKIP() << "tries for a quarter of a minute";
  const Playback wise("dissect_to_critical_view.lua", {{"field", "frozen"}, {"demo", "bail_out"}});
  ASSERT_TRUE(wise.played) << wise.failure;
  EXPECT_EQ(wise.count(EventKind::bail_out), 1);
  EXPECT_EQ(wise.count(EventKind::divided), 0) << "tissue that gives way is no reason to bail out";
  EXPECT_TRUE(wise.played->report.score.passed());
  EXPECT_GT(wise.played->report.score.total, 99);
}

TEST(OperationErrors, TheExpertsHandDoesNotReachTheCriticalViewInAFrozenTriangle) {
  if (!test::long_run()) GTEST_SKIP() << "tries for a minute";
  const Playback stubborn("dissect_to_critical_view.lua", {{"field", "frozen"}});
  ASSERT_TRUE(stubborn.played) << stubborn.failure;
  EXPECT_LT(stubborn.played->session.metrics.at("note.critical_view"), 5);
  EXPECT_FALSE(stubborn.played->report.score.passed());
}

TEST(OperationErrors, WhoTurnsThePouchOverReachesAllSixPointsOfTheCriticalView) {
  if (!test::long_run()) GTEST_SKIP() << "dissects for most of a minute";
  const Playback turned("dissect_to_critical_view.lua", {{"flip", "true"}});
  ASSERT_TRUE(turned.played) << turned.failure;
  EXPECT_EQ(turned.played->session.metrics.at("note.critical_view"), 6);
  EXPECT_EQ(turned.count(EventKind::perforation), 0);
  EXPECT_GT(turned.played->report.score.total, 95);
}

TEST(OperationErrors, WhoBailsOutOfTissueThatGivesWayDoesNotPass) {
  if (!test::long_run()) GTEST_SKIP() << "dissects for a quarter of a minute";
  const Playback timid("dissect_to_critical_view.lua", {{"demo", "bail_out"}});
  ASSERT_TRUE(timid.played) << timid.failure;
  EXPECT_GT(timid.count(EventKind::divided), 0);
  EXPECT_FALSE(timid.played->report.score.passed());
}

}  // namespace calot
