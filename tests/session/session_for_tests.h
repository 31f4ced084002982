#pragma once
// A small scene, a script without Lua, and input paths: what the tests of a session share.

#include <cmath>

#include "session/exercise.h"

namespace calot::test {

/// A bile-filled sphere of 61 nodes, held at its bed, and one grasper whose tip waits close to it.
inline SceneDefinition small_scene() {
  SceneDefinition scene;
  OrganDefinition organ;
  organ.name = "ball";
  organ.shape = SphereShape{};
  organ.nodes = 61;
  organ.neck = {-62.7e-3, 97e-3, -55.5e-3};
  organ.fundus = {-92.7e-3, 67e-3, -5.5e-3};
  HeldRegion held;
  held.landmark = "bed";
  organ.held.push_back(held);
  scene.anatomy.organs.push_back(organ);
  InstrumentDefinition grasper;
  grasper.name = "left";
  grasper.port = "right_subcostal";
  scene.instruments.push_back(grasper);
  scene.laparoscope.look_at = "ball.fundus";
  return scene;
}

/// The small scene with scissors that wait for the grasper's port.
inline SceneDefinition shared_port() {
  SceneDefinition scene = small_scene();
  scene.instruments.push_back(default_instrument(InstrumentType::scissors));
  scene.instruments.back().name = "blades";
  scene.instruments.back().port = scene.instruments[0].port;
  scene.instruments.back().waits = true;
  return scene;
}

inline ExerciseDefinition small_exercise() {
  ExerciseDefinition exercise;
  exercise.id = "small";
  exercise.title = "A small exercise";
  exercise.scene = small_scene();
  exercise.step_names = {"only"};
  exercise.file = "small.lua";
  exercise.seed = 7;
  exercise.params = {{"anatomy", "standard"}};
  ScorePart part;
  part.name = part.metric = "only.time_s";
  part.novice = 10;
  part.expert = 0;
  exercise.score.parts.push_back(part);
  return exercise;
}

/// Moves the instruments from where they wait, smoothly, into the ball, for `duration` seconds.
class SwayingSource : public InputSource {
 public:
  explicit SwayingSource(double duration) : duration_(duration) {}
  Result<std::optional<StepInput>> next(const World& world, double dt) override {
    const double time = world.report().time + dt;
    if (rest_.instruments.empty()) {
      for (const InstrumentState& state : world.report().instruments) rest_.instruments.push_back(state.pose);
    }
    if (time > duration_ + dt / 2) return std::optional<StepInput>();
    StepInput input = rest_;
    for (InstrumentPose& pose : input.instruments) {
      pose.pitch += 0.05 * std::sin(7 * time);
      pose.insertion += 0.03 * time;
      pose.roll += 0.3 * time;
    }
    return std::optional<StepInput>(input);
  }

 private:
  double duration_;
  StepInput rest_;
};

/// One step, "only", that is done after `duration` seconds.
class TimedScript : public ExerciseScript {
 public:
  explicit TimedScript(double duration, ExerciseDefinition exercise = small_exercise())
      : duration_(duration), exercise_(std::move(exercise)), demo_(duration) {}
  const ExerciseDefinition& definition() const override { return exercise_; }
  InputSource& demo() override { return demo_; }
  Result<bool> advance(World& world, Progress& progress, double dt) override {
    const double time = world.report().time;
    if (progress.steps().empty()) progress.begin_step(time - dt, "only", "The only step", {0});
    if (time < duration_ - dt / 2) return false;
    progress.end_step(time, "done");
    return true;
  }

 private:
  double duration_;
  ExerciseDefinition exercise_;
  SwayingSource demo_;
};

}  // namespace calot::test
