// Structural extensions: laid ahead of contact, followed as it slides, taken away after it, without a trace.

#include "motion/structural_extension.h"

#include <gtest/gtest.h>

#include "field_rig.h"
#include "group/detail_fading.h"
#include "motion/settle_field.h"
#include "rig.h"
#include "support/derivatives.h"
#include "support/long_run.h"

namespace calot {
namespace {

/// The paper's ball, filled to a gallbladder's pressure, its lower half on a bed.
double furthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double out = 0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, (a[i] - b[i]).norm());
  return out;
}

/// A ball that a pole pulls aside at its top by springs on the skin: a load that tools do not make.
struct Pulled {
  Field field;
  Organ& organ;
  ContactLoads around;

  explicit Pulled(int levels)
      : field(test::make_field(test::bedded_ball(), 1e-9, Vec3::UnitZ(), {}, levels)),
        organ(field.organs[0]) {
    const Vec3 top = organ.body->skin_rest()[organ.landmarks.at("fundus")];
    const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
    for (std::size_t i = 0; i < skin.size(); ++i) {
      if ((organ.body->skin_rest()[i] - top).norm() > 4e-3) continue;
      around.grip.row.push_back(static_cast<int>(i));
      around.grip.target.push_back(skin[i] + Vec3(3e-3, 1e-3, 4e-3));
      around.grip.stiffness.push_back(20);
    }
    rest();
  }
  void rest() {
    NewtonSettings settings;
    settings.tolerance = 1e-9;
    const NewtonResult result =
        settle({*organ.body, around, organ.search, organ.state}, settings, field.group.work);
    ASSERT_TRUE(result.converged()) << to_text(result.status) << " " << result.residual;
  }
  std::vector<Vec3> skin() const { return organ.body->skin_positions(organ.state.x); }
};

TEST(StructuralExtension, HundredsInsertedAndRemovedUnderLoadLeaveTheStateWithoutThem) {
  CALOT_SLOW_WHEN_SANITIZED("details laid over and over");
  Pulled pulled(1);
  const std::vector<Vec3> before = pulled.skin();
  const Vec3 moved = before[pulled.organ.landmarks.at("fundus")];
  EXPECT_GT((moved - pulled.organ.body->skin_rest()[pulled.organ.landmarks.at("fundus")]).norm(), 2e-3);
  Rng rng(1);
  const double points = static_cast<double>(before.size());
  double changed = 0;
  const int all = test::cases(300, 1000);
  for (int k = 0; k < all; ++k) {
    test::extend(pulled.field,
                 {static_cast<int>(rng.uniform(0, points)), static_cast<int>(rng.uniform(0, points))});
    if (k % 50 == 0) {  // the others are taken away before they moved
      pulled.rest();
      changed = std::max(changed, furthest(before, pulled.skin()));
    }
    test::extend(pulled.field, {});
    if (k % 50 == 0) pulled.rest();
  }
  pulled.rest();
  EXPECT_GT(changed, 1e-5);
  EXPECT_LT(furthest(before, pulled.skin()), 1e-8) << "m; equilibria are met to 1e-9";
}

/// Everything that a solve reads of a structure, at a state where all its details move.
std::vector<double> fingerprint(const ShellBody& body, const BodyState& rest) {
  Rng rng(3);
  VecX x = VecX::Zero(body.rest().size());
  x.head(rest.x.size()) = rest.x;
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += rng.uniform(-0.5e-3, 0.5e-3);
  const ContactLoads nothing;
  const BodyProblem problem(body, nothing, {}, {x, rest.datum_pressure, rest.volume});
  VecX gradient, internal, volume;
  Eigen::MatrixXd of_volume;
  problem.gradient_and_constraint(x, gradient, internal, volume, of_volume);
  std::vector<double> out = {problem.value(x), volume[0], internal[0]};
  NewtonWorkspace work(body.pattern(), body.coarse_nodes());
  problem.hessian(x, problem.multipliers(), work.matrix);
  const VecX solution =
      work.factor.factorise(work.matrix) == FactorStatus::ok ? work.factor.solve(gradient) : VecX();
  for (const VecX& v : {gradient, VecX(of_volume), solution, body.kept_load()})
    out.insert(out.end(), v.data(), v.data() + v.size());
  out.insert(out.end(), work.matrix.entries().begin(), work.matrix.entries().end());
  for (const Vec3& p : body.skin_positions(x)) out.insert(out.end(), p.data(), p.data() + 3);
  return out;
}

TEST(StructuralExtension, LaidFromAnotherOneItIsTheSameToTheBit) {
  Field field = test::make_field(test::bedded_ball(), 1e-9, Vec3::UnitZ(), {}, 2);
  const Organ& organ = field.organs[0];
  const ShellBody& bare = *organ.body->as_shell();
  const auto about = [&](const std::vector<int>& rows) {
    std::vector<Extension> extensions;
    for (int row : rows) extensions.push_back({0, row});
    return details_around(bare, extensions);
  };
  const std::vector<int> first = about({10, 700}), second = about({700, 1200}),
                         third = about({15, 1200, 1500});
  const ShellBody a = bare.with_details(first).value(), b = a.with_details(second).value(),
                  c = b.with_details(third).value(), gone = c.with_details({}).value();
  EXPECT_EQ(fingerprint(b, organ.state), fingerprint(bare.with_details(second).value(), organ.state));
  EXPECT_EQ(fingerprint(c, organ.state), fingerprint(bare.with_details(third).value(), organ.state));
  EXPECT_EQ(fingerprint(gone, organ.state), fingerprint(bare, organ.state));
  EXPECT_NE(fingerprint(b, organ.state), fingerprint(a, organ.state));
}

TEST(StructuralExtension, AnOrganAtRestDoesNotMoveWhenItIsExtended) {
  Field field = test::make_field(test::bedded_ball(), 1e-9, Vec3::UnitZ(), {}, 2);
  Organ& organ = field.organs[0];
  const std::vector<Vec3> before = organ.body->skin_positions(organ.state.x);
  const double multiplier = organ.state.datum_pressure;
  NewtonSettings settings;
  settings.tolerance = 1e-9;
  test::extend(field, {10, 700, organ.landmarks.at("fundus")});
  EXPECT_GT(organ.body->kept_load().norm(), 1e-4) << "N: the finer rules do see the wall otherwise";
  const ContactLoads nothing;
  EXPECT_TRUE(
      settle({*organ.body, nothing, organ.search, organ.state}, settings, field.group.work).converged());
  EXPECT_LT(furthest(before, organ.body->skin_positions(organ.state.x)), 1e-9) << "m; met to 1e-9";
  EXPECT_NEAR(organ.state.datum_pressure, multiplier, 1e-6 * multiplier);
}

TEST(StructuralExtension, BileBearsOnAnExtendedWallWithItsWeight) {
  Pulled pulled(2);
  Rng rng(2);
  test::extend(pulled.field, {10, 500, 1500});
  VecX& x = pulled.organ.state.x;
  for (Eigen::Index i = 3 * pulled.organ.body->coarse_nodes(); i < x.size(); ++i)
    x[i] = rng.uniform(-1e-3, 1e-3);
  const Bile& bile = *pulled.organ.body->as_shell()->bile();
  VecX load = VecX::Zero(x.size());
  bile.add_load(x, pulled.organ.state.datum_pressure, load);
  // The coarse functions sum to one everywhere: their loads are all there are.
  Vec3 net = Vec3::Zero();
  for (int i = 0; i < pulled.organ.body->coarse_nodes(); ++i) net += load.segment<3>(Eigen::Index{3} * i);
  const double weight = bile.specific_weight() * bile.volume(x);
  EXPECT_GT(weight, 0.2);
  EXPECT_LT((net - weight * Vec3::UnitZ()).norm(), 1e-12 * weight * 1e3)
      << "rounding of pressures of 1600 Pa";
}

TEST(StructuralExtension, ItsUnknownsCondensedGiveTheWholeSystemsSolution) {
  Pulled pulled(2);
  test::extend(pulled.field, {10, 700, pulled.organ.landmarks.at("fundus")});
  pulled.rest();
  const BodyProblem problem(*pulled.organ.body, pulled.around, {}, pulled.organ.state);
  BlockMatrix matrix = pulled.organ.body->pattern();
  problem.hessian(pulled.organ.state.x, problem.multipliers(), matrix);
  const int coarse = pulled.organ.body->coarse_nodes();
  ASSERT_GT(matrix.nodes(), coarse + 40);
  Cholesky whole(matrix, coarse, FactorKind::dense), condensed(matrix, coarse, FactorKind::condensed);
  ASSERT_EQ(whole.factorise(matrix), FactorStatus::ok);
  ASSERT_EQ(condensed.factorise(matrix), FactorStatus::ok);
  Rng rng(3);
  const VecX load = test::random_coordinates(rng, matrix.size(), 1.0), x = whole.solve(load);
  EXPECT_LT((condensed.solve(load) - x).norm(), 1e-10 * x.norm());
}

TEST(StructuralExtension, APulledWallIsTwiceAsTrueWithItAsWithout) {
  CALOT_SLOW_WHEN_SANITIZED("details laid over and over");
  // Against all details of two levels: 946 functions.
  Pulled coarse(0), extended(1), fine(2);
  test::extend(extended.field, {extended.organ.landmarks.at("fundus")});
  EXPECT_EQ(extended.organ.body->details().size(), 12u);
  extended.rest();
  std::vector<int> all;
  const ShellBody& bare = *fine.organ.body->as_shell();
  for (int node = bare.levels().nodes(0); node < bare.levels().nodes(2); ++node) all.push_back(node);
  const auto finest = std::make_shared<const ShellBody>(bare.with_details(all).value());
  fine.organ.state.x = bare.coordinates_in(*finest, fine.organ.state.x);
  fine.organ.body = finest;
  fine.field.group.forget_bodies();
  fine.rest();
  const double far_off = furthest(coarse.skin(), fine.skin()), near = furthest(extended.skin(), fine.skin());
  EXPECT_GT(far_off, 1e-5);
  EXPECT_LT(near, 0.5 * far_off);
}

/// A closed grasper that presses the ball near its top, from above.
struct Pressed {
  World world;
  test::Driver driver;
  Vec3 top;

  static SceneDefinition scene(int levels) {
    SceneDefinition out = test::ball_scene();
    out.solver.rate = 1000;
    out.solver.extension_levels = levels;
    return out;
  }
  explicit Pressed(int levels)
      : world(World::create(scene(levels)).value()), driver(world, 0.3), top(world.landmark("ball.fundus")) {}
};

TEST(StructuralExtension, ItIsLaidBeforeTheTouchAndTakenAwayAfterIt) {
  Pressed pressed(1);
  int without = 0, before_touch = 0;
  const auto watch = [&](const StepReport& report) {
    const bool touches = report.instruments[0].touching, extended = report.organs[0].extensions > 0;
    without += touches && !extended;
    before_touch += extended && !touches;
  };
  pressed.driver.watch = watch;
  ASSERT_TRUE(pressed.driver.go(pressed.top + Vec3(-5e-3, 0, 8e-3), 0, 20)) << pressed.driver.why();
  EXPECT_EQ(pressed.world.report().organs[0].details, 0);
  ASSERT_TRUE(pressed.driver.go(pressed.top + Vec3(-5e-3, 0, -3e-3), 0, 110)) << pressed.driver.why();
  EXPECT_GT(pressed.world.report().instruments[0].force.norm(), 0.1);
  EXPECT_GE(pressed.world.report().organs[0].details, details_per_level);
  EXPECT_EQ(without, 0);
  EXPECT_GT(before_touch, 5);
  ASSERT_TRUE(pressed.driver.go(pressed.top + Vec3(-5e-3, 0, 12e-3), 0, 60)) << pressed.driver.why();
  EXPECT_EQ(pressed.world.report().organs[0].details, 0);
}

/// What a closed grasper feels of the ball, and how far the skin goes, as it is pressed in and drawn along.
struct Drawn {
  static constexpr double way = 0.25e-3;      ///< m, of a step
  static constexpr double faded_way = 50e-6;  ///< m: that of 50 mm/s within 1 ms
  Field field;
  Organ& organ;
  Vec3 top, tip;
  std::vector<Vec3> rest;
  SolveStatistics statistics;
  double force_range = 0, skin_range = 0;
  /// At one pose: by a change of the details, and with what they then fade by faded_way.
  double force_jump = 0, skin_jump = 0, force_faded = 0, skin_faded = 0;

  explicit Drawn(int levels)
      : field(test::make_field(test::bedded_ball(), 1e-6, Vec3::UnitZ(), {}, levels)),
        organ(field.organs[0]) {
    rest = organ.body->skin_positions(organ.state.x);
    top = rest[organ.landmarks.at("fundus")];
    tip = top + Vec3(-5e-3, 0, 2e-3);
    test::add_grasper(field, top + Vec3(-10e-3, 60e-3, 150e-3));
    field.tools[0].pose = pose_reaching(field.tools[0].trocar, tip, 0.3, 0);
  }

  void go(const Vec3& to) {
    const Vec3 from = tip;
    const int steps = static_cast<int>(std::ceil((to - from).norm() / way));
    for (int k = 1; k <= steps; ++k) {
      tip = from + k * (to - from) / steps;
      step(pose_reaching(field.tools[0].trocar, tip, 0.3, 0));
    }
  }
  void rest_at(const InstrumentPose& pose) {
    ASSERT_TRUE(settle_group(field, {pose}, present_places(field), 80, statistics).converged());
    field.tools[0].pose = pose;
  }
  void step(const InstrumentPose& pose) {
    rest_at(pose);
    const Vec3 force = test::tool_force(field);
    const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
    const auto since = [&](double& of_force, double& of_skin) {
      of_force = std::max(of_force, (test::tool_force(field) - force).norm());
      of_skin = std::max(of_skin, furthest(skin, organ.body->skin_positions(organ.state.x)));
    };
    follow_contacts(field, organ, statistics);
    since(force_jump, skin_jump);
    fade_details(faded_way, organ.state);
    rest_at(pose);
    force_range = std::max(force_range, force.norm());
    skin_range = std::max(skin_range, furthest(skin, rest));
    since(force_faded, skin_faded);
  }
};

TEST(StructuralExtension, WhereNoRestIsFoundWithItTheOrganStaysAsItWasAndTheRefusalIsCountedOnce) {
  Drawn drawn(1);
  Organ& organ = drawn.organ;
  const auto go_to = [&](double along, double down) {
    drawn.rest_at(pose_reaching(drawn.field.tools[0].trocar, drawn.top + Vec3(along, 0, -down), 0.3, 0));
  };
  for (int k = -8; k <= 4; ++k) go_to(-5e-3, k * Drawn::way);
  ASSERT_GT(drawn.statistics.newton_iterations, 0) << "it presses";
  const OrganSnapshot before = snapshot(organ);
  drawn.field.tolerance = 0;  // no solve reaches it
  SolveStatistics statistics;
  follow_contacts(drawn.field, organ, statistics);
  EXPECT_EQ(statistics.extensions_refused, 1);
  EXPECT_EQ(statistics.extensions_changed, 0);
  EXPECT_TRUE(organ.body->details().empty());
  EXPECT_EQ(organ.state.x, before.state.x);
  EXPECT_EQ(organ.state.datum_pressure, before.state.datum_pressure);
  follow_contacts(drawn.field, organ, statistics);
  EXPECT_EQ(statistics.extensions_refused, 1) << "not tried again while the same is wanted";
  drawn.field.tolerance = 1e-6;
  for (int k = 0; k <= 20; ++k) go_to(-5e-3 + k * Drawn::way, 1e-3);
  follow_contacts(drawn.field, organ, statistics);
  EXPECT_EQ(statistics.extensions_changed, 1);
  EXPECT_FALSE(organ.body->details().empty());
}

TEST(StructuralExtension, NeitherForceNorSkinJumpsAsItIsLaidMovedOrTakenAwayUnderLoad) {
  CALOT_SLOW_WHEN_SANITIZED("details laid over and over");
  for (int levels : {1, 2}) {
    Drawn drawn(levels);
    const Vec3 top = drawn.top;
    drawn.go(top + Vec3(-5e-3, 0, -3e-3));
    drawn.go(top + Vec3(3e-3, 2e-3, -3e-3));
    EXPECT_GT(drawn.organ.state.shares.size(), 12u);
    drawn.go(top + Vec3(3e-3, 2e-3, 3e-3));
    EXPECT_GT(drawn.statistics.extensions_changed, 5);
    EXPECT_EQ(drawn.statistics.extensions_refused, 0);
    EXPECT_GT(drawn.force_range, 0.2);
    EXPECT_GT(drawn.skin_range, 2e-3);
    // Held to a thousandth, and what the rules see otherwise made good.
    EXPECT_LT(drawn.force_jump, 1e-3 * drawn.force_range) << levels << " levels";
    EXPECT_LT(drawn.skin_jump, 1e-3 * drawn.skin_range) << levels << " levels";
    EXPECT_LT(drawn.force_faded, 0.01 * drawn.force_range) << levels << " levels";
    EXPECT_LT(drawn.skin_faded, 0.01 * drawn.skin_range) << levels << " levels";
    drawn.go(top + Vec3(3e-3, 2e-3, 12e-3));
    EXPECT_TRUE(drawn.organ.body->details().empty()) << "what has gone leaves nothing behind";
    EXPECT_LT(furthest(drawn.organ.body->skin_positions(drawn.organ.state.x), drawn.rest), 1e-6);
  }
}

TEST(StructuralExtension, DetailsFadeByTheWayNotByTheSteps) {
  BodyState at_once, in_parts;
  at_once.shares = {{0.2, false}, {0.9, true}, {0.3, true}, {0.8, false}};
  at_once.fading_load = VecX::LinSpaced(9, -0.1, 0.2);
  in_parts = at_once;
  fade_details(0.5 * fade_length, at_once);
  for (int k = 0; k < 10; ++k) fade_details(0.05 * fade_length, in_parts);
  const double expected[] = {0.7, 0.4, least_share, 1.0};
  for (int i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(at_once.shares[i].share, expected[i]);
    EXPECT_NEAR(in_parts.shares[i].share, expected[i], 1e-14);
  }
  EXPECT_LT((in_parts.fading_load - at_once.fading_load).norm(), 1e-14);
  EXPECT_LT(at_once.fading_load.norm(), 0.7 * VecX::LinSpaced(9, -0.1, 0.2).norm());
  fade_details(20 * fade_length, at_once);
  EXPECT_EQ(at_once.fading_load.size(), 0) << "it comes to an end";
}

TEST(StructuralExtension, StagesRepeatedTendToTheCondensedSolution) {
  Pulled condensed(1), staged(1);
  for (Pulled* pulled : {&condensed, &staged}) {
    test::extend(pulled->field, {pulled->organ.landmarks.at("fundus")});
    for (Vec3& target : pulled->around.grip.target) target += Vec3(-2e-3, 1e-3, 1e-3);
  }
  condensed.rest();
  const std::vector<Vec3> aim = condensed.skin();
  NewtonSettings settings;
  settings.tolerance = 1e-9;
  std::vector<double> apart;
  for (int k = 0; k < 12; ++k) {
    const NewtonResult result =
        settle({*staged.organ.body, staged.around, staged.organ.search, staged.organ.state}, settings,
               staged.field.group.work, {.scheme = ExtensionScheme::staged});
    ASSERT_TRUE(result.converged()) << to_text(result.status);
    apart.push_back(furthest(aim, staged.skin()));
  }
  EXPECT_GT(apart.front(), 1e-5) << "the first pass leaves what the extension passes back";
  EXPECT_LT(apart.front(), 1e-3);
  for (std::size_t k = 1; k < apart.size(); ++k) EXPECT_LT(apart[k], 0.95 * apart[k - 1]);
}

TEST(StructuralExtension, FollowsAHeldFoldAndLeavesWithIt) {
  CALOT_SLOW_WHEN_SANITIZED("details laid over and over");
  SceneDefinition scene = test::ball_scene();
  scene.solver.extension_levels = 1;
  test::FundusPath path(scene);
  ASSERT_TRUE(path.grasp() && path.lift()) << path.driver.why();
  EXPECT_EQ(path.world.report().instruments[0].holds, "ball");
  EXPECT_GE(path.world.report().organs[0].extensions, 2)
      << "one a pad, so that a crease can form between them";
  EXPECT_GT(path.world.report().organs[0].details, details_per_level);
  ASSERT_TRUE(path.lower() && path.release() && path.withdraw()) << path.driver.why();
  EXPECT_EQ(path.world.report().organs[0].details, 0);
}

}  // namespace
}  // namespace calot
