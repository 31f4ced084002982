// Jaws press with their pinch and no more, and hold by friction what they press on.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <map>

#include "acts/exchange.h"
#include "acts/pads.h"
#include "body/rigid_body.h"
#include "field/change_bodies.h"
#include "field_rig.h"
#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

using units::deg;
using units::mmHg;

/// The surface of a block of 2 x 2 x 2 times `at` its corners' signs, its faces split evenly into n x n squares.
template <class Place>
TriMesh block(int n, const Place& at) {
  TriMesh out;
  std::map<std::array<int, 3>, int> known;
  const auto point = [&](const std::array<int, 3>& cell) {
    const auto [found, fresh] = known.try_emplace(cell, static_cast<int>(out.points.size()));
    if (fresh) out.points.push_back(at(2.0 / n * Vec3(cell[0], cell[1], cell[2]) - Vec3::Ones()));
    return found->second;
  };
  for (int axis : {0, 1, 2})
    for (int side : {0, n})
      for (int u = 0; u < n; ++u)
        for (int v = 0; v < n; ++v) {
          const auto corner = [&](int du, int dv) {
            std::array<int, 3> cell{};
            cell[axis] = side;
            cell[(axis + 1) % 3] = u + du;
            cell[(axis + 2) % 3] = v + dv;
            return point(cell);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == n) {
            out.triangles.insert(out.triangles.end(), {Triangle{a, b, c}, Triangle{a, c, d}});
          } else {
            out.triangles.insert(out.triangles.end(), {Triangle{a, c, b}, Triangle{a, d, c}});
          }
        }
  return out;
}

/// A rigid wedge of 1 N that stands on a floor, its edge up, between the jaws of an upright grasper whose hinge is where
/// its faces would meet: both pads lie flat on them.
struct Wedge {
  static constexpr double depth = 100e-3, top = 8e-3,
                          bottom = 17e-3;  // m: of the hinge; of the wedge below it
  static constexpr double weight = 1.0;    // N
  double angle;
  Field field;

  Wedge(double half_angle, double friction, double pinch) : angle(half_angle) {
    OrganDefinition stone;
    stone.name = "wedge";
    stone.shape = RigidShape{.centre = {0, 0, -depth - 12e-3}};
    field.add(make_organ(stone, {}, Vec3::UnitZ(), 1e-6, 0).value());
    const TriMesh surface = block(4, [&](const Vec3& corner) -> Vec3 {
      const double below = 0.5 * ((1 + corner.z()) * top + (1 - corner.z()) * bottom);
      return {corner.x() * below * std::tan(angle), 4e-3 * corner.y(), -depth - below};
    });
    const double volume = 8e-3 * std::tan(angle) * (bottom * bottom - top * top);
    RigidBody body =
        RigidBody::create(
            {.name = "wedge", .surface = surface, .density = weight / units::standard_gravity / volume})
            .value();
    Organ& organ = field.organs[0];
    organ.body = std::make_shared<const RigidBody>(std::move(body));
    organ.state.x = organ.body->rest();
    organ.landmarks.clear();  // they were of another skin
    field.group.forget_bodies();
    field.ground.push_back({"floor", Plane{{0, 0, -depth - bottom}, Vec3::UnitZ()}, 0.2, false});
    field.step_time = 0.02;
    field.budget = {10'000, 0};  // the law is of the balance, whatever it takes to find it
    test::add_grasper(field, Vec3::Zero());
    field.tools[0].definition.pinch_force = pinch;
    field.tools[0].definition.pad_friction = friction;
    field.tools[0].pose = pose(2 * angle + 4 * deg, 0);
  }
  InstrumentPose pose(double jaw, double lifted) const {
    const Tool& tool = field.tools[0];
    return {0, 0, depth + tool.trocar.z() + tool.geometry.jaw_length - lifted, 0, jaw};
  }
  /// In even parts; the failure's text, empty when it arrived.
  std::string go(double jaw, double lifted, int parts) {
    const InstrumentPose from = field.tools[0].pose, to = pose(jaw, lifted);
    for (int k = 1; k <= parts; ++k) {
      SolveStatistics statistics;
      InstrumentPose here = interpolate(from, to, static_cast<double>(k) / parts);
      if (field.tools[0].jaws_rest()) here.jaw = jaw;
      const auto events = advance(field, {here}, statistics);
      if (!events) return to_text(events.failure());
    }
    return {};
  }
  /// m, of its lowest point over the floor.
  double height() const {
    double lowest = 1;
    for (const Vec3& p : field.organs[0].body->skin_positions(field.organs[0].state.x))
      lowest = std::min(lowest, p.z());
    return lowest + depth + bottom;
  }
};

TEST(Pinch, AWedgeIsLiftedByWhatFrictionHoldsOfItAndNoMore) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of steps");
  // The pinch may be off by pinch_tolerance, and what brings the wedge up to speed is 1 % of its weight.
  for (const auto& [angle, friction] : {std::pair{5 * deg, 0.2}, {20 * deg, 0.5}, {20 * deg, 0.8}})
    for (double share : {0.91, 1.09}) {
      SCOPED_TRACE(testing::Message() << angle / deg << " deg, " << friction << ", " << share);
      const double least = Wedge::weight / (2 * (friction * std::cos(angle) - std::sin(angle)));
      Wedge wedge(angle, friction, share * least);
      ASSERT_EQ(wedge.go(0, 0, 10), "");
      EXPECT_NEAR(wedge.field.tools[0].pose.jaw / 2, angle, 0.2 * deg);
      EXPECT_NEAR(pressed_apart(wedge.field, ToolIndex(0)) / (share * least), 1, pinch_tolerance);
      // No further: on what has slid by a millimetre both pads lie flat no more, and hold it by another law.
      ASSERT_EQ(wedge.go(0, 0.8e-3, 16), "");
      // What sticks gives by up to a third of a millimetre where so little of the teeth's friction is left.
      if (share > 1) {
        EXPECT_GT(wedge.height(), 0.5e-3);
      } else {
        EXPECT_LT(wedge.height(), 0.3e-3);
      }
    }
}

TEST(Pinch, AWedgeThatIsWiderThanFrictionIsNeverHeld) {
  for (const auto& [angle, friction] : {std::pair{20 * deg, 0.3}, {25 * deg, 0.4}})
    for (double pinch : {1.0, 20.0}) {
      SCOPED_TRACE(testing::Message() << angle / deg << " deg, " << friction << ", " << pinch);
      Wedge wedge(angle, friction, pinch);
      ASSERT_EQ(wedge.go(0, 0, 10), "");
      ASSERT_EQ(wedge.go(0, 2e-3, 20), "");
      EXPECT_LT(wedge.height(), 0.1e-3);
    }
}

TEST(Pinch, WhatClaspsSomethingIsNotDrawnOutOfItsPort) {
  Wedge wedge(5 * deg, 0.8, 10);
  Tool& tool = wedge.field.tools[0];
  tool.trocar.z() = port_depth - tool.geometry.jaw_length - Wedge::depth;
  tool.pose = wedge.pose(tool.pose.jaw, 0);
  Tool waiting = tool;
  waiting.definition.name = "right";
  waiting.waits = true;
  wedge.field.tools.push_back(waiting);
  const auto go = [&](double jaw, int steps) {
    for (int k = 0; k < steps; ++k) {
      SolveStatistics statistics;
      ASSERT_TRUE(advance(wedge.field, {wedge.pose(jaw, 0), waiting.pose}, statistics));
    }
  };
  go(0, 10);
  ASSERT_EQ(between_pads(wedge.field, ToolIndex(0)), "wedge");
  std::vector<WorldEvent> events;
  const std::vector<InstrumentAction> exchange{InstrumentAction::none, InstrumentAction::exchange};
  exchange_tools(wedge.field, exchange, events);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::blocked_exchange);
  EXPECT_EQ(events[0].text, "left holds wedge");
  EXPECT_TRUE(wedge.field.tools[1].waits);
}

TEST(Pinch, JawsRestOnNothingWhereWhatTheyHeldOrClaspedWasRemoved) {
  OrganDefinition other = test::held_ball();
  other.name = "other";
  other.neck.x() = other.fundus.x() = 200e-3;
  const auto remove = [&](Field field) {
    field.add(make_organ(other, {}, Vec3::UnitZ(), 1e-6).value());
    ASSERT_TRUE(field.tools[0].jaw_stopped && field.tools[0].pressing);
    ASSERT_TRUE(remove_body(field, OrganIndex(1), "", 0));
    EXPECT_TRUE(field.tools[0].jaw_stopped && field.tools[0].pressing) << "they hold on to what is there";
    field.add(make_organ(other, {}, Vec3::UnitZ(), 1e-6).value());
    ASSERT_TRUE(remove_body(field, OrganIndex(0), "", 0));
    EXPECT_FALSE(field.tools[0].jaw_stopped || field.tools[0].pressing);
    InstrumentPose closed = field.tools[0].pose;
    closed.jaw = 0;
    SolveStatistics statistics;
    const auto events = advance(field, {closed}, statistics);
    ASSERT_TRUE(events) << to_text(events.failure());
    EXPECT_EQ(field.tools[0].pose.jaw, 0) << "they close at once";
    for (const WorldEvent& event : events.value()) EXPECT_NE(event.kind, EventKind::release);
  };
  Wedge wedge(5 * deg, 0.8, 10);
  ASSERT_EQ(wedge.go(0, 0, 10), "");
  remove(wedge.field);
  test::FundusField fold(test::ball_scene());
  ASSERT_EQ(fold.grasp(), "");
  remove(fold.field);
}

TEST(Pinch, StopsTheJawsOnAWallWhateverTheBilesPressure) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  std::array<double, 2> angles{};  // rad, at 0 and 30 mmHg
  for (double pressure : {0.0, 2.5, 5.0, 10.0, 20.0, 30.0}) {
    SCOPED_TRACE(pressure);
    SceneDefinition scene = test::grasper_scene();
    scene.anatomy.organs[0].bile.fill_pressure = pressure * mmHg;
    test::FundusPath path(scene);
    const double pinch = scene.instruments[0].pinch_force;
    double most = 0;
    path.driver.watch = [&](const StepReport&) {
      most = std::max(most, pressed_apart(path.world.field(), ToolIndex(0)) / pinch);
    };
    ASSERT_TRUE(path.grasp()) << path.driver.why();
    const InstrumentState& tool = path.world.report().instruments[0];
    EXPECT_EQ(tool.holds, "gallbladder");
    EXPECT_LT(most, 1 + pinch_tolerance);
    // Two walls of 2 mm hardly squeezed, which the skin's own stretch round the pads carries: bile of 30 mmHg presses on
    // pads of 20 by 5 mm with 0.4 N.
    EXPECT_NEAR(pressed_apart(path.world.field(), ToolIndex(0)) / pinch, 1, pinch_tolerance);
    EXPECT_GT(tool.pose.jaw, 8 * deg);
    EXPECT_LT(tool.pose.jaw, 12 * deg);
    if (pressure == 0) angles[0] = tool.pose.jaw;
    angles[1] = tool.pose.jaw;
    fmt::print("{:4.1f} mmHg: {:.1f} deg, {:.2f} of the pinch, {} points held\n", pressure,
               tool.pose.jaw / deg, pressed_apart(path.world.field(), ToolIndex(0)) / pinch,
               tool.grip_points);
  }
  EXPECT_NEAR(angles[1], angles[0], 1.5 * deg);
}

TEST(Pinch, JawsCloseOnAsWhatTheyPressOnGivesWay) {
  CALOT_SLOW_WHEN_SANITIZED("whole grasps");
  test::FundusPath path(test::ball_scene());
  ASSERT_TRUE(path.grasp()) << path.driver.why();
  Field field = path.world.field();
  Tool& tool = field.tools[0];
  ASSERT_TRUE(tool.pressing);
  const double before = tool.pose.jaw, pinch = tool.definition.pinch_force;
  InstrumentPose command = tool.pose;
  command.jaw = 0;
  const auto wait = [&](int steps) {
    for (int k = 0; k < steps; ++k) {
      SolveStatistics statistics;
      const auto done = advance(field, {command}, statistics);
      ASSERT_TRUE(done) << to_text(done.failure());
    }
  };
  wait(5);
  EXPECT_EQ(tool.pose.jaw, before) << "nothing gives way";
  field.organs[0].state.volume *= 0.9;  // some of the bile is gone
  wait(10);
  EXPECT_LT(tool.pose.jaw, before - 0.1 * deg);
  EXPECT_NEAR(pressed_apart(field, ToolIndex(0)) / pinch, 1, pinch_tolerance);
  tool.definition.pinch_force = 0.7 * pinch;  // a weaker hand
  const double closed = tool.pose.jaw;
  wait(10);
  EXPECT_GT(tool.pose.jaw, closed + 0.5 * deg);
  EXPECT_NEAR(pressed_apart(field, ToolIndex(0)) / tool.definition.pinch_force, 1, pinch_tolerance);
}

}  // namespace
}  // namespace calot
