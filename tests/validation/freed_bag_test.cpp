// A bag of bile that comes off its bed strand by strand: in whatever order they are divided each step is followed, and
// then the bag is free: it flies, falls and lies as a body does that nothing holds.

#include <numeric>

#include "base/units.h"
#include "field/field_state.h"
#include "field/leaving.h"
#include "sim/motion_rig.h"
#include "sim/triangle_rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

constexpr int bed_strands = 36;
constexpr double bag_rate = 50;           // Hz
constexpr double floor_height = -250e-3;  // m

/// A ball of bile that hangs by a plane from a bar, 100 mm over a floor, and a grasper.
SceneDefinition hanging_bag() {
  OrganDefinition bag = test::bedded_ball();
  bag.name = "gallbladder";
  bag.held = {{"base", "neck", 22e-3, 1e6, true}};  // until it is filled
  bag.wall.density = 1050;
  SceneDefinition scene = test::ball_scene(bag);
  scene.anatomy.organs.push_back(
      test::straight_tube("liver", test::beside_neck(-60, 0, 60), test::beside_neck(60, 0, 60), 17e-3));
  TissueDefinition plane = test::tissue_between("cystic_plate", "gallbladder", "liver", 12e-3, bed_strands);
  plane.slack = 0.05;
  plane.stiffness = 20e3;
  plane.strength = 30e3;
  scene.anatomy.tissue = {plane};
  scene.anatomy.ground = {{.name = "floor", .point = Vec3(0, 0, floor_height), .friction = 0.3}};
  scene.ports = default_ports();
  scene.ports.push_back({"side", test::beside_neck(0, -160, 25)});
  scene.instruments[0].port = "side";
  scene.solver.motion = SolverMotion::dynamics;
  scene.solver.rate = bag_rate;
  return scene;
}

/// It is drawn aside and down by the grasper, which holds a fold of its side.
struct DrawnBag {
  World world = World::create(hanging_bag()).value();
  test::Driver driver{world};
  const double volume = bag().state.volume;

  DrawnBag() {
    const Vec3 side = world.landmark("gallbladder.neck") + Vec3(0, -20e-3, 20e-3);
    const Vec3 out = (driver.trocar() - side).normalized();
    EXPECT_TRUE(test::grasp(driver, side, out, 5)) << driver.why();
    EXPECT_TRUE(held()) << "else nothing draws it";
    EXPECT_TRUE(driver.go(side + Vec3(0, -6e-3, -6e-3), 0, 8)) << driver.why();
  }
  const Organ& bag() const { return world.field().organs[0]; }
  const Tissue& plane() const { return world.field().tissues[0]; }
  bool held() const { return !bag().grips.empty(); }
  int torn() const { return world.report().tissues[0].torn; }

  /// As a cut does, without the scissors.
  void divide(std::span<const int> strands) {
    FieldState state = world.state();
    for (int strand : strands) state.group.tissues[0].opened[strand] = 1e3;
    EXPECT_TRUE(world.restore(state));
  }
  void divide_all() {
    std::vector<int> all(bed_strands);
    std::iota(all.begin(), all.end(), 0);
    divide(all);
  }
  void expect_sound() const {
    for (const Organ& organ : world.field().organs)
      EXPECT_TRUE(organ.state.x.allFinite() && std::isfinite(organ.state.datum_pressure));
    EXPECT_TRUE(plane().now.state.x.allFinite());
    // A step that was cut short holds the volume to a millionth.
    EXPECT_NEAR(bag().body->liquid()->volume(bag().state.x), volume, 1e-6 * volume);
  }

  /// kg m/s, of the bag and of the strands, which hang on it where they are torn.
  Vec3 momentum() const {
    Vec3 sum = test::momentum(bag());
    if (const BlockMatrix* mass = plane().body->mass()) {
      const VecX of = mass->multiply(present_motion(*plane().body, plane().now.state).velocity);
      for (Eigen::Index i = 0; i < of.size(); i += 3) sum += of.segment<3>(i);
    }
    return sum;
  }
  double mass() const {
    double sum = test::mass_of(bag());
    if (const BlockMatrix* of_nodes = plane().body->mass()) {
      const VecX ones = VecX::Ones(plane().now.state.x.size());
      sum += ones.dot(of_nodes->multiply(ones)) / 3;
    }
    return sum;
  }
  double speed() const {
    return bag().body->largest_motion(present_motion(*bag().body, bag().state).velocity);
  }
  /// By the grasper, and the floor.
  bool untouched() const {
    return !held() && world.report().instruments[0].force.isZero(0) && lowest() > floor_height + 1e-3;
  }
  double lowest() const {
    double out = std::numeric_limits<double>::infinity();
    for (const Vec3& p : bag().body->skin_positions(bag().state.x)) out = std::min(out, p.z());
    return out;
  }
};

TEST(FreedBag, InWhateverOrderItsStrandsAreDividedEachStepIsFollowed) {
  CALOT_SLOW_WHEN_SANITIZED("a hundred steps");
  DrawnBag bag;
  EXPECT_GT(bag.world.report().instruments[0].force.norm(), 0.5) << "it is not under load";
  const FieldState whole = bag.world.state();
  Rng rng(4);
  for (std::size_t at_once : {1, 1, 1, 4, 9}) {
    ASSERT_TRUE(bag.world.restore(whole));
    std::vector<int> order(bed_strands);
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng.next() % i]);
    for (std::size_t k = 0; k < order.size(); k += at_once) {
      bag.divide(std::span(order).subspan(k, at_once));
      ASSERT_TRUE(bag.driver.stay(1)) << k << ": " << bag.driver.why();
      EXPECT_TRUE(bag.world.report().balanced) << k;
      ASSERT_GE(bag.torn(), static_cast<int>(k + at_once));
      bag.expect_sound();
    }
    EXPECT_EQ(bag.torn(), bed_strands);
  }
}

TEST(FreedBag, ThrownItFliesByItsWeightAlone) {
  CALOT_SLOW_WHEN_SANITIZED("a hundred steps");
  DrawnBag bag;
  bag.divide_all();
  const Vec3 here = bag.world.report().instruments[0].tip;
  const auto gone = [&](int steps) -> Vec3 { return here + Vec3(0.25 * steps / bag_rate, 0, 0); };
  // It leaves the opening jaws while they move on (field/leaving.h).
  const int leaves = static_cast<int>(std::lround(leaving_time * bag_rate));
  ASSERT_TRUE(bag.driver.go(gone(8), 0, 8) && bag.driver.go(gone(12), test::open_jaw, 4)) << bag.driver.why();
  ASSERT_TRUE(bag.driver.go(gone(8 + leaves), test::open_jaw, leaves - 4)) << bag.driver.why();
  ASSERT_TRUE(bag.driver.go(gone(9 + leaves) + Vec3(0, -10e-3, 10e-3), test::open_jaw, 1))
      << bag.driver.why();
  EXPECT_GT(bag.momentum().x(), 0.2 * bag.mass()) << "m/s; else it was hardly thrown";
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(bag.untouched()) << k;
    const Vec3 before = bag.momentum(), fall(0, 0, -bag.mass() * units::standard_gravity / bag_rate);
    ASSERT_TRUE(bag.driver.stay(1)) << bag.driver.why();
    bag.expect_sound();
    // As of a free ball (sim/motion_test.cpp): what the solver's tolerance leaves of the forces.
    EXPECT_LT((bag.momentum() - before - fall).norm(), 1e-5 * before.norm()) << k;
  }
}

TEST(FreedBag, LetGoItKeepsItsBileAndComesToRestOnTheGround) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of steps");
  DrawnBag bag;
  bag.divide_all();
  ASSERT_TRUE(bag.driver.stay(10));
  const Vec3 tip = bag.world.report().instruments[0].tip;
  ASSERT_TRUE(bag.driver.go(tip, test::open_jaw, 2)) << bag.driver.why();
  ASSERT_TRUE(bag.driver.go(tip + Vec3(0, -50e-3, 0), test::open_jaw, 10)) << bag.driver.why();
  int waited = 0;
  for (int still = 0; still < 10 && waited < 10 * bag_rate; ++waited) {
    ASSERT_TRUE(bag.driver.stay(1)) << bag.driver.why();
    bag.expect_sound();
    still = bag.speed() < 1e-3 ? still + 1 : 0;
  }
  EXPECT_LT(waited, 10 * bag_rate) << "it still moves by " << bag.speed() << " m/s";
  EXPECT_NEAR(bag.lowest(), floor_height, 0.1e-3) << "contact's distance is 0.05 mm";
}

}  // namespace
}  // namespace calot
