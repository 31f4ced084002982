// Random instrument paths through and around an organ: each ends in equilibrium with the jaws outside the skin, or
// as a failure that says where, when and what to change. Every fifth with structural extensions.

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "rig.h"
#include "support/bodies.h"
#include "support/long_run.h"
#include "tools/tool.h"

namespace calot::random_paths_test {
namespace {

constexpr double most_depth = 0.1e-3;  // m

SceneDefinition ball_scene() {
  SceneDefinition scene;
  OrganDefinition ball;
  ball.name = "ball";
  ball.shape = SphereShape{20e-3};
  ball.nodes = 61;
  ball.neck = {-60e-3, 100e-3, -120e-3};
  ball.fundus = {-60e-3, 100e-3, -80e-3};
  ball.held = {{"base", "neck", 10e-3, 4e6}};  // firm: a softer one is near its buckling load
  scene.anatomy.organs = {ball};
  scene.laparoscope.look_at = "ball.fundus";
  InstrumentDefinition left;
  left.name = "left";
  left.port = "right_subcostal";
  scene.instruments = {left};
  return scene;
}

TEST(RandomPaths, EndInEquilibriumOrSayWhereWhenAndWhatToChange) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of steps");
  const int paths = test::cases(20, 400);
  SceneDefinition scene = ball_scene();
  int followed = 0, touched = 0, changed = 0, refused = 0;
  for (int number = 0; number < paths; ++number) {
    Rng rng(77 + static_cast<std::uint64_t>(number));
    scene.solver.extension_levels = number % 5 == 0 ? 1 : 0;
    World world = World::create(scene).value();
    const double volume = world.report().organs[0].volume;
    const Vec3 trocar = world.port_position("right_subcostal"), fundus = world.landmark("ball.fundus");
    InstrumentPose from = world.report().instruments[0].pose;
    bool touching = false;
    std::optional<Failure> failure;
    for (int leg = 0; leg < 3 && !failure; ++leg) {
      // Places up to 5 mm under the skin's highest point and as far above it, jaws anyhow.
      const Vec3 place = fundus + test::random_vector(rng, 5e-3);
      const InstrumentPose to = pose_reaching(trocar, place, rng.uniform(-0.5, 0.5), rng.uniform(0.0, 1.0));
      const int steps = leg == 0 ? 10 : 6;
      for (int k = 1; k <= steps && !failure; ++k) {
        const Result<StepReport> report =
            world.step({.instruments = {interpolate(from, to, static_cast<double>(k) / steps)}});
        if (!report) {
          failure = report.failure();
          continue;
        }
        changed += report->statistics.extensions_changed;
        refused += report->statistics.extensions_refused;
      }
      from = to;
      touching |= world.report().instruments[0].touching;
    }
    touched += touching;
    if (failure) {
      const std::string text = to_text(*failure);
      EXPECT_EQ(failure->kind, FailureKind::simulation) << text;
      EXPECT_NE(text.find(" mm"), std::string::npos) << "where? " << text;
      EXPECT_NE(text.find(" s"), std::string::npos) << "when? " << text;
      EXPECT_FALSE(failure->problems[0].hint.empty()) << "what to change? " << text;
      continue;
    }
    ++followed;
    EXPECT_LT(world.deepest_penetration(), most_depth) << "path " << number;
    EXPECT_LT(std::abs(world.report().organs[0].volume / volume - 1), 1e-9) << "path " << number;
  }
  EXPECT_GT(changed, paths / 5) << "paths with extensions that never change test nothing";
  EXPECT_LE(20 * refused, changed) << "of " << changed << " changes of extensions";
  EXPECT_GE(touched, paths / 2) << "paths that touch nothing test nothing";
  // Places are chosen blindly: one path in fifty may ask for what cannot be.
  EXPECT_GE(followed, paths - paths / 50);
}

}  // namespace
}  // namespace calot::random_paths_test
