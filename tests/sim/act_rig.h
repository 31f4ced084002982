#pragma once
// One tube that is held at both ends, across the way of one instrument whose jaws go about it.

#include <gtest/gtest.h>

#include <algorithm>

#include "tools/tool.h"
#include "world/world.h"

namespace calot::test {

inline constexpr double tube_depth = 100e-3;  // m, of the tube below the port

inline OrganDefinition tube_across(const std::string& name = "duct", double y = 0) {
  OrganDefinition organ;
  organ.name = name;
  organ.shape =
      TubeShape{.points = {{0, y - 15e-3, -tube_depth}, {0, y, -tube_depth}, {0, y + 15e-3, -tube_depth}},
                .radius = 1.8e-3,
                .patient_end = PatientEnd::start};
  organ.wall.thickness = 0.8e-3;
  organ.wall.density = 1050;
  organ.held = {{"first", "start", 4e-3, 1e6}, {"second", "end", 4e-3, 1e6}};
  return organ;
}

/// A tube across the way of an instrument whose jaws are about it.
inline SceneDefinition across(InstrumentType type, SolverMotion motion = SolverMotion::dynamics) {
  SceneDefinition scene;
  scene.anatomy.organs = {tube_across()};
  scene.anatomy.table_head_up = scene.anatomy.table_left_down = 0;
  scene.ports = default_ports();
  scene.ports.push_back({"above", Vec3::Zero()});
  InstrumentDefinition tool = default_instrument(type);
  tool.name = "right";
  tool.port = "above";
  scene.instruments = {tool};
  scene.laparoscope.look_at = "duct.middle";
  scene.solver.motion = motion;
  scene.solver.rate = 50;
  return scene;
}

inline InstrumentPose about(double jaw, double insertion = tube_depth + 6e-3) {
  return {0, 0, insertion, 0, jaw};
}

/// One instrument that goes from pose to pose; what happened on the way.
struct Acting {
  World world;
  std::vector<WorldEvent> events = {};

  explicit Acting(const SceneDefinition& scene) : world(World::create(scene).value()) {}
  testing::AssertionResult go(const InstrumentPose& to, int steps) {
    const InstrumentPose from = world.report().instruments[0].pose;
    for (int k = 1; k <= steps; ++k) {
      const Result<StepReport> step = world.step({{interpolate(from, to, static_cast<double>(k) / steps)}});
      if (!step) return testing::AssertionFailure() << to_text(step.failure());
      events.insert(events.end(), step->events.begin(), step->events.end());
    }
    return testing::AssertionSuccess();
  }
  /// The trigger is pulled and let go.
  testing::AssertionResult fire() {
    const InstrumentPose here = world.report().instruments[0].pose;
    for (const InstrumentAction action : {InstrumentAction::fire, InstrumentAction::none}) {
      const Result<StepReport> step = world.step({{here}, {action}});
      if (!step) return testing::AssertionFailure() << to_text(step.failure());
      events.insert(events.end(), step->events.begin(), step->events.end());
    }
    return testing::AssertionSuccess();
  }
  /// Open, and with the tube between them.
  testing::AssertionResult reach(double jaw = 0.7) {
    const testing::AssertionResult there = go(about(jaw, tube_depth - 20e-3), 2);
    return there ? go(about(jaw), 12) : there;
  }
  int count(EventKind kind) const {
    return static_cast<int>(std::count_if(events.begin(), events.end(),
                                          [&](const WorldEvent& event) { return event.kind == kind; }));
  }
  bool has(const std::string& organ) const { return bool(world.organ(organ)); }
};

}  // namespace calot::test
