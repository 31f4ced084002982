// Rigid things between jaws: whatever hands of any strength do with them, on a board, in the air and between two tools,
// each step ends within its budget, and what is let go comes down.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/rng.h"
#include "base/units.h"
#include "field/field.h"
#include "support/long_run.h"
#include "support/random.h"
#include "world/world.h"

namespace calot {
namespace {

using units::deg;
using units::mm;

constexpr double board = -120 * mm;
const std::array<Vec3, 2> trocars{Vec3(-120 * mm, 60 * mm, -5 * mm), Vec3(0, 60 * mm, -5 * mm)};
const Vec3 squeezed_at(-60 * mm, 90 * mm, 0);

/// A box, a ball or a ring, of 2 to 22 mm, from pumice to lead, that lies on the board beside a peg.
OrganDefinition random_thing(Rng& rng) {
  RigidShape shape;
  shape.rounding = rng.uniform(0.8 * mm, 3 * mm);
  const double kind = rng.uniform();
  double height = shape.rounding;
  if (kind < 0.4) {
    for (int c = 0; c < 3; ++c) shape.size[c] = rng.uniform(0.5 * mm, 5 * mm);
    height += 0.5 * shape.size.z();
  } else if (kind < 0.7) {
    shape.ring = shape.rounding + rng.uniform(1.5 * mm, 8 * mm);
  }
  shape.density = rng.uniform(400, 11000);
  shape.centre = Vec3(squeezed_at.x(), squeezed_at.y(), board + height + 0.4 * mm);
  OrganDefinition organ;
  organ.name = "thing";
  organ.shape = shape;
  return organ;
}

SceneDefinition random_scene(Rng& rng) {
  SceneDefinition scene;
  scene.anatomy.table_head_up = scene.anatomy.table_left_down = 0;
  scene.anatomy.friction = rng.uniform(0, 0.6);
  scene.anatomy.organs = {random_thing(rng)};
  GroundDefinition floor, peg;
  floor.name = "board";
  floor.point = Vec3(0, 0, board);
  floor.friction = rng.uniform(0, 0.6);
  peg.name = "peg";
  peg.type = GroundType::capsule;
  peg.point = Vec3(squeezed_at.x() + 28 * mm, squeezed_at.y(), board);
  peg.to = peg.point + Vec3(0, 0, 15 * mm);
  peg.radius = 2.5 * mm;
  scene.anatomy.ground = {floor, peg};
  scene.ports = {{"scope", Vec3::Zero()}, {"one", trocars[0]}, {"other", trocars[1]}};
  for (const char* name : {"one", "other"}) {
    InstrumentDefinition tool = default_instrument(rng.uniform() < 0.5 ? InstrumentType::maryland_dissector
                                                                       : InstrumentType::atraumatic_grasper);
    tool.name = name;
    tool.port = name;
    tool.pinch_force = std::exp(rng.uniform(std::log(0.5), std::log(66.0)));
    tool.hand_force = rng.uniform(3, 60);
    tool.pad_friction = rng.uniform(0.1, 2);
    scene.instruments.push_back(tool);
  }
  scene.laparoscope.port = "scope";
  scene.laparoscope.look_at = "thing.centre";
  scene.solver.motion = SolverMotion::dynamics;
  return scene;
}

World made(const SceneDefinition& scene) {
  Result<World> world = World::create(scene);
  EXPECT_TRUE(world) << to_text(world.failure());
  return std::move(world).value();
}

class Squeeze {
 public:
  explicit Squeeze(std::uint64_t seed)
      : rng_(seed), world_(made(random_scene(rng_))), largest_(world_.field().organs[0].body->size()) {
    for (std::size_t k = 0; k < 2; ++k) here_[k] = {world_.report().instruments[k].tip, 0.0};
  }

  void run() {
    take(0);
    if (failed_) return;
    for (int k = 0; k < 3 && !failed_; ++k) go(0, here_[0].tip + lift(), here_[0].jaw, 6);
    if (rng_.uniform() < 0.6) {
      take(1);
      go(1, here_[1].tip + test::random_vector(rng_, 6 * mm), here_[1].jaw, 5);
      if (rng_.uniform() < 0.5) go(0, here_[0].tip, 60 * deg, 4);
    }
    if (rng_.uniform() < 0.4)
      go(0, Vec3(here_[0].tip.x(), here_[0].tip.y(), board - 2 * mm), here_[0].jaw, 10);
    for (std::size_t k : {0, 1}) go(k, here_[k].tip + Vec3(0, 0, 5 * mm), 60 * deg, 4);
    for (std::size_t k : {0, 1}) go(k, here_[k].tip + Vec3(0, -5 * mm, 40 * mm), 0, 8);
    const Vec3 left_at = world_.landmark("thing.centre");
    for (int k = 0; k < 15 && !failed_; ++k) step();
    const std::vector<InstrumentState>& tools = world_.report().instruments;
    const bool on_tool =
        std::any_of(tools.begin(), tools.end(), [](const InstrumentState& tool) { return tool.touching; });
    if (!failed_ && !on_tool) {  // a ring may hang on a jaw
      EXPECT_LT(world_.landmark("thing.centre").z(), board + largest_ + 16 * mm) << "it hangs in the air";
    }
    EXPECT_LE(world_.landmark("thing.centre").z(), left_at.z() + 0.1 * mm) << "it rises with no hand on it";
  }

  bool held = false;  ///< by any jaws, at any time
  int cut_short = 0, steps = 0;

 private:
  struct Hand {
    Vec3 tip;
    double jaw = 0, roll = 0;
  };

  Vec3 lift() {
    return {rng_.uniform(-6 * mm, 6 * mm), rng_.uniform(-6 * mm, 6 * mm), rng_.uniform(0, 8 * mm)};
  }

  /// Open jaws come to about the thing along their shaft, and close.
  void take(std::size_t k) {
    const bool ring = std::get<RigidShape>(world_.scene().anatomy.organs[0].shape).ring > 0;
    const std::string rims[] = {"thing.rim_1", "thing.rim_2", "thing.rim_3", "thing.rim_4"};
    const std::string place = ring ? rims[rng_.next() % 4] : "thing.centre";
    const Vec3 at = world_.landmark(place) + test::random_vector(rng_, 0.15 * largest_);
    if ((at - trocars[k]).norm() > 220 * mm) return;  // it has rolled away
    const Vec3 back = (trocars[k] - at).normalized();
    here_[k].roll = rng_.uniform(-1.6, 1.6);
    go(k, at + 25 * mm * back, 45 * deg, 6);
    go(k, at - rng_.uniform(-1 * mm, 5 * mm) * back, 45 * deg, 5 + static_cast<int>(rng_.uniform(0, 10)));
    go(k, here_[k].tip, 0, 1 + static_cast<int>(rng_.uniform(0, 8)));
  }

  void go(std::size_t k, const Vec3& tip, double jaw, int count) {
    const Hand from = here_[k];
    for (int i = 1; i <= count && !failed_; ++i) {
      const double share = static_cast<double>(i) / count;
      here_[k].tip = from.tip + share * (tip - from.tip);
      here_[k].jaw = from.jaw + share * (jaw - from.jaw);
      step();
    }
  }

  void step() {
    StepInput input;
    for (std::size_t k = 0; k < 2; ++k)
      input.instruments.push_back(pose_reaching(trocars[k], here_[k].tip, here_[k].roll, here_[k].jaw,
                                                instrument_geometry(world_.scene().instruments[k].type)));
    const Result<StepReport> report = world_.step(input);
    ++steps;
    failed_ = !report;
    ASSERT_TRUE(report) << to_text(report.failure());
    const StepBudget& budget = world_.field().budget;
    EXPECT_LE(report->statistics.newton_iterations, 2 * (budget.begin + budget.balance))
        << "twice where a step is taken back";
    cut_short += report->statistics.cut_short;
    const Organ& thing = world_.field().organs[0];
    ASSERT_TRUE(thing.state.x.allFinite());
    EXPECT_LT(thing.body->max_stretch(thing.state.x), 1.05) << "it is rigid";
    // Points of the thing's skin keep off the tools, and a jaw's edge that lies across an edge of the thing comes in
    // between two of them: where both are sharp, by a third of a millimetre.
    EXPECT_LT(world_.deepest_penetration(), 0.5 * mm);
    for (const InstrumentState& tool : report->instruments) {
      EXPECT_TRUE(tool.force.allFinite());
      held |= !tool.holds.empty();
    }
  }

  Rng rng_;
  World world_;
  double largest_;
  std::array<Hand, 2> here_;
  bool failed_ = false;
};

TEST(RandomSqueezes, OfRigidThingsEndWithinTheirBudgetAndWhatIsLetGoComesDown) {
  CALOT_SLOW_WHEN_SANITIZED("thousands of steps");
  const int squeezes = test::cases(4, 500);
  int held = 0, cut_short = 0, steps = 0;
  for (int k = 0; k < squeezes; ++k) {
    SCOPED_TRACE(testing::Message() << "squeeze " << k);
    Squeeze squeeze(static_cast<std::uint64_t>(7000 + k));
    squeeze.run();
    held += squeeze.held;
    cut_short += squeeze.cut_short, steps += squeeze.steps;
  }
  fmt::print("{} of {} things held, {} of {} steps cut short\n", held, squeezes, cut_short, steps);
  EXPECT_GT(10 * held, squeezes) << "hardly anything was squeezed";
}

}  // namespace
}  // namespace calot
