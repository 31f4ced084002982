// Instruments that meet.

#include "tools/tool_meeting.h"

#include "base/units.h"
#include "support/derivatives.h"
#include "support/random.h"
#include "tool_rig.h"

namespace calot {
namespace {

/// One shaft straight down and one that comes from the right; where the second one's tip is commanded says how they stand.
struct Crossing {
  Tool down, across;
  explicit Crossing(InstrumentType type = InstrumentType::atraumatic_grasper) {
    across.trocar = Vec3(0.12, 0.01, 0.02);
    down.geometry = across.geometry = instrument_geometry(type);
  }
  InstrumentPose still() const { return {.pitch = 0.02, .insertion = 0.16, .jaw = 0.0}; }
  InstrumentPose reaching(double y, double roll = 0, double jaw = 0) const {
    return pose_reaching(across.trocar, {-0.04, y, -0.11}, roll, jaw, across.geometry);
  }
  test::HeldTools held(double y) const {
    return test::HeldTools({{down, still(), hand_of(down)}, {across, reaching(y), hand_of(across)}});
  }
};

TEST(ToolMeeting, ItsForcesAndStiffnessAreTheSlopesOfItsEnergyWhateverParts) {
  const Crossing crossing;
  Rng rng(11);
  int pressed = 0, balanced = 0;
  for (int k = 0; k < 20000 && (pressed < 6 || balanced < 6); ++k) {
    // The tips of both come together anyhow.
    const Vec3 meet(0.01, 0.02, -0.13);
    const auto near = [&] { return Vec3(meet + test::random_vector(rng, 6e-3)); };
    VecX x(12);
    x << tool_coordinates(pose_reaching(crossing.down.trocar, near(), rng.uniform(-2, 2), 0.6)),
        tool_coordinates(pose_reaching(crossing.across.trocar, near(), rng.uniform(-2, 2), 0.4));
    const ToolMeeting meeting({&crossing.down, 0}, {&crossing.across, 2});
    const double gap = meeting.gap(x, 0.05e-3);
    if (gap > 0.04e-3 || gap < -0.2e-3) continue;
    ++pressed;
    const auto value = [&](const VecX& at) { return meeting.value(at); };
    const auto slope = [&](const VecX& at) {
      VecX out = VecX::Zero(12);
      meeting.add_gradient(at, out);
      return out;
    };
    const VecX expected = test::difference_gradient(value, x, 1e-9);
    EXPECT_GT(expected.head<6>().norm(), 1e-3);
    EXPECT_GT(expected.tail<6>().norm(), 1e-3);
    EXPECT_LT(test::relative_error(slope(x), expected), 1e-5) << gap;
    if (gap < -0.038e-3) continue;  // deeper there is no balance, and stiffness is not exact
    ++balanced;
    std::vector<std::vector<int>> cliques;
    meeting.add_cliques(x, true, cliques);
    BlockMatrix matrix(4, cliques);
    meeting.add_hessian(x, matrix);
    EXPECT_LT(test::relative_error(test::dense(matrix), test::difference_hessian(slope, x, 1e-10)), 1e-4)
        << gap;
  }
  EXPECT_GE(pressed, 6);
  EXPECT_GE(balanced, 6);
}

TEST(ToolMeeting, ThePointsOfAToolLieInItAndReachItsSurface) {
  for (const std::string& name : instrument_type_names()) {
    Tool tool;
    tool.geometry = instrument_geometry(*instrument_type_called(name));
    const InstrumentPose pose{0.3, -0.2, 0.2, 1.0, tool.geometry.has_jaws() ? 0.5 : 0.0};
    const std::vector<Shape> shapes = instrument_shapes(tool.trocar, pose, tool.geometry);
    std::array<int, 3> count{};
    for (const ToolPoint& point : tool_points(tool.geometry)) {
      const Vec3 at = PosedPart(tool, pose, point.part).frame() * point.local;
      EXPECT_NEAR(signed_distance(shapes[point.part], at), -point.radius, 1e-12) << name << point.part;
      ++count[point.part];
    }
    for (int of_part : count) EXPECT_GT(of_part, 2);
  }
}

TEST(ToolMeeting, ToolsCommandedThroughEachOtherStopEachOtherWithinTheirHands) {
  const Crossing crossing;
  test::HeldTools tools = crossing.held(0.03);
  EXPECT_EQ(tools.meeting().force(tools.x()), Vec3::Zero());
  double before = 0;
  for (double y : {0.01, 0.0, -0.01, -0.03}) {
    const std::string where = fmt::format("commanded to y = {} mm", 1e3 * y);
    ASSERT_TRUE(tools.lead(1, crossing.reaching(y), 4)) << where;
    const VecX x = tools.x();
    const double force = tools.meeting().force(x).norm();
    EXPECT_GT(tools.meeting().gap(x, 0.1e-3), -0.05e-3) << where;
    EXPECT_GE(force, before) << where;
    // Each hand balances the force by its moment about the trocar.
    EXPECT_LT(tools.effort(0).tip, 20);
    EXPECT_LT(tools.effort(1).tip, 20);
    before = force;
  }
  EXPECT_GT(before, 10);
  EXPECT_GT(std::max(tools.effort(0).tip, tools.effort(1).tip), 19.0);  // one of them gave way
}

TEST(ToolMeeting, ToolsThatAreInEachOtherPart) {
  const Crossing crossing;
  for (double deep : {0.2e-3, 0.5e-3, 1.5e-3}) {
    double y = 0.03;
    while (crossing.held(y).meeting().gap(crossing.held(y).x(), 1) > -deep) y -= 0.05e-3;
    test::HeldTools tools = crossing.held(y);
    const NewtonResult result = tools.command(1, crossing.reaching(y));
    ASSERT_TRUE(result.converged()) << 1e3 * deep << " mm: " << to_text(result.status) << ' '
                                    << result.residual;
    EXPECT_GT(tools.meeting().gap(tools.x(), 1), -0.05e-3) << 1e3 * deep;
    EXPECT_LT((tools.x() - test::HeldTools(crossing.held(y)).x()).norm(), 0.1)
        << "and no further than they have to";
  }
}

TEST(ToolMeeting, AToolThatNothingStopsComesToItsCommandHoweverFar) {
  const Crossing crossing;
  test::HeldTools tools({{crossing.across, crossing.reaching(0.03), hand_of(crossing.across)}});
  const InstrumentPose far = crossing.reaching(-0.03, 2.0, 1.0);
  const NewtonResult result = tools.command(0, far);
  ASSERT_TRUE(result.converged()) << to_text(result.status) << " in " << result.iterations;
  EXPECT_LT((tools.x() - tool_coordinates(far)).norm(), 1e-9);
}

TEST(ToolMeeting, WhatOneToolFeelsTheOtherDoes) {
  const Crossing crossing;
  test::HeldTools tools = crossing.held(0.03);
  ASSERT_TRUE(tools.lead(1, crossing.reaching(0.0), 6));
  const VecX x = tools.x();
  VecX gradient = VecX::Zero(12);
  tools.meeting().add_gradient(x, gradient);
  // Virtual work of both tools moved as one: nothing. Along the first one's axis and turned about its trocar's x.
  const Vec3 force = tools.meeting().force(x);
  ASSERT_GT(force.norm(), 1.0);
  const PosedPart down(crossing.down, tools.pose(0), 0), across(crossing.across, tools.pose(1), 0);
  // By the insertions: the force's component along each shaft, opposite in sign.
  EXPECT_NEAR(gradient[2], force.dot(down.frame().linear().col(2)), 1e-9 * force.norm());
  EXPECT_NEAR(gradient[8], -force.dot(across.frame().linear().col(2)), 1e-9 * force.norm());
}

TEST(ToolMeeting, NoSafeStepTakesAToolThroughAnother) {
  const Crossing crossing;
  const ToolMeeting meeting({&crossing.down, 0}, {&crossing.across, 2});
  VecX x(12), through(12);
  x << tool_coordinates(crossing.still()), tool_coordinates(crossing.reaching(0.03));
  through << tool_coordinates(crossing.still()), tool_coordinates(crossing.reaching(-0.03));
  const double share = meeting.safe_share(x, through - x, 1.0);
  EXPECT_GT(share, 0.2);
  EXPECT_LT(share, 0.8);
  const double gap = meeting.gap(x, 1);
  for (int k = 0; k <= 50; ++k) EXPECT_GT(meeting.gap(x + share * k / 50.0 * (through - x), 1), 0.19 * gap);
  VecX away = x;
  away.tail<6>() = tool_coordinates(crossing.reaching(0.05));
  EXPECT_EQ(meeting.safe_share(x, away - x, 1.0), 1.0);
}

/// A level shaft of 2.5 mm radius that hardly gives way, and open jaws that come from above, the shaft across the middle of
/// their pads.
struct ShaftInJaws {
  static constexpr double open = 40 * units::deg;
  Tool wall, jaws;
  HandStrength firm;

  ShaftInJaws() {
    wall.trocar = Vec3(0, -0.15, -0.1);
    firm.stiffness = 1e7;
    firm.force = 1e4;
  }
  InstrumentPose still() const { return {.pitch = 90 * units::deg, .insertion = 0.2}; }
  InstrumentPose around(double roll) const { return {.insertion = 0.11, .roll = roll, .jaw = open}; }
};

TEST(ToolMeeting, JawsThatCloseOnAShaftStopWithThePinchAtTheirPadsAndAreWedgedOff) {
  const ShaftInJaws rig;
  for (double roll : {0.0, 0.15}) {
    SCOPED_TRACE(roll);
    InstrumentPose command = rig.around(roll);
    test::HeldTools tools({{rig.wall, rig.still(), rig.firm}, {rig.jaws, command, hand_of(rig.jaws)}});
    ASSERT_EQ(tools.meeting().force(tools.x()), Vec3::Zero());
    command.jaw = 0;
    ASSERT_TRUE(tools.lead(1, command, 20));
    const Hand::Effort effort = tools.effort(1);
    const double half = 0.5 * tools.pose(1).jaw;
    EXPECT_NEAR(effort.pinch, rig.jaws.definition.pinch_force, 0.01);
    EXPECT_GT(2 * half, 20 * units::deg);
    EXPECT_LT(2 * half, rig.open);
    EXPECT_GT(tools.meeting().gap(tools.x(), 1e-3), -0.05e-3);
    // Without friction a pad pushes a round thing out by N sin a, with N from the pinch's moment about the hinge. Points
    // a millimetre apart make the contact, which leaves the lever open by some hundredths.
    const Vec3 hinge = hinge_frame(rig.jaws.trocar, tools.pose(1), rig.jaws.geometry).translation();
    const double lever = (hinge - rig.wall.trocar).cross(Vec3::UnitY()).norm() * std::cos(half);
    const double push = effort.pinch * 0.5 * rig.jaws.geometry.jaw_length / lever;
    if (roll == 0) {
      EXPECT_NEAR(effort.tip, 2 * push * std::sin(half), 0.04 * effort.tip);
    }
  }
}

TEST(ToolMeeting, ARigidWallStopsAToolAtItsHandsForce) {
  const Crossing crossing;
  HandStrength firm;
  firm.stiffness = 1e7;
  firm.force = 1e4;
  // The tip runs against the shaft that stands still, head on.
  const InstrumentPose still{.insertion = 0.2};
  const Vec3 middle(0, 0, -0.1);
  const Vec3 along = (middle - crossing.across.trocar).normalized();
  const auto tip = [&](double beyond) {
    return pose_reaching(crossing.across.trocar, middle + beyond * along, 0, 0, crossing.across.geometry);
  };
  test::HeldTools tools(
      {{crossing.down, still, firm}, {crossing.across, tip(-10e-3), hand_of(crossing.across)}});
  ASSERT_TRUE(tools.lead(1, tip(10e-3), 10));
  EXPECT_NEAR(tools.effort(1).tip, 20, 0.1);
  EXPECT_NEAR(tools.meeting().force(tools.x()).norm(), 20, 2);
}

}  // namespace
}  // namespace calot
