#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "field/field_state.h"
#include "group/vibration.h"
#include "milestone.h"
#include "motion/settle_field.h"
#include "motion_rig.h"
#include "support/bodies.h"
#include "support/long_run.h"

namespace calot {
namespace {

using units::standard_gravity;

TEST(Motion, AFilledBallFallsWithGravityAndKeepsItsShape) {
  const double h = 0.02;
  Field field = test::free_ball(0, h);
  const VecX rest = field.organs[0].state.x;
  double speed = 0, fallen = 0;
  for (int k = 0; k < 5; ++k) {
    ASSERT_EQ(test::wait(field), "");
    speed += h * standard_gravity;
    fallen += h * speed;
    const VecX expected = rest - test::velocities(rest, [&](const Vec3&) { return Vec3(0, 0, fallen); });
    // The tolerance is that of the solver, beside the ball's size.
    EXPECT_LT((field.organs[0].state.x - expected).lpNorm<Eigen::Infinity>(), 1e-6 * 40e-3) << k;
  }
  EXPECT_GT(fallen, 50e-3);
}

TEST(Motion, AFreeBallsMomentumGrowsByItsWeightAlone) {
  const double h = 0.01;
  Field field = test::free_ball(0, h);
  Organ& organ = field.organs[0];
  // It flies, turns and is drawn out.
  test::set_moving(organ,
                   test::velocities(organ.state.x,
                                    [](const Vec3& x) {
                                      return Vec3(0.05 + 2 * x.y() + 3 * x.x(), 0.02 - 2 * x.x() - 3 * x.y(),
                                                  0.1);
                                    }),
                   h);
  const double mass = test::mass_of(organ);
  EXPECT_NEAR(mass, 1020 * organ.state.volume + 1050 * 2e-3 * 4 * std::numbers::pi * 20e-3 * 20e-3,
              0.01 * mass);
  Vec3 expected = test::momentum(organ);
  const double scale = expected.norm();
  for (int k = 0; k < 10; ++k) {
    ASSERT_EQ(test::wait(field), "");
    expected.z() -= h * mass * standard_gravity;
    EXPECT_LT((test::momentum(organ) - expected).norm(), 1e-5 * scale) << k;
  }
}

TEST(Motion, APartThatIsCutIsCutInTime) {
  const double h = 0.02;
  Field field = test::free_ball(0, h);
  test::add_grasper(field, Vec3(0, 0, 300e-3));
  Organ& organ = field.organs[0];
  test::set_moving(organ, test::velocities(organ.state.x, [](const Vec3&) { return Vec3(1, 0, 0); }), h);
  const Vec3 before = test::momentum(organ), weight(0, 0, -standard_gravity * test::mass_of(organ));
  const double from = organ.state.x[0];
  InstrumentPose pose = field.tools[0].pose;
  pose.insertion += 1e-3;  // far from the ball, which moves further than its nodes are apart
  SolveStatistics statistics;
  const auto events = advance(field, {pose}, statistics);
  ASSERT_TRUE(events) << to_text(events.failure());
  EXPECT_GT(statistics.substeps, 1);
  EXPECT_LT((test::momentum(organ) - before - h * weight).norm(), 1e-5 * before.norm());
  EXPECT_NEAR(organ.state.x[0] - from, h * 1, 1e-6 * 40e-3);
}

TEST(Motion, ABallThatComesDownFastIsStoppedByTheSupport) {
  const double h = 0.02;
  const Plane floor{Vec3::Zero(), Vec3::UnitZ()};
  Field field = test::free_ball(5e-3, h, floor);
  Organ& organ = field.organs[0];
  test::set_moving(organ, test::velocities(organ.state.x, [](const Vec3&) { return Vec3(0, 0, -2); }), h);
  for (int k = 0; k < 3; ++k) ASSERT_EQ(test::wait(field), "");
  for (const Vec3& p : organ.body->skin_positions(organ.state.x)) EXPECT_GT(p.z(), -contact_gap);
}

/// Period, s, of what `height` (m) tells of a field that swings about 0 in steps of `h`: between its upward passages
/// after the first.
double period(Field& field, double h, const std::function<double()>& height) {
  std::vector<double> passages;
  double before = height();
  for (int k = 1; passages.size() < 3 && k < 2000; ++k) {
    if (const std::string why = test::wait(field); !why.empty()) {
      ADD_FAILURE() << why;
      return 0;
    }
    const double now = height();
    if (before < 0 && now >= 0) passages.push_back(h * (k - now / (now - before)));
    before = now;
  }
  return passages.size() < 3 ? 0 : passages[2] - passages[1];
}

/// A stiff rod that hangs from a point.
struct Pendulum {
  Field field;
  double arm_squared = 0, arm = 0;  ///< means of the distance from the pivot by mass, m^2 and m

  explicit Pendulum(double h) {
    RodBody::Setup setup;
    setup.points = {Vec3::Zero(), Vec3(0, 0, -100e-3)};
    setup.shear_modulus = 100e6;
    setup.density = 1050;
    setup.liquid_density = 1000;
    setup.nodes = 6;
    const auto loose = RodBody::create(setup).value();
    const StencilTable& table = loose.rod().stencils();
    const Vec3 pivot = blend(table, table.value, 0, loose.rest());
    // At the first point of the quadrature alone, of three spans.
    setup.held = {{(0.5 - 0.5 / std::sqrt(3.0)) / 3, 1e-6, 1e9}};
    const auto body = std::make_shared<const RodBody>(RodBody::create(setup).value());
    double mass = 0;
    for (int row = 0; row < table.rows(); ++row) {
      const double away = pivot.z() - blend(table, table.value, row, loose.rest()).z();
      mass += body->row_mass(row);
      arm += body->row_mass(row) * away;
      arm_squared += body->row_mass(row) * away * away;
    }
    arm /= mass, arm_squared /= mass;
    field.step_time = h;
    OrganDefinition definition;
    definition.name = "rod";
    definition.wall.retardation = 0;  // the theory knows none
    Organ organ(definition, body);
    VecX& x = organ.state.x;
    const Eigen::AngleAxisd turn(0.05, Vec3::UnitY());
    for (Eigen::Index i = 0; i < x.size(); i += 3)
      x.segment<3>(i) = pivot + turn * Vec3(Vec3(x.segment<3>(i)) - pivot);
    field.add({organ, NewtonWorkspace(body->pattern())});
  }
  double aside() const { return field.organs[0].state.x[field.organs[0].state.x.size() - 3]; }
};

TEST(Motion, AHangingRodSwingsWithThePeriodOfACompoundPendulum) {
  const auto found = [](double h) {
    Pendulum pendulum(h);
    return period(pendulum.field, h, [&] { return pendulum.aside(); });
  };
  const Pendulum of(0.01);
  const double a = 0.05, small = 1 + a * a / 16;  // a swing of this angle, before it decays
  const double expected = 2 * std::numbers::pi * std::sqrt(of.arm_squared / (of.arm * standard_gravity));
  const double coarse = found(0.02), fine = found(0.01);
  // Implicit Euler's frequency is atan(w h) / h: of the second order in h.
  const auto theory = [&](double h) {
    const double wh = 2 * std::numbers::pi / expected * h;
    return expected * wh / std::atan(wh);
  };
  EXPECT_NEAR(coarse / theory(0.02), 1, 2e-3);
  EXPECT_NEAR(fine / theory(0.01), 1, 2e-3);
  EXPECT_NEAR((4 * fine - coarse) / 3, expected * small, 2e-3 * expected);
}

TEST(Motion, AFilledBallThatHangsFromItsBaseSwaysWithItsLowestNaturalFrequency) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of steps");
  OrganDefinition definition = test::heavy(test::held_ball());
  definition.nodes = 32;
  definition.wall.retardation = 0;
  definition.bile.fill_pressure = 1000;
  const Field rest = test::make_field(definition, 1e-8, -Vec3::UnitZ());
  const Organ& at = rest.organs[0];
  const BodyMass mass(*at.body->as_shell(), at.state.x, definition.wall.thickness, definition.bile.density);
  const double lowest = lowest_frequency(*at.body->as_shell(), {}, at.state, mass).value();
  // The few points of its bed are no even round: it sways more slowly this way than across, by 3 %.
  const Vec3 softest(std::cos(1.97), std::sin(1.97), 0);
  const auto found = [&](double h) {
    Field field = rest;
    field.step_time = h;
    Organ& organ = field.organs[0];
    test::set_moving(
        organ, test::velocities(organ.state.x, [&](const Vec3& x) -> Vec3 { return 0.25 * x.z() * softest; }),
        h);
    const Vec3 still = organ.body->liquid()->centroid(organ.state.x, organ.state.volume);
    return 1 / period(field, h, [&] {
             return (organ.body->liquid()->centroid(organ.state.x, organ.state.volume) - still).dot(softest);
           });
  };
  const double coarse = found(1 / (40 * lowest)), fine = found(1 / (80 * lowest));
  EXPECT_NEAR(fine / lowest, 1, 0.01);
  EXPECT_NEAR((4 * fine - coarse) / 3 / lowest, 1, 0.005);
  RecordProperty("lowest_mHz", static_cast<int>(1e3 * lowest));
}

/// Waits until nothing moves; how many steps it took, or -1.
int wait_for_rest(Field& field, int most) {
  for (int k = 0; k < most; ++k) {
    if (const std::string why = test::wait(field); !why.empty()) {
      ADD_FAILURE() << why;
      return -1;
    }
    const Organ& organ = field.organs[0];
    if (stands_still(present_motion(*organ.body, organ.state))) return k + 1;
  }
  return -1;
}

TEST(Motion, ABallDroppedOnTheSupportComesToTheRestThatItSinksTo) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of steps");
  const Plane floor{Vec3::Zero(), Vec3::UnitZ()};
  Field field = test::free_ball(5e-3, 0.02, floor);
  ASSERT_GT(wait_for_rest(field, 500), 10);
  ContactLoads still;
  still.shapes = {contact_shape(floor)};
  FillingLimits limits;
  limits.sinks = true;
  const Result<RestedOrgan> sunk =
      make_organ(test::heavy(test::ball(Vec3(0, 0, 5e-3))), still, Vec3::UnitZ(), 1e-6, 0, &limits);
  ASSERT_TRUE(sunk) << to_text(sunk.failure());
  const Organ &fallen = field.organs[0], &other = sunk->organ;
  // It may have gone anywhere on the plane, and turned.
  const auto heights = [](const Organ& organ) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : organ.body->skin_positions(organ.state.x)) box.extend(p);
    return box;
  };
  EXPECT_LT(heights(fallen).min().z(), 0.1e-3);
  EXPECT_NEAR(heights(fallen).max().z(), heights(other).max().z(), 2e-6);
  EXPECT_NEAR(fallen.state.datum_pressure, other.state.datum_pressure, 1e-2 * other.state.datum_pressure);
  // And it stays.
  const VecX x = field.organs[0].state.x;
  SolveStatistics statistics;
  for (int k = 0; k < 3; ++k) ASSERT_EQ(test::wait(field, statistics), "");
  EXPECT_EQ(field.organs[0].state.x, x);
  EXPECT_EQ(statistics.newton_iterations, 0);
}

SceneDefinition moving_scene(int levels = 0) {
  SceneDefinition scene = test::ball_scene(test::heavy(test::bedded_ball()));
  scene.solver.motion = SolverMotion::dynamics;
  scene.solver.extension_levels = levels;
  return scene;
}

bool stands_still(const World& world) {
  const Organ& organ = world.field().organs[0];
  return stands_still(present_motion(*organ.body, organ.state));
}

TEST(Motion, WhereAGrasperPullsAndWaitsItEndsInTheRestOfStatics) {
  CALOT_SLOW_WHEN_SANITIZED("a whole grasp");
  test::FundusPath path(moving_scene(1));
  ASSERT_TRUE(path.grasp() && path.lift()) << path.driver.why();
  ASSERT_EQ(path.world.report().instruments[0].holds, "ball");
  ASSERT_FALSE(stands_still(path.world));
  for (int k = 0; k < 100 && !stands_still(path.world); ++k)
    ASSERT_TRUE(path.driver.stay(1)) << path.driver.why();
  ASSERT_TRUE(stands_still(path.world));
  // Then nothing is computed any more.
  ASSERT_TRUE(path.driver.stay(2));
  EXPECT_EQ(path.world.report().statistics.newton_iterations, 0);
  Field field = path.world.field();
  const VecX ended = field.organs[0].state.x;
  field.step_time = 0;
  field.organs[0].state.motion = {};
  SolveStatistics statistics;
  ASSERT_TRUE(settle_field(field, "here", statistics));
  // Both are found to the solver's tolerance.
  EXPECT_LT((field.organs[0].state.x - ended).lpNorm<Eigen::Infinity>(), 1e-6 * field.organs[0].body->size());
  // Let go, it springs back to where it began.
  path.driver.stay(1);
  ASSERT_TRUE(path.lower() && path.release() && path.withdraw()) << path.driver.why();
  EXPECT_EQ(path.world.report().instruments[0].grip_points, 0);
  ASSERT_TRUE(path.driver.stay(120)) << path.driver.why();
  const Organ& organ = path.world.field().organs[0];
  EXPECT_TRUE(organ.body->details().empty());
  const World fresh = World::create(moving_scene(1)).value();
  // It creeps back as it leaves the jaws (field/leaving.h) and stops where forces are balanced to 1e-6 of the largest: a
  // tenth of that holds the wall where it is softest.
  EXPECT_LT((organ.state.x - fresh.field().organs[0].state.x).lpNorm<Eigen::Infinity>(),
            1e-5 * organ.body->size());
}

TEST(Motion, RestoredWhileItSwingsTheSameStepsHaveTheSameBits) {
  CALOT_SLOW_WHEN_SANITIZED("two grasps");
  test::FundusPath path(moving_scene(1));
  ASSERT_TRUE(path.grasp() && path.lift(3)) << path.driver.why();
  const test::Milestone swinging(path);
  const auto hashes = [&] {
    std::vector<std::uint64_t> out;
    path.driver.watch = [&](const StepReport& report) { out.push_back(report.state_hash); };
    EXPECT_TRUE(path.lower(4) && path.release(3)) << path.driver.why();
    return out;
  };
  const std::vector<std::uint64_t> first = hashes();
  ASSERT_EQ(first.size(), 7u);
  swinging.go_back();
  EXPECT_EQ(hashes(), first);
  // All that says how it moves is part of the state.
  const FieldState& state = swinging.state();
  ASSERT_TRUE(path.world.restore(state));
  const std::uint64_t hash = path.world.state_hash();
  const auto differs = [&](const char* what, const std::function<void(MotionPart&)>& change) {
    FieldState other = state;
    change(other.group.organs[0].state.motion);
    ASSERT_TRUE(path.world.restore(other));
    EXPECT_NE(path.world.state_hash(), hash) << what;
  };
  differs("begin", [](MotionPart& part) { part.begin.x[0] += 1e-15; });
  differs("velocity", [](MotionPart& part) { part.begin.velocity[0] += 1e-9; });
  differs("centroid", [](MotionPart& part) { part.begin.centroid.x() += 1e-9; });
  differs("duration", [](MotionPart& part) { part.duration *= 1.0000001; });
}

TEST(Motion, StaticFieldsKnowNoVelocity) {
  SceneDefinition scene = moving_scene();
  scene.solver.motion = SolverMotion::statics;
  test::FundusPath path(scene);
  ASSERT_TRUE(path.driver.go(path.fundus - 2e-3 * path.out, 0, 2)) << path.driver.why();
  ASSERT_TRUE(path.world.report().instruments[0].touching);
  EXPECT_EQ(path.world.field().organs[0].state.motion.duration, 0);
}

TEST(Motion, TheBedCarriesAHeavyWallToo) {
  OrganDefinition definition = test::held_ball();
  const double without = test::bed_force(test::make_field(definition, 1e-8, Vec3::UnitZ()).organs[0]).z();
  definition.wall.density = 1050;
  const Field field = test::make_field(definition, 1e-8, Vec3::UnitZ());
  const Organ& organ = field.organs[0];
  const double wall = test::mass_of(organ) - definition.bile.density * organ.state.volume;
  EXPECT_GT(wall, 5e-3);
  EXPECT_NEAR(test::bed_force(organ).z(), without + wall * standard_gravity, 1e-6);
}

/// A ball that nothing holds above a level support.
SceneDefinition loose_scene() {
  SceneDefinition scene = moving_scene();
  OrganDefinition& organ = scene.anatomy.organs[0];
  organ.held.clear();
  organ.bile = {};
  scene.anatomy.support = SupportDefinition{organ.neck - Vec3(0, 0, 3e-3)};
  return scene;
}

double lowest(const World& world) {
  double z = 1;
  for (const Vec3& p : world.skin_positions(OrganIndex(0))) z = std::min(z, p.z());
  return z;
}

TEST(Motion, AScenesLooseOrganSinksOntoItsSupportAndStaysThere) {
  CALOT_SLOW_WHEN_SANITIZED("a sinking organ");
  SceneDefinition scene = loose_scene();
  Result<World> world = World::create(scene);
  ASSERT_TRUE(world) << to_text(world.failure());
  const std::vector<Vec3> sunk = world->skin_positions(OrganIndex(0));
  EXPECT_NEAR(lowest(world.value()), scene.anatomy.support->point.z(), contact_gap);
  StepInput input;
  input.instruments = {world->report().instruments[0].pose};
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(world->step(input));
  double moved = 0;
  for (std::size_t i = 0; i < sunk.size(); ++i)
    moved = std::max(moved, (world->skin_positions(OrganIndex(0))[i] - sunk[i]).norm());
  EXPECT_LT(moved, 1e-6 * 40e-3);  // the solver's tolerance
  // On a slope it would slide for good.
  scene.anatomy.table_head_up = 0.2;
  const Result<World> sliding = World::create(scene);
  ASSERT_FALSE(sliding);
  const std::string why = to_text(sliding.failure());
  EXPECT_NE(why.find("'ball'"), std::string::npos) << why;
  EXPECT_NE(why.find("slides"), std::string::npos) << why;
}

TEST(Motion, ALooseBallIsPickedUpSwingsAndFallsBack) {
  CALOT_SLOW_WHEN_SANITIZED("a whole grasp");
  SceneDefinition scene = loose_scene();
  scene.anatomy.support->friction = 0.2;
  test::FundusPath path(scene);
  const double floor = scene.anatomy.support->point.z();
  ASSERT_TRUE(path.grasp(4)) << path.driver.why();
  ASSERT_EQ(path.world.report().instruments[0].holds, "ball");
  ASSERT_TRUE(path.driver.go(path.fundus + Vec3(10e-3, 0, 15e-3), 0.0, 10)) << path.driver.why();
  EXPECT_GT(lowest(path.world), floor + 10e-3);
  // The grasper carries all of it.
  ASSERT_TRUE(path.driver.stay(25)) << path.driver.why();
  const double weight = test::mass_of(path.world.field().organs[0]) * standard_gravity;
  EXPECT_NEAR(path.world.report().instruments[0].force.z(), -weight, 0.02 * weight);
  ASSERT_TRUE(path.driver.go(path.fundus + Vec3(10e-3, 0, 15e-3), test::open_jaw, 4)) << path.driver.why();
  ASSERT_TRUE(path.driver.stay(40)) << path.driver.why();
  EXPECT_EQ(path.world.report().instruments[0].grip_points, 0);
  EXPECT_NEAR(lowest(path.world), floor, contact_gap);
}

}  // namespace
}  // namespace calot
