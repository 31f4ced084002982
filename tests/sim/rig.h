#pragma once
// A grasper on a gallbladder, driven along straight ways.

#include <atomic>
#include <functional>
#include <optional>

#include "world/world.h"

namespace calot::test {

inline constexpr double open_jaw = 0.8;  // rad

/// The standard gallbladder with one grasper, "left".
inline SceneDefinition grasper_scene(int nodes = 120) {
  SceneDefinition scene;
  scene.anatomy = named_anatomy("standard").value();
  scene.anatomy.organs[0].nodes = nodes;
  InstrumentDefinition left;
  left.name = "left";
  left.port = "right_subcostal";
  scene.instruments.push_back(left);
  return scene;
}

/// A ball of 20 mm radius that stands firmly under the grasper's port, grown on by its lower half, well filled: most
/// laws of grasps hold on it too, and it has a third of a gallbladder's skin.
inline OrganDefinition bedded_ball() {
  OrganDefinition organ;
  organ.name = "ball";
  organ.shape = SphereShape{20e-3};
  organ.nodes = 61;
  organ.neck = Vec3(-80e-3, 70e-3, -150e-3);
  organ.fundus = organ.neck + Vec3(0, 0, 40e-3);
  organ.held = {{"base", "neck", 22e-3, 1e6}};
  organ.bile.fill_pressure = 1600;
  return organ;
}

/// It under a grasper, "left", on a level table.
inline SceneDefinition ball_scene(const OrganDefinition& ball = bedded_ball()) {
  SceneDefinition scene = grasper_scene();
  scene.anatomy = {};
  scene.anatomy.organs = {ball};
  scene.anatomy.table_head_up = scene.anatomy.table_left_down = 0;
  scene.laparoscope.look_at = ball.name + ".fundus";
  return scene;
}

/// With jaws that are strong enough to close until a fold of any wall fills them, and walls that bear that.
inline SceneDefinition with_strong_jaws(SceneDefinition scene) {
  scene.instruments[0].pinch_force = 100;
  scene.anatomy.organs[0].wall.pinch_limit = 100;
  return scene;
}

/// The standard gallbladder with an instrument of another type.
inline SceneDefinition scene_with(InstrumentType type) {
  SceneDefinition scene = grasper_scene();
  InstrumentDefinition tool = default_instrument(type);
  tool.name = "left";
  tool.port = scene.instruments[0].port;
  scene.instruments[0] = tool;
  return scene;
}

/// Moves the one instrument of a world; collects what happens on the way.
class Driver {
 public:
  explicit Driver(World& world, double roll = 0)
      : world_(world),
        geometry_(instrument_geometry(world.scene().instruments[0].type)),
        trocar_(world.port_position(world.scene().instruments[0].port)),
        roll_(roll) {
    tip_ = world.report().instruments[0].tip;
  }

  std::function<void(const StepReport&)> watch = [](const StepReport&) {};
  std::vector<WorldEvent> events;
  std::optional<Failure> failure;

  /// Evenly to a place and an opening of the jaws; false when a step failed.
  bool go(const Vec3& tip, double jaw, int steps) {
    const Vec3 from = tip_;
    const double jaw_from = jaw_;
    for (int k = 1; k <= steps && !failure; ++k) {
      const double share = static_cast<double>(k) / steps;
      tip_ = from + share * (tip - from);
      jaw_ = jaw_from + share * (jaw - jaw_from);
      StepInput input;
      input.instruments = {pose_reaching(trocar_, tip_, roll_, jaw_, geometry_)};
      const Result<StepReport> report = world_.step(input);
      if (!report) {
        failure = report.failure();
        break;
      }
      for (const WorldEvent& event : report.value().events) events.push_back(event);
      watch(report.value());
    }
    return !failure;
  }
  bool stay(int steps) { return go(tip_, jaw_, steps); }
  /// Goes on from where another driver of the same world was.
  void follow(const Driver& other) {
    tip_ = other.tip_;
    jaw_ = other.jaw_;
  }

  const Vec3& trocar() const { return trocar_; }
  int count(EventKind kind) const {
    int n = 0;
    for (const WorldEvent& event : events) n += event.kind == kind;
    return n;
  }
  std::string why() const { return failure ? to_text(*failure) : std::string(); }

 private:
  World& world_;
  InstrumentGeometry geometry_;
  Vec3 trocar_, tip_;
  double roll_, jaw_ = 0;
};

/// Presses on a place of the skin (`out`: from there towards the trocar) with open jaws and closes them.
inline bool grasp(Driver& driver, const Vec3& place, const Vec3& out, int steps) {
  return driver.go(place + 15e-3 * out, open_jaw, steps) && driver.go(place + 2e-3 * out, open_jaw, steps) &&
         driver.go(place - 4e-3 * out, open_jaw, steps) && driver.go(place - 4e-3 * out, 0.0, 2 * steps);
}

/// Grasp at the fundus, lift by 8 mm, let go there and withdraw: the way most laws are watched along.
struct FundusPath {
  World world;
  Driver driver;
  Vec3 fundus, out;

  explicit FundusPath(const SceneDefinition& scene, int threads = 1, const std::atomic<bool>* stop = nullptr)
      : world(World::create(scene, stop, threads).value()),
        driver(world),
        fundus(world.landmark(scene.anatomy.organs[0].name + ".fundus")),
        out((driver.trocar() - fundus).normalized()) {}

  bool grasp(int steps = 5) { return test::grasp(driver, fundus, out, steps); }
  bool lift(int steps = 5) { return driver.go(fundus + 4e-3 * out, 0.0, steps); }
  bool lower(int steps = 5) { return driver.go(fundus - 4e-3 * out, 0.0, steps); }
  bool release(int steps = 4) { return driver.go(fundus + 4e-3 * out, open_jaw, steps); }
  bool withdraw(int steps = 4) { return driver.go(fundus + 30e-3 * out, open_jaw, steps); }
};

}  // namespace calot::test
