// Instruments on strands, without a world around.

#include "joins/strand_touch.h"

#include "group/contact_search.h"
#include "strand_rig.h"

namespace calot {
namespace {

using test::StrandRig;

/// Two plates 8 mm apart, held where they are, with strands between them that begin at these places.
StrandRig plates_with(const std::vector<Vec3>& places, double radius = 0.2e-3) {
  const Vec3 size(40e-3, 40e-3, 2e-3);
  StrandRig rig({test::plate(size, Vec3(0, 0, 7e-3)), test::plate(size, Vec3(0, 0, -7e-3))},
                {.length = 12e-3, .stiffness = 20e3, .strength = 100e3, .break_energy = 6e3}, places, 4e-6,
                radius);
  test::carry(rig, 0, Vec3::Zero(), 1e6);
  test::carry(rig, 1, Vec3::Zero(), 1e6);
  return rig;
}

/// A rod along y, its axis through this place.
Capsule rod_at(double x, double z, double radius = 1e-3) {
  return {Vec3(x, -15e-3, z), Vec3(x, 15e-3, z), radius};
}

void put(StrandRig& rig, const Shape& made) {
  rig.strands->set_touch({{contact_shape(made)}, contact_barrier});
}

Vec3 force_on_tool(const StrandRig& rig) {
  Vec3 sum = Vec3::Zero();
  rig.strands->for_contacts(
      rig.x(), [&](std::size_t, const StrandContact& contact) { sum += contact.force_on_shape(); });
  return sum;
}

TEST(StrandTouch, ItsEnergyHasTheseDerivatives) {
  const StrandLaw law = StrandLaw::create({.taut = 4e-3, .length = 4e-3, .break_energy = 2e-3}).value();
  const StrandThread thread = strand_thread(law, 0.2e-3);
  Rng rng(3);
  const std::vector<Shape> shapes{
      Capsule{Vec3(-5e-3, 1.15e-3, 0.5e-3), Vec3(5e-3, 1.2e-3, 0.3e-3), 1e-3},
      RoundedBox{Pose(Eigen::Translation3d(0.2e-3, -1.16e-3, -1e-3)), Vec3(0.5e-3, 0.5e-3, 0.5e-3), 0.5e-3}};
  const StrandTouch touch(shapes, contact_barrier);
  StrandVector x;
  x << 0.1e-3, 0, 2e-3, -0.02e-3, 0.01e-3, -0.1e-3, 0, 0.05e-3, -2e-3;
  x += test::random_coordinates(rng, 9, 5e-6);
  std::vector<StrandContact> contacts;
  touch.find(thread, x, contacts);
  std::array<std::array<int, 2>, 2> met{};
  for (const StrandContact& contact : contacts) ++met[contact.shape][contact.piece];
  EXPECT_GT(met[0][0], 3) << "the rod at the first piece";
  EXPECT_GT(met[1][1], 3) << "the box at the second";
  const StrandVector g = touch.gradient(thread, x);
  const StrandMatrix h = touch.hessian(thread, x);
  ASSERT_GT(touch.value(thread, x), 1e-9);
  ASSERT_GT(g.head<3>().norm(), 1e-3);
  ASSERT_GT(g.tail<3>().norm(), 1e-3);
  constexpr double step = 1e-8;
  for (int k = 0; k < 9; ++k) {
    const StrandVector d = StrandVector::Unit(k);
    const double slope = (touch.value(thread, x + step * d) - touch.value(thread, x - step * d)) / (2 * step);
    EXPECT_NEAR(slope, g[k], 1e-5 * g.norm());
    const StrandVector bend =
        (touch.gradient(thread, x + step * d) - touch.gradient(thread, x - step * d)) / (2 * step);
    EXPECT_LT((bend - h.col(k)).norm(), 1e-5 * h.norm());
  }
}

TEST(StrandTouch, ANodeThatARodStandsInIsRelaxedToItsBalanceBetweenTheEndsWhichStay) {
  StrandRig rig = plates_with({Vec3(0, 0, 0), Vec3(0, 8e-3, 0)});
  put(rig, Capsule{Vec3(0.9e-3, -1e-3, 0.5e-3), Vec3(0.9e-3, 1e-3, 0.5e-3), 1e-3});
  const VecX x = rig.x();
  rig.matrix(x);                            // which says where the bodies are
  const Eigen::Index first = x.size() - 6;  // coordinate of the strands' nodes
  LooseNodes loads{static_cast<int>(first / 3), VecX::Zero(6), VecX::Constant(2, 3.0)};
  loads.gradient.segment<3>(0) = Vec3(2e-3, -3e-3, 1e-3);
  const auto force_on_node = [&](const VecX& at) {
    VecX gradient = VecX::Zero(x.size());
    rig.strands->add_gradient(at, gradient);
    return (gradient.segment<3>(first) + loads.gradient.head<3>() +
            loads.stiffness[0] * (at - x).segment<3>(first))
        .norm();
  };
  const double strength = rig.strands->strands()[0].strand.law.setup().strength;
  ASSERT_GT(force_on_node(x), 10 * strength);
  VecX relaxed = x;
  rig.strands->relax(loads, relaxed);
  EXPECT_LT(force_on_node(relaxed), 1e-8 * strength);
  EXPECT_LT(relaxed[first] - x[first], -0.1e-3) << "pushed aside, away from the rod";
  EXPECT_EQ(relaxed.head(first), x.head(first));
  EXPECT_LT(rig.strands->value(relaxed), rig.strands->value(x));
  const VecX once = relaxed;
  rig.strands->relax({loads.first, VecX::Zero(6), VecX::Zero(2)}, relaxed);
  EXPECT_NE(relaxed, once) << "the loads have a part in it";
  rig.strands->relax({loads.first + 1, VecX::Zero(6), VecX::Zero(2)}, relaxed = x);
  EXPECT_EQ(relaxed, x) << "nodes of another body";
}

TEST(StrandTouch, AGroupRelaxesNodesWithTheirInertiaAndWeightToo) {
  StrandRig rig = plates_with({Vec3(0, 0, 0), Vec3(0, 8e-3, 0)});
  constexpr double h = 0.01;  // s
  for (StrandRig::One& one : rig.bodies) {
    one.state.motion = motion_part(*one.body, present_motion(*one.body, one.state), h).value();
    one.state.motion.duration = h;
    one.loads.inertia = std::make_shared<const Inertia>(*one.body, one.state, 0);
  }
  put(rig, Capsule{Vec3(0.9e-3, -1e-3, 0.5e-3), Vec3(0.9e-3, 1e-3, 0.5e-3), 1e-3});
  const std::vector<Member> members = rig.members();
  const GroupProblem group(members, rig.joins, rig.patterns);
  VecX gradient, largest;
  const auto force_on_nodes = [&](const VecX& x) {
    group.gradient(x, gradient, largest);
    return gradient.tail(6).norm();
  };
  const VecX x = rig.x(), relaxed = group.relaxed(x);
  const double strength = rig.strands->strands()[0].strand.law.setup().strength;
  ASSERT_GT(force_on_nodes(x), strength);
  EXPECT_LT(force_on_nodes(relaxed), 1e-7 * strength);
  EXPECT_EQ(relaxed.head(x.size() - 6), x.head(x.size() - 6));
}

TEST(StrandTouch, AsPartOfTheStrandsItsEnergyHasTheseDerivatives) {
  StrandRig rig = plates_with({Vec3(0, 0, 0), Vec3(0, 3e-3, 0)});
  put(rig, rod_at(1.2e-3, 1e-3));
  Rng rng(5);
  const VecX x = rig.x() + test::random_coordinates(rng, static_cast<int>(rig.x().size()), 10e-6);
  int contacts = 0;
  rig.matrix(x);  // which says where the bodies are
  rig.strands->for_contacts(x, [&](std::size_t, const StrandContact&) { ++contacts; });
  ASSERT_GT(contacts, 4);
  test::expect_derivatives(rig, *rig.strands, x, 1e-9, 1e-4);
  test::expect_convexity(rig, *rig.strands, x);
}

/// What holds a body presses on it by this, N.
Vec3 held_by(const StrandRig& rig, int body) {
  const test::GroupRig::One& one = rig.bodies[body];
  VecX gradient = VecX::Zero(one.state.x.size());
  one.loads.grip.add_gradient(one.body->skin().stencils, one.state.x, gradient);
  Vec3 sum = Vec3::Zero();
  for (int node = 0; node < one.body->nodes(); ++node) sum -= gradient.segment<3>(3 * node);
  return sum;
}

TEST(StrandTouch, AHookedStrandPullsAsItsLawSaysUntilItTears) {
  constexpr double radius = 0.8e-3, step = 0.5e-3;  // m, of the rod, and that it moves by
  StrandRig rig = plates_with({Vec3::Zero()});
  const StrandLaw& law = rig.strands->strands()[0].strand.law;
  double largest = 0;
  int compared = 0;
  ASSERT_TRUE(rig.step(0).converged());
  const Vec3 weight = held_by(rig, 0) + held_by(rig, 1);
  for (double x = -2 * radius; rig.torn() == 0 && x < 60e-3; x += step) {
    put(rig, rod_at(x, 0, radius));
    const NewtonResult result = rig.step(0);
    ASSERT_TRUE(result.converged()) << x << " " << to_text(result.status);
    const Vec3 force = force_on_tool(rig);
    largest = std::max(largest, force.norm());
    EXPECT_LT((held_by(rig, 0) + held_by(rig, 1) - weight - force).norm(), 1e-6 + 1e-4 * force.norm())
        << "what it does to the tool and to what holds it is in balance";
    const StrandVector places = rig.strands->places(0, rig.x());
    const Vec3 m = places.segment<3>(3);
    if (force.norm() < 10e-3 || rig.opened[0] > law.peak()) continue;
    EXPECT_GT(m.x(), x + radius) << "it lies before the rod";
    // Two straight pieces on a rod are longer than a thread that bends around it: W = 2 half / sin(beta), where
    // tan(beta) = half / (x + radius / sin(beta)); the force is the tension times dW / dx.
    const Vec3 down = places.head<3>() - m;
    const double cosine = -down.x() / down.norm(), sine = std::abs(down.z()) / down.norm();
    const double arm = sine * (m.x() - x);  // from the rod's axis to the pieces
    const double half = 0.5 * (places.head<3>() - places.tail<3>()).norm();
    const double tension = law.sample(rig.strands->strands()[0].strand.way(places), {}).tension;
    const double expected = 2 * tension * cosine / (1 - arm * cosine / half);
    EXPECT_NEAR(-force.x(), expected, 0.01 * expected + 0.5e-3) << "and the spring that centres it, at " << x;
    EXPECT_NEAR(force.z(), 0, 1e-3) << "its own weight";
    ++compared;
  }
  EXPECT_GT(compared, 10);
  ASSERT_EQ(rig.torn(), 1U);
  const double strength = law.setup().strength;
  EXPECT_GT(largest, strength) << "both of its pieces pull";
  EXPECT_LT(largest, 3 * strength);
  ASSERT_TRUE(rig.step(0).converged());
  EXPECT_EQ(force_on_tool(rig).norm(), 0) << "the rod is free";
}

TEST(StrandTouch, NoTrialGoesThroughARodHoweverFar) {
  StrandRig rig = plates_with({Vec3::Zero()});
  const Capsule rod = rod_at(3e-3, 1e-3, 0.5e-3);
  put(rig, rod);
  const VecX x = rig.x();
  rig.matrix(x);  // which says where the bodies are
  VecX step = VecX::Zero(x.size());
  step.tail<3>() = Vec3(9e-3, 0, 0);
  const double share = rig.strands->safe_share(x, step, 1.0);
  const StrandVector there = rig.strands->places(0, x + share * step);
  double left = std::numeric_limits<double>::infinity();
  for (int piece : {0, 1})
    left = std::min(left, nearest_on_piece(rod, piece_of(there, piece)).slope.distance);
  EXPECT_GT(left, -0.3e-3) << "outside of its middle";
  EXPECT_LT(left, 0.6e-3) << "no shorter than it must be";
  EXPECT_EQ(rig.strands->safe_share(x, -step, 1.0), 1.0) << "nothing is there";
}

}  // namespace
}  // namespace calot
